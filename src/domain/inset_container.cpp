#include "domain/inset_container.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/rounding.hpp"

namespace bernal {
namespace {

class InsetContainer final : public Container {
 public:
  InsetContainer(std::shared_ptr<const Container> facets, double inset, double volume)
      : Container(facets->arithmetic(), facets->resolution(), facets->boundary(), facets->dimension(), inset),
        facets_(std::move(facets)),
        volume_(volume) {}

  std::string_view kind() const override { return facets_->kind(); }
  Bounds<3> bounds() const override { return facets_->bounds(); }
  double volume() const override { return volume_; }

  double clearance(const Vector<3>& p) const override { return facets_->clearance(p) - inset(); }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return std::min(reach, facets_->clearance_within(p, std::max(0.0, reach + inset())) - inset());
  }
  bool contains(const Vector<3>& c, double r) const override { return facets_->contains(c, widened(r)); }
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return facets_->first_contact(c, widened(r), direction, limit);
  }
  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return facets_->free_path(c, widened(r), direction, limit);
  }
  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    few_facets_near(c, reach, std::numeric_limits<std::size_t>::max(), out);
  }
  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    if (reach + inset() <= 0) return true;
    const std::size_t before = out.size();
    const bool all = facets_->few_facets_near(c, reach + inset(), most, out);
    for (std::size_t k = before; k < out.size(); ++k) {
      out[k].distance -= inset();
      out[k].facet.radius = inset();
    }
    return all;
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    if (r + inset() <= 0) return;
    const std::size_t before = out.size();
    facets_->contacts(c, r + inset(), out);
    for (std::size_t k = before; k < out.size(); ++k) out[k].distance -= inset();
  }

 private:
  /// At least 0: a centre behind the facets is outside, wherever the wall stands.
  double widened(double r) const { return std::max(0.0, sum_rounded_up(r, inset())); }

  std::shared_ptr<const Container> facets_;
  double volume_;
};

}  // namespace

std::unique_ptr<Container> make_inset_container(std::shared_ptr<const Container> facets, double inset,
                                                double volume) {
  return std::make_unique<InsetContainer>(std::move(facets), inset, volume);
}

}  // namespace bernal

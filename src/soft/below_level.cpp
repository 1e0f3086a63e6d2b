#include "soft/below_level.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "domain/places.hpp"

namespace bernal {
namespace {

constexpr std::size_t most_points = 1 << 15;

class BelowLevel final : public Container {
 public:
  BelowLevel(std::shared_ptr<const Container> whole, const Vector<3>& down, double level, double volume)
      : Container(whole->arithmetic(), whole->resolution(), whole->boundary(), whole->dimension(),
                  whole->inset()),
        whole_(std::move(whole)),
        plane_{.kind = Facet::Kind::plane, .a = -level * down, .b = down},
        volume_(volume) {}

  std::string_view kind() const override { return whole_->kind(); }
  double volume() const override { return volume_; }

  /// Cut where the level lies across an axis.
  Bounds<3> bounds() const override {
    Bounds<3> bounds = whole_->bounds();
    for (int k = 0; k < 3; ++k) {
      if (std::abs(plane_.b[k]) < 1) continue;
      double& end = plane_.b[k] < 0 ? bounds.upper[k] : bounds.lower[k];
      end = std::clamp(plane_.a[k], bounds.lower[k], bounds.upper[k]);
    }
    return bounds;
  }

  double clearance(const Vector<3>& p) const override { return std::min(whole_->clearance(p), depth(p)); }
  double clearance_within(const Vector<3>& p, double reach) const override {
    return std::min(whole_->clearance_within(p, reach), depth(p));
  }
  bool contains(const Vector<3>& c, double r) const override {
    return depth(c) >= r && whole_->contains(c, r);
  }
  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    whole_->facets_near(c, reach, out);
    add_plane(c, reach, before, out);
  }
  bool few_facets_near(const Vector<3>& c, double reach, std::size_t most,
                       std::vector<NearFacet>& out) const override {
    const auto before = static_cast<std::ptrdiff_t>(out.size());
    if (!whole_->few_facets_near(c, reach, most, out)) return false;
    add_plane(c, reach, before, out);
    return true;
  }
  void contacts(const Vector<3>& c, double r, std::vector<WallContact>& out) const override {
    whole_->contacts(c, r, out);
    if (depth(c) < r) out.push_back({plane_.b, depth(c)});
  }
  double first_contact(const Vector<3>& c, double r, const Vector<3>& direction,
                       double limit) const override {
    return whole_->first_contact(c, r, direction, std::min(limit, until_level(c, r, direction)));
  }
  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    return whole_->free_path(c, r, direction, std::min(limit, until_level(c, r, direction)));
  }

 private:
  double depth(const Vector<3>& p) const { return (p - plane_.a).dot(plane_.b); }
  double until_level(const Vector<3>& c, double r, const Vector<3>& direction) const {
    const double rise = -direction.dot(plane_.b);
    return rise > 0 ? std::max(0.0, depth(c) - r) / rise : std::numeric_limits<double>::infinity();
  }
  void add_plane(const Vector<3>& c, double reach, std::ptrdiff_t before, std::vector<NearFacet>& out) const {
    if (depth(c) >= reach) return;
    const NearFacet near{depth(c), plane_};
    out.insert(std::upper_bound(out.begin() + before, out.end(), near,
                                [](const auto& a, const auto& b) { return a.distance < b.distance; }),
               near);
  }

  std::shared_ptr<const Container> whole_;
  Facet plane_;
  double volume_;
};

}  // namespace

std::shared_ptr<const Container> below_level(std::shared_ptr<const Container> whole, const Vector<3>& down,
                                             double level, double volume) {
  return std::make_shared<BelowLevel>(std::move(whole), down, level, volume);
}

Heights::Heights(const Container& container, const Vector<3>& down) : volume_(container.volume()) {
  const Bounds<3> bounds = container.bounds();
  const Vector<3> size = bounds.size();
  // The additive recurrence of the plastic number's relative in three dimensions (Roberts 2018).
  const Vector<3> step(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
  const auto even_point = [&](std::size_t n) -> Vector<3> {
    const Vector<3> at = static_cast<double>(n + 1) * step;
    return bounds.lower + size.cwiseProduct(Vector<3>(at - at.array().floor().matrix()));
  };
  for (const Vector<3>& p : points_inside(container, most_points, 1, even_point))
    heights_.push_back(-down.dot(p));
  if (heights_.empty()) heights_.push_back(-down.dot(bounds.center()));
  std::ranges::sort(heights_);
}

double Heights::volume_below(double height_above_ground) const {
  const auto above = std::ranges::upper_bound(heights_, heights_.front() + height_above_ground);
  return volume_ * static_cast<double>(above - heights_.begin()) / static_cast<double>(heights_.size());
}

double Heights::level_holding(double volume) const {
  const double place = volume / volume_ * static_cast<double>(heights_.size());
  return heights_[std::min(heights_.size() - 1, static_cast<std::size_t>(place))];
}

double Heights::volume_below_mean(double height) const {
  double sum = 0;
  for (std::size_t k = 0; k < heights_.size(); ++k) {
    sum += heights_[k];
    if (sum > height * static_cast<double>(k + 1))
      return volume_ * static_cast<double>(k + 1) / static_cast<double>(heights_.size());
  }
  return volume_;
}

}  // namespace bernal

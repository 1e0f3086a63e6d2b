#include <algorithm>

#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/nearest_first.hpp"

namespace bernal {
namespace {

class Box final : public Container {
 public:
  Box(const BoxShape& shape, WallArithmetic arithmetic, double resolution)
      : Container(resolution), shape_(shape), bounds_(bounds_of(shape)), arithmetic_(arithmetic) {
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      const bool upper = side % 2 == 1;
      Facet& f = facets_[side];
      f.kind = Facet::Kind::plane;
      f.id = static_cast<std::uint32_t>(side);
      f.a = upper ? bounds_.upper : bounds_.lower;
      f.b = Vector<3>::Unit(axis) * (upper ? -1.0 : 1.0);
    }
  }

  std::string_view kind() const override { return "box"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return bounds_.volume(); }

  double clearance(const Vector<3>& p) const override {
    const Vector<3> depth = (p - bounds_.lower).cwiseMin(bounds_.upper - p);
    const double least = depth.minCoeff();
    return least >= 0 ? least : -depth.cwiseMin(0).norm();
  }

  bool contains(const Vector<3>& c, double r) const override {
    // Inside, the clearance is one difference of doubles. Rounding never carries it across another double, so
    // it is wrong about r only where it equals r.
    return decide_contains(arithmetic_, clearance(c), r, 0.0, [&] { return contains_exactly(shape_, c, r); });
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    append_nearest_first(facets_, c, reach, out);
  }

 private:
  BoxShape shape_;
  Bounds<3> bounds_;
  WallArithmetic arithmetic_;
  std::array<Facet, 6> facets_;
};

}  // namespace

std::unique_ptr<Container> make_box(const BoxShape& shape, WallArithmetic arithmetic, double resolution) {
  return std::make_unique<Box>(shape, arithmetic, resolution);
}

}  // namespace bernal

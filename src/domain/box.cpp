#include <algorithm>
#include <limits>

#include "core/rounding.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/free_path.hpp"
#include "domain/nearest_first.hpp"

namespace bernal {
namespace {

class BoxContainer final : public Container {
 public:
  BoxContainer(const Box& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution, boundary_of<3>(shape), shape.dimension()),
        shape_(shape),
        bounds_(bounds_of(shape)),
        walls_(walls_of(shape)) {
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2;
      if (axis >= shape.dimension() || shape.repeats(axis)) {
        ends_.lower[axis] = -std::numeric_limits<double>::infinity();
        ends_.upper[axis] = std::numeric_limits<double>::infinity();
        continue;
      }
      const double lower_end = shape.corner[axis], size = shape.size[axis];
      ends_.lower[axis] = lower_end;
      ends_.upper[axis] = sum_rounded_down(lower_end, size);
      error_ = std::max(error_, roundings * (sum_rounded_up(lower_end, size) - ends_.upper[axis]));
      const bool upper = side % 2 == 1;
      Facet& f = facets_.emplace_back();
      f.kind = Facet::Kind::plane;
      f.id = static_cast<std::uint32_t>(side);
      f.a = upper ? bounds_.upper : bounds_.lower;
      if (upper) f.a[axis] = ends_.upper[axis];
      f.b = Vector<3>::Unit(axis) * (upper ? -1.0 : 1.0);
    }
  }

  std::string_view kind() const override { return "box"; }
  Bounds<3> bounds() const override { return bounds_; }
  double volume() const override { return volume_of(shape_); }

  double clearance(const Vector<3>& p) const override {
    const Vector<3> depth = (p - ends_.lower).cwiseMin(ends_.upper - p);
    const double least = depth.minCoeff();
    return least >= 0 ? least : -depth.cwiseMin(0).norm();
  }

  bool contains(const Vector<3>& c, double r) const override {
    // Inside, the clearance is one difference of doubles. Rounding never carries it across another double, so
    // it is wrong about r only where it equals r, or where the walls are not doubles.
    return decide_contains(arithmetic(), clearance(c), r, error_,
                           [&] { return contains_exactly(walls_, c, r); });
  }

  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    if (arithmetic() == WallArithmetic::plain) return Container::free_path(c, r, direction, limit);
    return bernal::free_path(walls_, {c, r, direction, limit}, arithmetic());
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    append_nearest_first(facets_, c, reach, out);
  }

 private:
  /// Of the distance between the doubles on both sides of a wall, what the rounding of it and of the
  /// clearance stays below.
  static constexpr double roundings = 4;

  Box shape_;
  Bounds<3> bounds_;
  Bounds<3> ends_;  // infinite along an axis that has none; an upper one is the next double inside
  double error_ = 0;
  std::vector<AnalyticWall> walls_;
  std::vector<Facet> facets_;
};

}  // namespace

std::unique_ptr<Container> make_box(const Box& shape, WallArithmetic arithmetic, double resolution) {
  return std::make_unique<BoxContainer>(shape, arithmetic, resolution);
}

}  // namespace bernal

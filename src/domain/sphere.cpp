#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/free_path.hpp"
#include "domain/nearest_first.hpp"

namespace bernal {
namespace {

class SphereContainer final : public Container {
 public:
  SphereContainer(const Sphere& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution), shape_(shape), walls_(walls_of(shape)) {
    wall_[0].kind = Facet::Kind::sphere;
    wall_[0].a = shape.center;
    wall_[0].radius = shape.radius;
  }

  std::string_view kind() const override { return "sphere"; }
  Bounds<3> bounds() const override { return bounds_of(shape_); }
  double volume() const override { return volume_of(shape_); }

  double clearance(const Vector<3>& p) const override { return shape_.radius - (p - shape_.center).norm(); }

  bool contains(const Vector<3>& c, double r) const override {
    // |c - center| has a relative error of at most 5u; two subtractions follow.
    const double from_center = (c - shape_.center).norm();
    const double error = 8 * tolerance::roundoff * (from_center + shape_.radius + r);
    return decide_contains(arithmetic(), shape_.radius - from_center, r, error,
                           [&] { return contains_exactly(walls_, c, r); });
  }

  double free_path(const Vector<3>& c, double r, const Vector<3>& direction, double limit) const override {
    if (arithmetic() == WallArithmetic::plain) return Container::free_path(c, r, direction, limit);
    return bernal::free_path(walls_, {c, r, direction, limit}, arithmetic());
  }

  void facets_near(const Vector<3>& c, double reach, std::vector<NearFacet>& out) const override {
    append_nearest_first(wall_, c, reach, out);
  }

 private:
  Sphere shape_;
  std::vector<AnalyticWall> walls_;
  std::array<Facet, 1> wall_;
};

}  // namespace

std::unique_ptr<Container> make_sphere(const Sphere& shape, WallArithmetic arithmetic, double resolution) {
  return std::make_unique<SphereContainer>(shape, arithmetic, resolution);
}

}  // namespace bernal

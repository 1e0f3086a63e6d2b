#include <algorithm>
#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "domain/analytic.hpp"
#include "domain/exact_analytic.hpp"
#include "domain/free_path.hpp"
#include "domain/nearest_first.hpp"

namespace bernal {
namespace {

class CylinderContainer final : public Container {
 public:
  CylinderContainer(const Cylinder& shape, WallArithmetic arithmetic, double resolution)
      : Container(arithmetic, resolution, boundary_of<3>(shape)),
        shape_(shape),
        axis_(shape.axis.stableNormalized()),
        walls_(walls_of(shape)) {
    facets_.resize(shape.periodic ? 1 : 3);
    Facet& lateral = facets_[0];
    lateral.kind = Facet::Kind::cylinder;
    lateral.a = shape.base;
    lateral.b = axis_;
    lateral.radius = shape.radius;
    if (shape.periodic) return;
    Facet& bottom = facets_[1];
    bottom.a = shape.base;
    bottom.b = axis_;
    Facet& top = facets_[2];
    top.a = shape.base + shape.height * axis_;
    top.b = -axis_;
    for (std::uint32_t id = 0; id < 3; ++id) facets_[id].id = id;
  }

  std::string_view kind() const override { return "cylinder"; }
  Bounds<3> bounds() const override { return bounds_of(shape_); }
  double volume() const override { return volume_of(shape_); }

  double clearance(const Vector<3>& p) const override {
    const Vector<3> w = p - shape_.base;
    const double height = w.dot(axis_);
    const double lateral = shape_.radius - (w - height * axis_).norm();
    if (shape_.periodic) return lateral;
    const double axial = std::min(height, shape_.height - height);
    const double least = std::min(lateral, axial);
    return least >= 0 ? least : -std::hypot(std::min(lateral, 0.0), std::min(axial, 0.0));
  }

  bool contains(const Vector<3>& c, double r) const override {
    // |w| <= n, n = |w|_1. The unit axis is wrong by at most 5u in each component, the height w·axis by
    // 10u·n, the distance from the axis line by 24u·n; u·(radius + height + r) covers the subtractions.
    const double n = (c - shape_.base).lpNorm<1>();
    const double error = 32 * tolerance::roundoff * (n + shape_.radius + shape_.height + r);
    return decide_contains(arithmetic(), clearance(c), r, error,
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
  Cylinder shape_;
  Vector<3> axis_;
  std::vector<AnalyticWall> walls_;
  std::vector<Facet> facets_;
};

}  // namespace

std::unique_ptr<Container> make_cylinder(const Cylinder& shape, WallArithmetic arithmetic,
                                         double resolution) {
  return std::make_unique<CylinderContainer>(shape, arithmetic, resolution);
}

}  // namespace bernal

#include <algorithm>
#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/domain.hpp"
#include "core/rounding.hpp"

namespace bernal {
namespace {

struct WithWallsMoved {
  double by;

  Domain operator()(Box box) const {
    for (int k = 0; k < box.dimension(); ++k) {
      if (!box.has_wall(k)) continue;
      double& lower = box.corner[k];
      const double upper = sum_rounded_down(sum_rounded_down(lower, box.size[k]), -by);
      lower = sum_rounded_up(lower, by);
      box.size[k] = sum_rounded_down(upper, -lower);
    }
    return box;
  }

  Domain operator()(Cylinder cylinder) const {
    const int along = cylinder.coordinate_axis();
    const double height = cylinder.height;
    cylinder.radius = sum_rounded_down(cylinder.radius, -by);
    if (cylinder.periodic) return cylinder;
    if (along >= 0) {
      const double side = cylinder.axis[along] > 0 ? 1 : -1;
      double& base = cylinder.base[along];
      const double before = side * base, after = sum_rounded_up(before, by);
      base = side * after;
      // (before + height - by) - after
      cylinder.height = sum_rounded_down(sum_rounded_down(sum_rounded_down(before, -after), height), -by);
      return cylinder;
    }
    // The unit axis and the base are off by a few roundoffs of the lengths in each component.
    const double lengths = cylinder.base.cwiseAbs().maxCoeff() + height + cylinder.radius + std::abs(by);
    const double margin = 32 * tolerance::roundoff * lengths;
    cylinder.base += (by + margin) * cylinder.axis.stableNormalized();
    cylinder.height = height - 2 * by - 4 * margin;
    cylinder.radius -= 2 * margin;
    return cylinder;
  }

  Domain operator()(Sphere sphere) const {
    sphere.radius = sum_rounded_down(sphere.radius, -by);
    return sphere;
  }

  Domain operator()(Mesh mesh) const { return with_inset(std::move(mesh)); }
  Domain operator()(Polygon polygon) const { return with_inset(std::move(polygon)); }
  Domain operator()(Revolved revolved) const { return with_inset(std::move(revolved)); }

 private:
  template <class Faceted>
  Domain with_inset(Faceted shape) const {
    if (shape.inset != 0) throw Error(ErrorCode::bad_argument, "the walls of these facets are moved already");
    shape.inset = by;
    return shape;
  }
};

}  // namespace

Domain with_walls_moved(const Domain& domain, double by) { return std::visit(WithWallsMoved{by}, domain); }

}  // namespace bernal

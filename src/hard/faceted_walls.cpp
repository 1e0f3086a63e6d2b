#include "hard/faceted_walls.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/tolerance.hpp"
#include "domain/revolved_surface.hpp"

namespace bernal {
namespace {

/// Of the coordinates: to which a root is exact.
constexpr double closely = 4 * tolerance::roundoff;
/// Steps towards a root that is hardly one double their way; then it ends at a time before it.
constexpr int most_steps = 100;
constexpr std::uint32_t facets_a_leaf = 4;

/// Calls add(a, b, c) for every facet. Returns the inset.
template <class Add>
struct EachFacet {
  double tolerance;
  const Add& add;

  double operator()(const Mesh& mesh) const {
    require_closed_walls(mesh, "growth");
    for (const auto& [i, j, k] : mesh.triangles) add(mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]);
    return mesh.inset;
  }
  double operator()(const Polygon& polygon) const {
    for (const auto& loop : polygon.loops)
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vector<3> a = point_in_space<2>(loop[k]), b = point_in_space<2>(loop[(k + 1) % loop.size()]);
        if (a != b) add(a, b, b);
      }
    return polygon.inset;
  }
  double operator()(const Revolved& solid) const {
    (*this)(surface_of(solid, static_cast<int>(sides_for(solid, tolerance)), RoundAs::within));
    return solid.inset;
  }
  double operator()(const auto&) const {
    throw Error(ErrorCode::bad_argument, "boxes, cylinders and spheres are convex and have no facets");
  }
};

}  // namespace

FacetedWalls::FacetedWalls(const Domain& shape, double tolerance, const Vector<3>& shift) {
  const auto add = [&](const Vector<3>& a, const Vector<3>& b, const Vector<3>& c) {
    const std::array corners{Vector<3>(a + shift), Vector<3>(b + shift), Vector<3>(c + shift)};
    facets_.emplace_back(corners[0], corners[1], corners[2]);
    Bounds<3>& bounds = bounds_.emplace_back(Bounds<3>{corners[0], corners[0]});
    for (const Vector<3>& corner : corners) {
      bounds.lower = bounds.lower.cwiseMin(corner);
      bounds.upper = bounds.upper.cwiseMax(corner);
      extent_ = std::max(extent_, corner.cwiseAbs().maxCoeff());
    }
  };
  inset_ = std::max(0.0, std::visit(EachFacet<decltype(add)>{tolerance, add}, shape));
  tree_ = BoxTree<3>(bounds_, facets_a_leaf);
}

void FacetedWalls::find_near(const Vector<3>& p, double reach, std::vector<Near>& out) const {
  out.clear();
  const double most = reach + inset_;
  tree_.for_each_near(p, most, [&](Id facet) {
    if (!(squared_distance(bounds_[facet], p) < most * most)) return;
    const Vector<3> offset = facets_[facet].offset(p);
    const double distance = offset.norm();
    if (distance < most) out.push_back({offset / distance, distance - inset_, facet});
  });
  std::ranges::sort(out, [](const Near& a, const Near& b) {
    return a.clearance != b.clearance ? a.clearance < b.clearance : a.facet < b.facet;
  });
}

double FacetedWalls::time_to_touch(Id facet, const Vector<3>& p, const Vector<3>& v, double r, double growth,
                                   double limit) const {
  constexpr double never = std::numeric_limits<double>::infinity();
  const double close = closely * extent_;
  double t = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Vector<3> offset = facets_[facet].offset(p + t * v);
    const double distance = offset.norm(), gap = distance - inset_ - r - growth * t;
    const double closing = growth - offset.dot(v) / distance;
    if (!(closing > 0)) return never;  // nor does it close later, as the gap is convex
    if (gap <= close) break;
    t += gap / closing;
    if (!(t < limit)) return never;
  }
  return t < limit ? t : never;
}

}  // namespace bernal

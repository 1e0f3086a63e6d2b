#include "cad/repair/obstacles.hpp"

#include <limits>
#include <optional>

#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/cgal_surfaces.hpp"
#include "cad/triangle_tree.hpp"
#include "geometry/changes.hpp"

namespace bernal::cad {
namespace {

bool encloses_a_corner_of(const Mesh& mesh, const Mesh& other) {
  return TriangleTree(mesh).crossing(other.vertices.front(), 0, std::numeric_limits<double>::infinity()) ==
         Crossing::odd;
}

}  // namespace

TakenOut take_out(Mesh& container, const Mesh& obstacle) {
  Mesh both = container, turned = obstacle;
  turn_inside_out(turned);
  append(both, turned);
  if (!intersects_itself(both)) {
    if (encloses_a_corner_of(container, obstacle)) {
      container = std::move(both);
      return TakenOut::done;
    }
    return encloses_a_corner_of(obstacle, container) ? TakenOut::whole : TakenOut::outside;
  }
  std::optional<Mesh> rest = combine(container, obstacle, Combine::take_out);
  if (!rest) return TakenOut::entangled;
  if (rest->triangles.empty()) return TakenOut::whole;
  container = std::move(*rest);
  return TakenOut::done;
}

}  // namespace bernal::cad

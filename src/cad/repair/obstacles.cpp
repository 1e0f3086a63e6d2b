#include "cad/repair/obstacles.hpp"

#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "bernal/cad/read_mesh.hpp"
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

void take_out(Mesh& container, const Mesh& obstacle, const std::string& name) {
  constexpr const char* is_whole = "leaves nothing of the container; check its unit and place";
  const auto refuse = [&](const char* why) {
    throw OptionError("obstacles", fmt::format("{} {}", name, why));
  };
  Mesh both = container, turned = obstacle;
  both.exact = nullptr;
  both.surface = nullptr;
  turn_inside_out(turned);
  append(both, turned);
  if (!intersects_itself(both)) {
    if (!encloses_a_corner_of(container, obstacle))
      refuse(encloses_a_corner_of(obstacle, container)
                 ? is_whole
                 : "lies outside of the container, or in another solid; check its unit and place");
    container = std::move(both);
    return;
  }
  std::optional<Mesh> rest = combine(container, obstacle, Combine::take_out);
  if (!rest)
    refuse("meets the wall in a way that cannot be cut out; move it a little, or take it out in CAD");
  if (rest->triangles.empty()) refuse(is_whole);
  container = std::move(*rest);
}

}  // namespace bernal::cad

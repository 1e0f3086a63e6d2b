#include "cad/obstacles.hpp"

#include <limits>
#include <optional>

#include "cad/body_union.hpp"
#include "cad/self_intersections.hpp"
#include "cad/triangle_tree.hpp"

namespace bernal::cad {
namespace {

/// Both surfaces, the second turned: its inside is outside.
Mesh with_turned(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + c, first + b});
  return mesh;
}

bool encloses_a_corner_of(const Mesh& mesh, const Mesh& other) {
  return TriangleTree(mesh).crossing(other.vertices.front(), 0, std::numeric_limits<double>::infinity()) ==
         Crossing::odd;
}

}  // namespace

TakenOut take_out(Mesh& container, const Mesh& obstacle) {
  Mesh both = with_turned(container, obstacle);
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

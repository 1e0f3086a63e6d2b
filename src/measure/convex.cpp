#include "measure/convex.hpp"

#include <algorithm>
#include <functional>
#include <tuple>
#include <vector>

#include "core/disjoint_sets.hpp"

namespace bernal {

bool is_convex(const Mesh& mesh) {
  constexpr double rounding = 1e-12;
  const double size = bounds_of(mesh).size().maxCoeff();
  const auto faces = static_cast<std::uint32_t>(mesh.triangles.size());
  struct Side {
    std::uint32_t a, b, face;
    bool operator<(const Side& o) const { return std::tie(a, b) < std::tie(o.a, o.b); }
  };
  std::vector<Side> sides;
  for (std::uint32_t f = 0; f < faces; ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), f});
    }
  }
  std::ranges::sort(sides, std::less<>());
  DisjointSets pieces(faces);
  for (std::size_t s = 1; s < sides.size(); ++s) {
    if (sides[s - 1] < sides[s]) continue;
    const std::uint32_t f = sides[s - 1].face, g = sides[s].face;
    pieces.unite(f, g);
    const auto& [a, b, c] = mesh.triangles[f];
    const Vector<3> normal = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const std::uint32_t v : mesh.triangles[g])
      if (normal.dot(mesh.vertices[v] - mesh.vertices[a]) > rounding * size * normal.norm()) return false;
  }
  for (std::uint32_t f = 1; f < faces; ++f)
    if (pieces.find(f) != pieces.find(0)) return false;
  return true;
}

}  // namespace bernal

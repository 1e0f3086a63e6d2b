#include "geometry/edges.hpp"

#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace bernal {

MeshEdges::MeshEdges(std::span<const FaceCorners> triangles) {
  uses_.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1U) % 3];
      uses_.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::ranges::sort(uses_, {},
                    [](const EdgeUse& u) { return std::tuple(u.low, u.high, u.triangle, u.side); });
}

std::size_t MeshEdges::triangles_at(std::uint32_t a, std::uint32_t b) const {
  const auto ends_of = [](const EdgeUse& use) { return std::pair(use.low, use.high); };
  return std::ranges::equal_range(uses_, std::pair(std::min(a, b), std::max(a, b)), {}, ends_of).size();
}

std::vector<EdgeUse> open_edges(std::span<const FaceCorners> triangles) {
  std::vector<EdgeUse> open;
  MeshEdges(triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 1) open.push_back(uses.front());
  });
  std::ranges::sort(open, {}, [](const EdgeUse& use) { return std::pair(use.triangle, use.side); });
  return open;
}

SharpEdges sharp_edges(const Mesh& mesh, std::size_t most,
                       const std::function<bool(const Vector<3>&, const Vector<3>&)>& also) {
  const double cos_of_bend = std::cos(30 * std::numbers::pi / 180);
  const auto normal_of = [&](const EdgeUse& use) -> Vector<3> {
    const auto& [a, b, c] = mesh.triangles[use.triangle];
    return (mesh.vertices[b] - mesh.vertices[a])
        .stableNormalized()
        .cross((mesh.vertices[c] - mesh.vertices[a]).stableNormalized())
        .stableNormalized();
  };
  SharpEdges edges;
  MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
    const EdgeUse& edge = uses.front();
    if (mesh.vertices[edge.low] == mesh.vertices[edge.high]) return;
    if (uses.size() == 2) {
      const Vector<3> n = normal_of(uses[0]), m = normal_of(uses[1]);
      const bool bends = !n.isZero() && !m.isZero() && n.dot(m) < cos_of_bend;
      if (!bends && !(also && also(n, m))) return;
    }
    edges.push_back({edge.low, edge.high});
  });
  if (edges.size() <= most) return edges;
  std::ranges::nth_element(
      edges, edges.begin() + static_cast<std::ptrdiff_t>(most), std::greater<>(),
      [&](const auto& edge) { return (mesh.vertices[edge[1]] - mesh.vertices[edge[0]]).squaredNorm(); });
  edges.resize(most);
  return edges;
}

}  // namespace bernal

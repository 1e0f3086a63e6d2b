#include "geometry/topology.hpp"

#include <algorithm>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "geometry/measures.hpp"

namespace bernal {

std::vector<bool> MeshTopology::closed_components() const {
  std::vector<bool> closed(components, true);
  for (std::size_t t = 0; t < neighbor.size(); ++t)
    for (const std::uint32_t beside : neighbor[t])
      if (beside == no_index) closed[component[t]] = false;
  return closed;
}

MeshTopology topology_of(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  MeshTopology result;
  result.neighbor.assign(count, {no_index, no_index, no_index});
  result.fan.resize(count);
  DisjointSets pieces(count), corners(3 * count);
  const auto corner_at = [](const EdgeUse& use, bool low) {
    return 3 * use.triangle + (use.side + (use.upwards == low ? 0U : 1U)) % 3;
  };
  MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
    ++result.edges;
    result.open_edges += uses.size() == 1;
    result.non_manifold_edges += uses.size() > 2;
    if (uses.size() != 2) return;
    const EdgeUse &u = uses[0], &v = uses[1];
    result.misoriented_edges += u.upwards == v.upwards;
    result.neighbor[u.triangle][u.side] = v.triangle;
    result.neighbor[v.triangle][v.side] = u.triangle;
    pieces.unite(u.triangle, v.triangle);
    for (const bool low : {true, false}) corners.unite(corner_at(u, low), corner_at(v, low));
  });

  const std::vector<std::uint32_t> fans = corners.numbered();
  std::vector<std::uint32_t> fans_at(mesh.vertices.size(), 0);
  for (std::uint32_t i = 0; i < 3 * count; ++i) {
    if (fans[i] == result.fans) {
      ++result.fans;
      ++fans_at[mesh.triangles[i / 3][i % 3]];
    }
    result.fan[i / 3][i % 3] = fans[i];
  }
  result.non_manifold_vertices =
      static_cast<std::uint64_t>(std::ranges::count_if(fans_at, [](std::uint32_t n) { return n > 1; }));
  result.component = pieces.numbered();
  for (const std::uint32_t c : result.component) result.components = std::max(result.components, c + 1);
  return result;
}

std::uint32_t orient_consistently(Mesh& mesh, const MeshTopology& topology) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  const auto agree = [&](std::uint32_t t, int k, std::uint32_t other) {
    const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
    const auto& o = mesh.triangles[other];
    for (int j = 0; j < 3; ++j)
      if (o[j] == b && o[(j + 1) % 3] == a) return true;
    return false;
  };

  enum : std::uint8_t { unseen, kept, turned };
  std::vector<std::uint8_t> state(count, unseen);
  std::vector<std::uint32_t> piece;
  std::uint32_t total = 0;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    if (state[seed] != unseen) continue;
    state[seed] = kept;
    piece.assign(1, seed);
    std::uint32_t turns = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t t = piece[i];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = topology.neighbor[t][k];
        if (other == no_index) continue;
        const std::uint8_t wanted = agree(t, k, other) == (state[t] == kept) ? kept : turned;
        if (state[other] == unseen) {
          state[other] = wanted;
          turns += wanted == turned;
          piece.push_back(other);
        } else if (state[other] != wanted) {
          return no_index;
        }
      }
    }
    if (2 * turns > piece.size()) {
      for (const std::uint32_t t : piece) state[t] = state[t] == kept ? turned : kept;
      turns = static_cast<std::uint32_t>(piece.size()) - turns;
    }
    total += turns;
  }
  for (std::uint32_t t = 0; t < count; ++t)
    if (state[t] == turned) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return total;
}

bool is_convex(const Mesh& mesh) {
  constexpr double rounding = 1e-12;
  const MeshTopology topology = topology_of(mesh);
  if (topology.components != 1 || !topology.closed()) return false;
  const double size = bounds_of(mesh).size().maxCoeff();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector<3> normal = doubled_area(mesh, mesh.triangles[t]), &on = mesh.vertices[mesh.triangles[t][0]];
    for (const std::uint32_t beside : topology.neighbor[t])
      for (const std::uint32_t v : mesh.triangles[beside])
        if (normal.dot(mesh.vertices[v] - on) > rounding * size * normal.norm()) return false;
  }
  return true;
}

}  // namespace bernal

#include "cad/mesh_topology.hpp"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_map.hpp>

#include "core/disjoint_sets.hpp"

namespace bernal::cad {
namespace {

struct EdgeUse {
  std::uint32_t low, high;  ///< vertices
  std::uint32_t triangle;
  std::uint8_t edge;
  bool upwards;  ///< runs from low to high

  auto key() const { return std::pair(low, high); }
  bool operator<(const EdgeUse& other) const {
    return std::tuple(low, high, triangle, edge) <
           std::tuple(other.low, other.high, other.triangle, other.edge);
  }
};

std::vector<EdgeUse> edge_uses(const Mesh& mesh) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

}  // namespace

MeshTopology topology_of(const Mesh& mesh) {
  const std::size_t count = mesh.triangles.size();
  MeshTopology result;
  result.neighbor.assign(count, {none, none, none});
  result.fan.resize(count);
  DisjointSets pieces(count), corners(3 * count);

  const std::vector<EdgeUse> uses = edge_uses(mesh);
  for (auto first = uses.begin(); first != uses.end();) {
    const auto last =
        std::find_if(first, uses.end(), [&](const EdgeUse& u) { return u.key() != first->key(); });
    ++result.edges;
    if (last - first == 1) {
      ++result.open_edges;
    } else if (last - first > 2) {
      ++result.non_manifold_edges;
    } else {
      const EdgeUse &u = first[0], &v = first[1];
      result.misoriented_edges += u.upwards == v.upwards;
      result.neighbor[u.triangle][u.edge] = v.triangle;
      result.neighbor[v.triangle][v.edge] = u.triangle;
      pieces.unite(u.triangle, v.triangle);
      const auto corner = [](const EdgeUse& use, bool at_low) {
        return 3 * use.triangle + (use.edge + (use.upwards == at_low ? 0U : 1U)) % 3;
      };
      corners.unite(corner(u, true), corner(v, true));
      corners.unite(corner(u, false), corner(v, false));
    }
    first = last;
  }

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
      static_cast<std::uint64_t>(std::count_if(fans_at.begin(), fans_at.end(), [](auto n) { return n > 1; }));
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
        if (other == none) continue;
        const std::uint8_t wanted = agree(t, k, other) == (state[t] == kept) ? kept : turned;
        if (state[other] == unseen) {
          state[other] = wanted;
          turns += wanted == turned;
          piece.push_back(other);
        } else if (state[other] != wanted) {
          return none;
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

void keep_only(Mesh& mesh, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < kept.size(); ++t)
    if (kept[t]) mesh.triangles[count++] = mesh.triangles[t];
  mesh.triangles.resize(count);
}

void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

void drop_unused_vertices(Mesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), none);
  std::vector<Vector<3>> used;
  for (FaceCorners& t : mesh.triangles)
    for (std::uint32_t& v : t) {
      if (number[v] == none) {
        number[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(mesh.vertices[v]);
      }
      v = number[v];
    }
  mesh.vertices = std::move(used);
}

void weld_equal_points(Mesh& mesh) {
  boost::unordered_map<std::array<double, 3>, std::uint32_t> index;
  std::vector<Vector<3>> vertices;
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& i : triangle) {
      const Vector<3>& p = mesh.vertices[i];
      const auto [entry, is_new] = index.try_emplace({p[0] + 0.0, p[1] + 0.0, p[2] + 0.0},
                                                     static_cast<std::uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(p);
      i = entry->second;
    }
  mesh.vertices = std::move(vertices);
}

}  // namespace bernal::cad

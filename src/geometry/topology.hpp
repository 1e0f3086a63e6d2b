#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/edges.hpp"

namespace bernal {

/// Connectivity of a mesh's triangles, by vertex numbers alone; side k of a triangle runs from its corner k
/// to its corner k + 1 (mod 3).
///
/// Only an edge with exactly two triangles connects them. So a vertex where several fans of triangles meet
/// counts once for each fan in `fans`, and chi = fans - edges + triangles is that of the surface with its
/// pinched vertices separated.
struct MeshTopology {
  std::uint64_t edges = 0;
  std::uint64_t open_edges = 0;          ///< with one triangle
  std::uint64_t non_manifold_edges = 0;  ///< with three or more
  std::uint64_t misoriented_edges = 0;   ///< with two triangles that run along it in the same direction
  std::uint64_t fans = 0;
  std::uint64_t non_manifold_vertices = 0;  ///< with more than one fan
  std::uint32_t components = 0;

  std::vector<std::array<std::uint32_t, 3>> neighbor;  ///< of each triangle across each side, or no_index
  std::vector<std::uint32_t> component;                ///< of each triangle
  std::vector<std::array<std::uint32_t, 3>> fan;       ///< of each triangle's corners, numbered from 0

  bool closed() const { return open_edges == 0 && non_manifold_edges == 0; }
  /// Of each component, whether every side of its triangles has a neighbour.
  std::vector<bool> closed_components() const;
};

/// Cost: O(T log T).
MeshTopology topology_of(const Mesh&);

/// Flips triangles so that neighbours agree; in each component the minority is flipped. Returns how many
/// were, or `no_index` for a one-sided surface, which does not change. `topology` keeps its numbering of
/// components, but its members by side and corner become invalid.
std::uint32_t orient_consistently(Mesh&, const MeshTopology&);

/// Whether a closed mesh without self-intersections is convex, to rounding: connected, and no triangle rises
/// above a neighbour's plane. Cost: O(T log T).
bool is_convex(const Mesh&);

}  // namespace bernal

#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/edges.hpp"

namespace bernal {

/// How the triangles of a mesh hang together, by vertex numbers alone; side k of a triangle runs from its
/// corner k to its corner k + 1 (mod 3).
///
/// Only an edge with exactly two triangles joins them. So a vertex where several fans of triangles meet
/// counts once for each fan in `fans`, and chi = fans - edges + triangles is that of the surface with its
/// pinched vertices pulled apart.
struct MeshTopology {
  std::uint64_t edges = 0;
  std::uint64_t open_edges = 0;          ///< with one triangle
  std::uint64_t non_manifold_edges = 0;  ///< with three or more
  std::uint64_t misoriented_edges = 0;   ///< with two that run along it in the same direction
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

/// Turns triangles so that neighbours agree; in each component the fewer are turned. Returns how many were,
/// or `no_index` if the surface is one-sided, and then leaves the mesh as it was. `topology` keeps its
/// numbering of components, but its members by side and corner no longer hold.
std::uint32_t orient_consistently(Mesh&, const MeshTopology&);

/// Whether a closed mesh, which does not cross itself, is convex, to rounding: in one piece, and no triangle
/// rises above a neighbour's plane. Cost: O(T log T).
bool is_convex(const Mesh&);

}  // namespace bernal

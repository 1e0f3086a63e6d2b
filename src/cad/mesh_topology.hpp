#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

inline constexpr std::uint32_t none = 0xFFFFFFFF;

/// How the triangles of a mesh hang together, by vertex indices alone; edge k of a triangle runs from its
/// corner k to its corner k + 1 (mod 3).
///
/// Only an edge with exactly two faces joins them. So a vertex where several fans meet counts once for each
/// fan in `fans`, and chi = fans - edges + faces is that of the surface with its pinched vertices pulled
/// apart.
struct MeshTopology {
  std::uint64_t edges = 0;
  std::uint64_t open_edges = 0;          ///< with one face
  std::uint64_t non_manifold_edges = 0;  ///< with three or more
  std::uint64_t misoriented_edges = 0;   ///< with two that run along it in the same direction
  std::uint64_t fans = 0;
  std::uint64_t non_manifold_vertices = 0;  ///< with more than one fan
  std::uint32_t components = 0;

  std::vector<std::array<std::uint32_t, 3>> neighbor;  ///< of each triangle across each edge, or none
  std::vector<std::uint32_t> component;                ///< of each triangle
  std::vector<std::array<std::uint32_t, 3>> fan;       ///< of each triangle's corners, numbered from 0

  bool closed() const { return open_edges == 0 && non_manifold_edges == 0; }
};

/// Cost: O(T log T).
MeshTopology topology_of(const Mesh& mesh);

/// Turns triangles so that neighbours agree; in each component the fewer are turned. Returns how many were,
/// or `none` if the surface is one-sided, and then leaves the mesh as it was. `topology` keeps its numbering
/// of components, but its corner-wise members no longer hold.
std::uint32_t orient_consistently(Mesh& mesh, const MeshTopology& topology);

/// Drops the triangles that are not kept.
void keep_only(Mesh& mesh, const std::vector<bool>& kept);

/// Numbers the vertices anew, in the order in which the triangles first use them, without the unused ones.
void drop_unused_vertices(Mesh& mesh);

/// The faces of another surface too, with corners of their own.
void append(Mesh& mesh, const Mesh& other);

/// Equal points become one, in the order in which faces use them.
void weld_equal_points(Mesh& mesh);

}  // namespace bernal::cad

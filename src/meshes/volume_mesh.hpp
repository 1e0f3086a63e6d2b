#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshes/conforming_surface.hpp"

namespace bernal {

/// The four corners of a tetrahedron: (b - a) · ((c - a) × (d - a)) is positive.
using TetrahedronCorners = std::array<std::uint32_t, 4>;

/// Pairs of corners of a tetrahedron, in the order of its edges, which is that of VTK and Abaqus.
inline constexpr std::array<std::array<int, 2>, 6> edges_of_tetrahedron = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
/// Its faces, outwards; the k-th is opposite corner k.
inline constexpr std::array<std::array<int, 3>, 4> faces_of_tetrahedron = {
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// A prism between two triangles: the corners of the lower one, whose normal points to the upper one, then
/// those above them. Where a corner is its own upper one the prism is a pyramid; where two are, a
/// tetrahedron.
using PrismCorners = std::array<std::uint32_t, 6>;

/// Prisms in the fluid, in layers on triangles of the surface.
struct PrismStacks {
  std::size_t layers = 0;
  std::vector<std::uint32_t> triangle = {};  ///< that each stack stands on, ascending
  std::vector<PrismCorners> prisms = {};     ///< stack by stack, from the triangle on

  bool empty() const { return prisms.empty(); }
  /// The last prism of a stack.
  const PrismCorners& top(std::size_t stack) const { return prisms[(stack + 1) * layers - 1]; }
};

/// The tetrahedra that a prism is cut into: at most three, fewer for a pyramid and a tetrahedron. The diagonal
/// of a side goes from below the corner of lower rank to above the other one, so that prisms side by side are
/// cut along the same; ranks are the numbers of the lower corners where none are given.
std::vector<TetrahedronCorners> tetrahedra_of(const PrismCorners&, const std::array<std::uint32_t, 3>& ranks);
inline std::vector<TetrahedronCorners> tetrahedra_of(const PrismCorners& prism) {
  return tetrahedra_of(prism, {prism[0], prism[1], prism[2]});
}

/// Its corners, each once: six; five of a pyramid, of which the first four go around and turn to the last
/// one; four of a tetrahedron. In the order of Gmsh's.
std::vector<std::uint32_t> distinct_corners(const PrismCorners&);

/// Tetrahedra, and prisms, that fill the regions of a surface. Its vertices are the first ones, in their
/// order, and its triangles are faces of these.
struct VolumeMesh {
  std::vector<Vector<3>> vertices;
  std::vector<TetrahedronCorners> tetrahedra;
  std::vector<std::uint32_t> region;  ///< of each tetrahedron
  std::vector<FaceCorners> triangles;
  std::vector<std::uint32_t> patch;  ///< of each triangle
  std::vector<SurfacePatch> patches;
  std::vector<MeshRegion> regions;
  /// Nodes of opposite ends of periods, (lower, upper) by axis: equal but for the coordinate along it.
  std::array<std::vector<std::array<std::uint32_t, 2>>, 3> periodic;
  PrismStacks stacks = {};  ///< in the first region
  /// Second order: the middles of edges, as numbers among the nodes, which are the vertices and then these.
  std::vector<Vector<3>> middles = {};
  std::vector<std::array<std::uint32_t, 6>> middles_of_tetrahedron = {};
  std::vector<std::array<std::uint32_t, 3>> middles_of_triangle = {};  ///< after corners 0, 1, 2

  bool is_curved() const { return !middles_of_tetrahedron.empty(); }
  std::size_t node_count() const { return vertices.size() + middles.size(); }
  const Vector<3>& node(std::size_t i) const {
    return i < vertices.size() ? vertices[i] : middles[i - vertices.size()];
  }
};

/// Volume of every region, as the sum of its cells with straight edges.
std::vector<double> volumes_of_regions(const VolumeMesh&);
/// The same from triangles alone, by the divergence theorem.
std::vector<double> volumes_between(const ConformingSurface&);

}  // namespace bernal

#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "geometry/topology.hpp"

namespace bernal {

/// A planar polygon with holes over the corners of a mesh: the first loop is the outline.
struct FlatFace {
  std::vector<std::vector<std::uint32_t>> loops;
};

/// Triangles of a mesh that hang together in one plane: those whose corners are at most `tolerance` off the
/// plane of the group's largest triangle and which face its way, and beside them triangles that are no higher
/// than the tolerance, whichever way these face.
struct FlatGroups {
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::vector<std::uint32_t>> members;  ///< by group; the first is the largest triangle
};
/// Precondition: `topology` is the mesh's. Cost: O(T log T).
FlatGroups flat_groups_of(const Mesh&, const MeshTopology& topology, double tolerance);

/// The surface of a mesh with coplanar triangles joined to polygons, so that edges made only by triangulation
/// disappear. Corners are at most `tolerance` off the plane of their polygon's largest triangle. A region
/// with an outline that meets itself keeps its triangles. Precondition: closed, oriented. Cost: O(T log T).
std::vector<FlatFace> flat_faces_of(const Mesh&, double tolerance);

}  // namespace bernal

#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// A planar polygon with holes over the corners of a mesh: the first loop is the outline.
struct FlatFace {
  std::vector<std::vector<std::uint32_t>> loops;
};

/// The surface of a mesh with coplanar triangles joined to polygons, so that edges made only by triangulation
/// disappear. Corners are at most `tolerance` off the plane of their polygon's largest triangle. A region
/// with an outline that meets itself keeps its triangles. Precondition: closed, oriented. Cost: O(T log T).
std::vector<FlatFace> flat_faces_of(const Mesh&, double tolerance);

}  // namespace bernal

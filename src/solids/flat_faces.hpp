#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// A plane polygon with holes of the corners of a mesh: the first loop is the outline.
struct FlatFace {
  std::vector<std::vector<std::uint32_t>> loops;
};

/// The surface of a mesh with triangles in one plane joined to polygons, so that no edge is left that only
/// triangulation made. Corners are at most `tolerance` off the plane of their polygon's largest triangle.
/// Where what lies in one plane is bounded by a line that meets itself, its triangles stay as they are.
/// Precondition: closed, oriented. Cost: O(T log T).
std::vector<FlatFace> flat_faces_of(const Mesh&, double tolerance);

}  // namespace bernal

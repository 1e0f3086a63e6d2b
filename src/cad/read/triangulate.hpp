#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Triangles over `points` that fill a polygon, possibly concave, with its orientation: a quadrangle is split
/// at the diagonal with the smaller fold, others by the constrained Delaunay triangulation in the plane of
/// their normal. A polygon that cannot be projected without folds becomes a fan from its first corner; the
/// test for self-intersections finds it then. Precondition: more than three corners, each different from the
/// next. Cost: O(n log n) for n corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vector<3>>& points,
                                                      const std::vector<std::uint32_t>& polygon);

/// Triangles that fill the regions of a plane inside an odd number of closed lines, given as edges, and face
/// along `normal`. Absent if the edges cross or do not form closed lines. Cost: O(n log n) for n edges.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_regions(
    const std::vector<Vector<3>>& points, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges,
    const Vector<3>& normal);

}  // namespace bernal::cad

#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Triangles over `points` that fill a polygon, a concave one rightly, and run round as it does: a quadrangle
/// across the diagonal that folds less, others by the constrained Delaunay triangulation in the plane across
/// their normal. Those of a polygon that cannot be projected without folding fan out from its first corner;
/// the self-intersections tell then. Precondition: more than three corners, each different from the next.
/// Cost: O(n log n) for n corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vector<3>>& points,
                                                      const std::vector<std::uint32_t>& polygon);

/// Triangles that fill the regions of a plane inside an odd number of closed lines, which are given as edges.
/// They face along `normal`. Nothing if the edges cross or do not form closed lines. Cost: O(n log n) for n
/// edges.
std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_regions(
    const std::vector<Vector<3>>& points, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges,
    const Vector<3>& normal);

}  // namespace bernal::cad

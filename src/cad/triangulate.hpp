#pragma once
#include <array>
#include <cstdint>
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

}  // namespace bernal::cad

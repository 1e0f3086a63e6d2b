#pragma once
#include <cstdint>

#include "bernal/domain/domain.hpp"
#include "cad/read/polygon_soup.hpp"

namespace bernal::cad {

/// Triangles over distinct points, and what was done to the soup. The surface does not move.
struct Triangles {
  Mesh mesh;
  std::uint64_t welded = 0;        ///< points equal to an earlier one
  std::uint64_t triangulated = 0;  ///< polygons with more than three corners
  std::uint64_t collapsed = 0;     ///< polygons with fewer than three distinct corners, dropped
  std::uint64_t back_sides = 0;    ///< triangles of a surface stored in both orientations, dropped
  std::uint64_t repeated = 0;  ///< triangles with the corners and the orientation of an earlier one, dropped
};

/// Welds exactly equal points (-0.0 equals 0.0), triangulates polygons, concave ones included, and drops
/// unused points, collapsed polygons and exact repetitions. Points are in the order in which the polygons
/// first use them. Cost: O(n log n).
Triangles make_triangles(const PolygonSoup& soup);

}  // namespace bernal::cad

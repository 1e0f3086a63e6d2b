#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal::cad {

// What CGAL does with meshes of halfedges, which takes the compiler half a minute: one file sees it.

/// Triangles over `points` that fill the polygons, concave ones rightly; those of a polygon that cannot be
/// projected without folding fan out from a corner. Precondition: more than two corners each, all different
/// from the next.
std::vector<std::array<std::uint32_t, 3>> triangulate(
    const std::vector<Vector<3>>& points, const std::vector<std::vector<std::uint32_t>>& polygons);

/// Turns whole components so that the mesh bounds a volume: outermost ones outwards, those inside them
/// inwards, and so on. Precondition: closed, consistently oriented, no self-intersections.
void orient_components(Mesh& mesh);

}  // namespace bernal::cad

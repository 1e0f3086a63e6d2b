#pragma once
#include <cstdint>
#include <vector>

#include "meshes/smooth_walls.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {

/// Vertices along every edge between smooth parts of walls, from its first corner to its second: as the sizes
/// of the spheres near it ask for, and closer where points of the same part are near: a piece of an edge is
/// at most 1.6 times as long as these are far from it, so that triangles in the part need no other points on
/// its border. Beside corners below 60 degrees pieces end at the same distances from the corner (powers of
/// 2), so that they do not ask each other for ever smaller ones. Pieces are not made shorter than 3 % of the
/// size there: in needles of the given triangles angles stay what they are. Cost: O(points), times those near
/// each.
std::vector<std::vector<std::uint32_t>> points_on_flat_edges(SurfaceDraft&, const SmoothWalls&, const Mesh&);

}  // namespace bernal

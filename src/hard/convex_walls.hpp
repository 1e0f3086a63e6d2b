#pragma once
#include <span>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "hard/walls.hpp"

namespace bernal {

/// The walls around a convex shape: those of an analytic container, or the planes of a mesh's facets. None
/// where it is not convex: of a mesh with a corner more than 4 tolerances outside of a facet's plane, and of
/// polygons and solids of revolution, which are not asked.
///
/// Facets with corners in one plane to within `tolerance` become one wall: those of a flat side of many
/// triangles with rounded corners, and a few neighbours on a finely divided round side. Each wall is at the
/// innermost corner of its facets. So every point of the mesh lies on or behind some wall, and the region
/// between the walls is inside the mesh, to rounding, for any tolerance; it is smaller than the mesh by at
/// most 6 tolerances. Each plane is the best fit to all corners near it, starting from that of its largest
/// facet, because the normals of thin triangles are unreliable.
///
/// Precondition: D is the dimension of the shape; meshes are closed and oriented outwards. Cost: about 10 µs
/// a wall.
template <int D = 3>
std::vector<Wall<D>> convex_walls(const Domain& shape, double tolerance);

struct LargestSphere {
  Vector<3> center;
  double radius;
};

/// The largest sphere in the region between planes, which lies within `bounds`: the linear programme
///   maximise r  subject to  n·c + r <= o  for every plane
/// in four variables, the (Chebyshev) centre c and r, with the planes in random order.
///
/// The radius is the clearance of the centre, so this sphere fits; no other is larger by more than about a
/// hundred roundoffs of the bounds. Negative if the region is empty. Precondition: no wall is round. Cost:
/// O(planes), expected, about 0.2 µs each.
LargestSphere largest_sphere_between(std::span<const Wall<3>> planes, const Bounds<3>& bounds);

}  // namespace bernal

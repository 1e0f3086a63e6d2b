#pragma once
#include <span>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "hard/walls.hpp"

namespace bernal {

/// The walls around a convex shape: those of an analytic container, or the planes of a mesh's facets.
///
/// Facets whose corners lie in one plane to within `tolerance` become one wall: of a flat side in many
/// triangles, whose corners a file has rounded, and of a few neighbours where a round side is cut very
/// finely. Each wall stands at the innermost corner of its facets. So every point of the mesh lies on or
/// behind some wall, and what is between the walls is inside the mesh, to rounding, whatever the tolerance;
/// and it is smaller than the mesh by no more than 6 tolerances. Each plane is the best one through all
/// corners near it, starting from that of its largest facet: thin triangles alone do not say where they
/// point.
///
/// Throws Error{bad_scene} for a mesh that is not convex: with a corner more than 4 tolerances outside of a
/// facet's plane. Precondition: meshes are closed and oriented outwards. Cost: about 10 µs a
/// wall.
std::vector<Wall<3>> convex_walls(const Domain& shape, double tolerance);

struct LargestSphere {
  Vector<3> center;
  double radius;
};

/// The largest sphere in the region between planes, which lies within `bounds`: the linear programme
///   maximise r  subject to  n·c + r <= o  for every plane
/// in four variables, the centre c, which is that of Chebyshev, and r, with the planes in a random order.
///
/// The radius is the clearance of the centre, so that this sphere fits; no other is larger by more than some
/// hundred roundoffs of the bounds. Below 0 where nothing is between the planes. Precondition: no wall is
/// round. Cost: O(planes), expected, about 0.2 µs each.
LargestSphere largest_sphere_between(std::span<const Wall<3>> planes, const Bounds<3>& bounds);

}  // namespace bernal

#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"
#include "hard/wall.hpp"

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

}  // namespace bernal

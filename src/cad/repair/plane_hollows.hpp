#pragma once
#include <optional>
#include <vector>

#include "cad/repair/surroundings.hpp"

namespace bernal::cad {

/// A hollow closed by a plane, like a vessel filled until it spills.
struct PlaneHollow {
  Space space;
  CutPlane brim;
  double openness = 0;  ///< area of the faces in the plane over that of the others
  Vector<3> inside;     ///< a point inside, far from its walls
};

/// The hollows of a solid that one plane closes, each up to the highest such plane, the largest first. The
/// plane cuts off whatever is above the brim: a handle, posts, a pipe. Plane normals are the directions that
/// most faces look along, the principal axes of all normals, and z; plane levels are those of faces in the
/// plane, and of corners that are peaks or passes. Orientation does not matter; a hollow without such a brim
/// is not found. Precondition: closed, without voids. Cost: one cut of the solid a plane, up to 100 planes,
/// fewer for many faces.
std::vector<PlaneHollow> hollows_below_planes(const Mesh& solid, double tolerance);

/// A point inside closed walls, halfway between the largest face and the wall opposite.
std::optional<Vector<3>> point_within(const Mesh& walls, const TriangleTree& tree);

}  // namespace bernal::cad

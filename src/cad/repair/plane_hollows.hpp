#pragma once
#include <optional>
#include <vector>

#include "cad/repair/surroundings.hpp"

namespace bernal::cad {

/// A hollow that a plane closes, as a vessel is filled until it would spill.
struct PlaneHollow {
  Space space;
  CutPlane brim;
  double openness = 0;  ///< area of the faces in the plane over that of the others
  Vector<3> inside;     ///< a point of it, far from its walls
};

/// The hollows of a solid that one plane closes, each to the highest plane that does, the largest first: for
/// whatever stands beyond the brim, a handle, posts, a pipe, is cut off by it. Planes lie across the
/// directions that most faces look along, the principal axes of all normals, and z; on levels where faces lie
/// in the plane, or corners that are peaks or passes. Orientation does not matter; a hollow without such a
/// brim is not found. Precondition: closed, without voids. Cost: a cut of the solid a plane, up to 100 of
/// them, fewer for many faces.
std::vector<PlaneHollow> hollows_below_planes(const Mesh& solid, double tolerance);

/// A point of the space that walls enclose, halfway between its largest face and what is opposite.
std::optional<Vector<3>> point_within(const Mesh& walls, const TriangleTree& tree);

}  // namespace bernal::cad

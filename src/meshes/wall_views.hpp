#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "meshes/neck_shape.hpp"

namespace bernal {

/// A wall as seen from a point inside.
struct WallSheet {
  std::uint32_t wall;  ///< as SurfacePatch::index of walls
  Vector<3> outward;   ///< unit, to its nearest point
  double distance;
};

/// The walls of a box, cylinder or sphere, but for a round one from its middle.
std::vector<WallSheet> walls_around(const Domain&, const Vector<3>& p);

/// The radius of a round wall; 0 for flat ones.
double radius_of_wall(const Domain&, std::uint32_t wall);

/// By how much a wall rises at most above its tangent plane within a circle of this radius about the axis of
/// a neck: 0 for flat ones.
double rise_of_wall(const Domain&, std::uint32_t wall, double radius);
/// The direction across the axis of a neck and a round wall's own; zero for a spherical one.
Vector<3> across_wall(const Domain&, const Vector<3>& axis);
/// By how much a wall rises above its tangent plane at a point, given from the axis of a neck, which is
/// normal to it.
double rise_at_wall(const Domain&, std::uint32_t wall, const Vector<3>& axis, const Vector<3>& beside);
/// What a round wall takes of the volume of a neck up to its tangent plane. Heights are scaled, so that is
/// the integral over heights of that of the rise over the sections, over the neck's height; by Gauss's rules.
double volume_before_wall(const Domain&, std::uint32_t wall, const NeckShape&);

}  // namespace bernal

#pragma once
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

// Containers as people state them, each of which is a Domain of another name.

/// A frustum, or a cone where one of the radii is 0: around `axis`, of any length, from the circle of the
/// first radius about `base` to that of the second, `height` farther.
struct Cone {
  std::vector<double> radii = {};  ///< at the base and at the top: two, not both 0
  double height = 1;
  Vector<3> axis = Vector<3>::UnitZ();
  Vector<3> base = Vector<3>::Zero();
};

/// What is between two circular cylinders of one axis.
struct Tube {
  double radius = 1;
  double inner_radius = 0.5;
  double height = 1;
  Vector<3> axis = Vector<3>::UnitZ();
  Vector<3> base = Vector<3>::Zero();
};

/// What a profile of points [r, z] sweeps over as it turns about the axis. A profile whose heights rise, or
/// fall, from every point to the next is a wall r(z): level ends close it. One with one end on the axis is
/// closed by a level line from the other end to it. Any other is closed by the line between its ends.
struct Lathed {
  std::vector<std::vector<Vector<2>>> profile = {};  ///< one line of points
  Vector<3> axis = Vector<3>::UnitZ();
  Vector<3> base = Vector<3>::Zero();
};

/// A polygon in the plane, holes in it taken out, straight up along z.
struct Extruded {
  Polygon polygon = {};
  double height = 1;
  Vector<3> base = Vector<3>::Zero();  ///< what the origin of the plane becomes
};

/// Their domains. Throw Error{bad_argument} as `require_profile` does, and where a tube has no room.
Revolved solid_of(const Cone&);
Revolved solid_of(const Tube&);
Revolved solid_of(const Lathed&);

}  // namespace bernal

#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// A wall as seen from a point inside.
struct WallView {
  std::uint32_t wall;  ///< as SurfacePatch::index of walls
  Vector<3> outward;   ///< unit, to its nearest point
  double distance;
};

/// The walls of a box, cylinder or sphere, but for a round one from its middle.
std::vector<WallView> walls_around(const Domain&, const Vector<3>& p);

/// The radius of a round wall; 0 for flat ones.
double radius_of_wall(const Domain&, std::uint32_t wall);

}  // namespace bernal

#pragma once
#include <cstdint>
#include <vector>

#include "bernal/domain/domain.hpp"

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
/// The volume between the tangent plane and the wall in that circle. Of a cylinder of radius R the integral
/// of R - sqrt(R² - x²), by Gauss and Chebyshev's rule.
double volume_before_wall(const Domain&, std::uint32_t wall, double radius);

}  // namespace bernal

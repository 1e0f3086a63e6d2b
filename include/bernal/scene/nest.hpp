#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bernal/scene/packing.hpp"

namespace bernal {

/// One level of a packing that has packings inside of its spheres: the spheres themselves, or all that lies
/// inside those of one class.
struct NestLevel {
  std::string
      name;       ///< "spheres" of the outermost; else the classes on the way in: "pebble", "pebble / kernel"
  int depth = 0;  ///< 0 of the outermost
  std::uint64_t packings = 0;  ///< that were made
  std::uint64_t packed = 0;    ///< spheres in these
  std::uint64_t filled = 0;    ///< spheres of the level around it that hold one, each as often as it stands
  std::uint64_t spheres = 0;   ///< that stand for themselves: those of the packing of each filled sphere
  double ball = 0;      ///< the largest radius of the balls that are filled, in `unit`; 0 of the outermost
  Unit unit = Unit::m;  ///< of the scenes of this level
  double packing_fraction = 0;  ///< of the balls that are filled; of the outermost, of its domain
  double share = 0;             ///< of the outermost domain's volume, that the spheres of this level take up
};

/// All levels, each before those within; the first is the packing itself. Cost: what is there, once.
std::vector<NestLevel> levels_of(const Packing&);

/// The spheres of all levels, which stand for themselves.
std::uint64_t spheres_of_all_levels(const Packing&);

/// A vector turned by a quaternion w, x, y, z that is not zero, as if its norm were 1: each component is off
/// by less than 4e-15 of the vector's length.
Vector<3> turned(const Vector<3>&, const std::array<double, 4>& quaternion);

}  // namespace bernal

#pragma once
#include <string_view>

#include "bernal/core/vector.hpp"

namespace bernal {

/// How a stage presses spheres.
struct Pressing {
  Vector<3> direction;
  bool loosely;             ///< by a tolerance that leaves spheres which do not rest
  double friction;          ///< the angle up to which it may hold spheres, in degrees
  std::string_view remedy;  ///< of spheres that do not rest as they should
};

}  // namespace bernal

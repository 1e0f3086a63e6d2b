#pragma once
#include "bernal/core/vector.hpp"

namespace bernal {

/// Every sphere moves along a direction until it touches, and slides on, until the bed is at rest (Han, Feng
/// & Owen 2005, section 2.1).
struct Compress {
  /// Global compression direction, of any length but 0; in two dimensions {0, -1} if nothing is said.
  Coordinates direction = {0, 0, -1};
  double tilt = 2;          ///< local directions are direction + tilt·(random unit vector); 0: none
  double tolerance = 1e-2;  ///< converged when an iteration lowers the potential by less than this share
  int max_iterations = 400;
  double buffer = 0.5;  ///< room in a sphere's bounding box on each side, in mean radii
};

}  // namespace bernal

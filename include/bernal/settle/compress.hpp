#pragma once
#include <optional>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Every sphere moves along a direction until it touches, and slides on, until the bed is at rest (Han, Feng
/// & Owen 2005, section 2.1).
struct Compress {
  /// Global compression direction, of any length but 0; in two dimensions {0, -1} if nothing is said.
  Coordinates direction = {0, 0, -1};
  double tilt = 2;  ///< local directions are direction + tilt·(random unit vector); 0: none
  /// How far the bed may sink in an iteration, in radii, and be settled all the same: local directions end
  /// when no layer sinks farther on average; then every sphere rolls down to rest.
  double rest = 0.2;
  /// In place of `rest`, as the paper has it: converged when an iteration lowers the potential by less than
  /// this share of what it is above the floor. In high beds that is soon, and spheres may still hang.
  std::optional<double> tolerance = {};
  int max_iterations = 10'000;
  double buffer = 0.5;  ///< room in a sphere's bounding box on each side, in mean radii
};

}  // namespace bernal

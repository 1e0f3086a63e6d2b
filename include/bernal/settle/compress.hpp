#pragma once
#include <optional>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Every sphere moves along a direction until it touches, and slides on, until the bed is at rest (Han, Feng
/// & Owen 2005, section 2.1).
struct Compress {
  /// Global compression direction, not 0, of any length; in two dimensions {0, -1} by default.
  Coordinates direction = {0, 0, -1};
  double tilt = 2;  ///< local directions are direction + tilt·(random unit vector); 0: none
  /// The bed counts as settled once no layer sinks farther than this in an iteration, on average, in radii.
  /// Local directions end then, and every sphere rolls down to rest.
  double rest = 0.2;
  /// Replaces `rest` by the paper's criterion: converged when an iteration lowers the potential above the
  /// floor by less than this share. In high beds that is soon, and spheres may still hang.
  std::optional<double> tolerance = {};
  int max_iterations = 10'000;
  double buffer = 0.5;  ///< margin of a sphere's bounding box on each side, in mean radii
};

}  // namespace bernal

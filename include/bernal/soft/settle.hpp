#pragma once
#include "bernal/core/vector.hpp"
#include "bernal/scene/bed_target.hpp"

namespace bernal {

/// A bed under gravity: spheres lie at the bottom of their container, and every one of them rests.
struct Settle {
  /// Of gravity, of any length but 0; in two dimensions {0, -1} if nothing is said.
  Coordinates direction = {0, 0, -1};
  /// What the bed is to be like, but for its height; of a scene, what its [spheres] say.
  BedTarget bed = {};
  /// How far a sphere may still fall and roll, in radii, and count as at rest. With more than 1e-7 it is only
  /// judged whether spheres hang.
  double rest = 1e-7;
};

}  // namespace bernal

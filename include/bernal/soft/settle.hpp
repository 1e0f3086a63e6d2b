#pragma once
#include "bernal/core/vector.hpp"
#include "bernal/scene/bed_target.hpp"

namespace bernal {

/// A bed under gravity: spheres lie at the bottom of their container, and every one of them rests.
struct Settle {
  /// Of gravity, with any length but 0; in two dimensions the default is {0, -1}.
  Coordinates direction = {0, 0, -1};
  /// What the bed is to be like, except its height. In a scene [spheres] says it.
  BedTarget bed = {};
  /// A sphere is at rest if it can fall and roll by no more than this, in radii. If it is more than 1e-7, it
  /// is only checked whether spheres hang.
  double rest = 1e-7;
};

}  // namespace bernal

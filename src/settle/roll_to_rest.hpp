#pragma once
#include "work/bed.hpp"
#include "work/reporter.hpp"

namespace bernal {

struct RollToRest {
  double still = 1e-7;   ///< spheres that move less than this, in radii, are at rest and wake no neighbour
  double friction = 0;   ///< an angle in degrees: spheres rest where the steepest way down is flatter
  std::size_t held = 0;  ///< the first `held` spheres of the sequence do not move
  int most_iterations = 10'000;
};

/// Every sphere of the bed falls and rolls along the direction until all rest (see `Roller`): sweeps from the
/// bottom up, over the spheres that are awake because they or something next to them moved. Neighbour lists
/// are rebuilt, with half a mean radius of space around each sphere, until nothing moves. Spheres only sink,
/// so this terminates.
///
/// Cost: about 5 µs for a sphere that falls, 0.3 µs for one at rest; about five iterations for a bed as dense
/// as settled ones.
StageEnd roll_to_rest(Bed& bed, Reporter& report, const Vector<3>& direction, const RollToRest& options = {});

}  // namespace bernal

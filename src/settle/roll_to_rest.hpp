#pragma once
#include "work/bed.hpp"
#include "work/reporter.hpp"

namespace bernal {

/// The largest angle of friction of beds that are asked to be loose, in degrees: a coefficient of 1.
inline constexpr double most_friction = 45;

struct RollToRest {
  double still = 1e-7;   ///< what moves less far, in radii, counts as at rest and wakes no neighbour
  double friction = 0;   ///< an angle in degrees: spheres rest where the steepest way down is flatter
  std::size_t held = 0;  ///< the first so many of the sequence stay where they are
  int most_iterations = 10'000;
};

/// Every sphere of the bed falls and rolls along the direction until all rest (see `Roller`): sweeps from the
/// bottom up, over those that are awake, which moved when last visited or next to which something moved.
/// Neighbour lists are built anew, with half a mean radius of room around each sphere, until nothing moves.
/// Spheres sink and never rise, so that this comes to an end.
///
/// Cost: about 5 µs for a sphere that falls, 0.3 µs for one at rest; some five iterations for a bed that is
/// as dense as settled ones.
StageEnd roll_to_rest(Bed& bed, Reporter& report, const Vector<3>& direction, const RollToRest& options = {});

}  // namespace bernal

#pragma once
#include "verify/ball.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// Decides d >= (1 - allowed)(ri + rj) for every pair of balls whose boxes touch. Nothing is stored but the
/// tally. Precondition: 0 <= allowed < 1. Cost: O(N log N + near pairs).
Tally judge_pairs(const BallTree& balls, double allowed, Arithmetic arithmetic);

}  // namespace bernal::verify

#pragma once
#include "verify/ball.hpp"
#include "verify/course.hpp"
#include "verify/space.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// Decides d >= (1 - allowed)(ri + rj) for every pair of balls whose boxes touch, d being the distance of the
/// nearest images where the space repeats itself; and there period >= (1 - allowed) 2 r for the shortest
/// period and every ball with 2 r >= period, which touches itself. Nothing is stored but the tally.
/// Cost: O(N log N + near pairs) in few dimensions.
template <int D>
Tally judge_pairs(const BallTree<D>& balls, const PeriodicSpace<D>& space, const Course& course);
Tally judge_pairs(const BallTree<3>& balls, const OpenSpace<3>& space, const Course& course);

}  // namespace bernal::verify

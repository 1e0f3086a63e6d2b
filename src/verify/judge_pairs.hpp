#pragma once
#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// Decides d >= (1 - allowed)(ri + rj) for every pair of balls whose boxes touch. Nothing is stored but the
/// tally. Precondition: 0 <= allowed < 1. Cost: O(N log N + near pairs).
Tally judge_pairs(const BallTree<3>& balls, double allowed, Arithmetic arithmetic);

/// Decides d >= (1 - allowed)(ri + rj) for every pair of balls whose boxes touch when all of space is filled
/// with copies of the periodic box, d being the distance of the nearest images; and edge >= (1 - allowed) 2 r
/// for the shortest edge and every ball with 2 r >= edge, which touches itself. Along an axis with walls
/// there are no copies; there it decides r <= c <= edge - r for every ball. Centres may lie anywhere and are
/// taken modulo the box on the other axes. Precondition: 0 <= allowed < 1; finite centres, positive finite
/// radii, as many coordinates as edges. Throws Error{bad_argument} unless every edge is positive and finite.
/// Cost: O(N log N
/// + near pairs) in few dimensions; 40 to 80 bytes a ball and up to 250 in eight dimensions.
Tally judge_pairs(const Spheres<dynamic>& spheres, const PeriodicBox& box, double allowed,
                  Arithmetic arithmetic);

}  // namespace bernal::verify

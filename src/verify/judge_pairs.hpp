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
/// with copies of the domain along the axes that repeat themselves, d being the distance of the nearest
/// images; and period >= (1 - allowed) 2 r for the shortest period and every ball with 2 r >= period, which
/// touches itself. Centres may lie anywhere and are taken modulo the periods. Precondition: 0 <= allowed < 1;
/// finite centres, positive finite radii, as many coordinates as the domain has. Throws Error{bad_argument}
/// unless every period is positive and finite.
/// Cost: O(N log N + near pairs) in few dimensions; 40 to 80 bytes a ball and up to 250 in eight dimensions.
Tally judge_pairs(const Spheres<dynamic>& spheres, const Domain& domain, double allowed,
                  Arithmetic arithmetic);

}  // namespace bernal::verify

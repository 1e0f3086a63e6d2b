#pragma once
#include "bernal/domain/domain.hpp"
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

/// Decides for every ball whether it lies in the closed domain; along axes that repeat themselves it may lie
/// anywhere.
///
/// A box has two pieces of wall for every axis that ends, a cylinder three (base, top, side) or, repeating
/// itself, its side, and a sphere one: every ball is tried against each. Of a mesh the triangles whose boxes
/// touch the ball's are tried, and the side of its centre is decided, and of a polygon the edges
/// likewise. Throws Error{bad_mesh} for a mesh that
/// encloses nothing and Error{bad_argument} for absurd measures. Cost: O(N), for a mesh of T triangles
/// O(T log T + N log T + near pieces). Precondition: D is the dimension of the domain.
template <int D>
Tally judge_walls(const BallTree<D>& balls, const Domain& domain, const Course& course);

}  // namespace bernal::verify

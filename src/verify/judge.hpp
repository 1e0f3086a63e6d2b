#pragma once
#include <functional>
#include <span>

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

/// The same for every pair of a ball of the tree and one of `others`, which the tree does not hold.
template <int D>
Tally judge_pairs_with(std::span<const Ball<D>> others, const BallTree<D>& balls,
                       const PeriodicSpace<D>& space, const Course& course);
Tally judge_pairs_with(std::span<const Ball<3>> others, const BallTree<3>& balls, const OpenSpace<3>& space,
                       const Course& course);

/// Walls that have been made ready: how a ball stands to them, and what was decided for that.
template <int D>
using Walls = std::function<Stand(const Ball<D>& ball, const CertifyOptions& options, Tally& tally)>;

/// Decides for every ball whether it lies in the closed domain; along axes that repeat themselves it may lie
/// anywhere.
///
/// A box has two pieces of wall for every axis that ends, a cylinder three (base, top, side) or, repeating
/// itself, its side, and a sphere one: every ball is tried against each. Of a mesh the triangles whose boxes
/// touch the ball's are tried, and the side of its centre is decided, and of a polygon the edges
/// likewise. Throws Error{bad_mesh} for a mesh that
/// encloses nothing and Error{bad_argument} for absurd measures. Cost: O(N), for a mesh of T triangles
/// O(T log T + N log T + near pieces). Preconditions: D is the dimension of the domain, which outlives the
/// walls.
template <int D>
Walls<D> walls_of(const Domain& domain);
template <int D>
Tally judge_walls(std::span<const Ball<D>> balls, const Walls<D>& walls, const Course& course);

}  // namespace bernal::verify

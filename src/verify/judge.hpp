#pragma once
#include <algorithm>
#include <functional>
#include <span>

#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/job.hpp"
#include "verify/space.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// Decides d >= (1 - allowed)(ri + rj) for every pair of balls with touching boxes, with d the distance of
/// the nearest images in a periodic space; and period >= (1 - allowed) 2 r for the shortest period and every
/// ball with 2 r >= period, which touches itself. In the same search it finds the smallest gap ratio of all
/// pairs, those that are not near included. Only the tally is stored. Cost: O(N log N + near pairs) in few
/// dimensions.
template <int D>
Tally judge_pairs(const BallTree<D>& balls, const PeriodicSpace<D>& space, const Job& job);
Tally judge_pairs(const BallTree<3>& balls, const OpenSpace<3>& space, const Job& job);

/// The same for pairs of a ball of the tree and one of `others`, which the tree does not contain.
template <int D>
Tally judge_pairs_with(std::span<const Ball<D>> others, const BallTree<D>& balls,
                       const PeriodicSpace<D>& space, const Job& job);
Tally judge_pairs_with(std::span<const Ball<3>> others, const BallTree<3>& balls, const OpenSpace<3>& space,
                       const Job& job);

/// Whether balls in two boxes, some of whose axes may be unbounded, can be near, or nearer than the nearest
/// pair so far.
template <int D, class Space>
bool may_hold_near(const Box<D>& a, const Box<D>& b, const Space& space, const Job& job) {
  const Widening widening =
      job.to_nearest_so_far(std::max({space.largest_period(), largest_coordinate(a), largest_coordinate(b)}));
  const double reach = std::max(distances_known_up_to(job.options().gap), widening.of(a));
  return touch(widening.widened(b), space.reach_of(widened(a, reach)));
}

/// Preprocessed walls: returns the position of a ball relative to them, and counts the decisions. A gap that
/// is more than `least` and not negative may be any number above `least` instead, or infinite.
template <int D>
using Walls =
    std::function<WallState(const Ball<D>& ball, const CertifyOptions& options, double least, Tally& tally)>;

/// Decides for every ball whether it lies in the closed domain; along periodic axes it may lie anywhere. In
/// the same search it finds the smallest gap of all balls.
///
/// A box has two pieces of wall for every non-periodic axis, a cylinder three (base, top, side; only the side
/// if periodic), a sphere one: every ball is tested against each. For a mesh the triangles (for a polygon or
/// a profile the edges) with boxes that touch the ball's are tested, and the side of its centre is decided;
/// others are only measured, where they may be nearer than what is near any ball so far.
/// Throws Error{bad_mesh} for a mesh that is not closed and Error{bad_argument} for invalid sizes. Cost:
/// O(N), for a mesh of T triangles O(T log T + N log T + near pieces). Preconditions: D is the dimension of
/// the domain, which must outlive the walls.
template <int D>
Walls<D> walls_of(const Domain& domain);
template <int D>
Tally judge_walls(std::span<const Ball<D>> balls, const Walls<D>& walls, const Job& job);

}  // namespace bernal::verify

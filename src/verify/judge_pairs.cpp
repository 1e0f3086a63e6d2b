#include "verify/judge.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <type_traits>

#include "core/every_dimension.hpp"
#include "verify/predicates.hpp"
#include "verify/record_pair.hpp"

namespace bernal::verify {
namespace {

/// Tests the pairs of balls of a tree in an OpenSpace or a PeriodicSpace: decides those whose boxes touch,
/// and looks for the smallest gap among those whose boxes would, if they were wider by the smallest so far.
template <int D, class Space>
class PairJudge {
 public:
  PairJudge(const BallTree<D>& balls, const Space& space, const Job& job)
      : balls_(balls),
        space_(space),
        job_(job),
        gap_(job.options().gap),
        known_(distances_known_up_to(gap_)),
        largest_(std::max(space.largest_period(), largest_coordinate(balls.box()))) {}

  Tally judge_all() const {
    guess();
    return job_.for_each("pairs", balls_.leaves(), 16,
                         [this](std::size_t l, Tally& tally) { judge_leaf(l, tally); });
  }

  Tally judge_with(std::span<const Ball<D>> others) {
    for (const Ball<D>& other : others) largest_ = std::max(largest_, largest_coordinate(other.box()));
    return job_.for_each("pairs", others.size(), 256, [&](std::size_t k, Tally& tally) {
      const Ball<D>& other = others[k];
      const Widening widening = job_.to_nearest_so_far(largest_);
      const Box<D> box = other.box();
      const auto near = near_reach_of(box);
      const WidenedQuery query{reach_of(box, at_least_known(widening.of(box))), widening};
      balls_.for_each_touching(query, [&](const Ball<D>& ball) { look_at(ball, other, near, tally); });
      job_.least_pair_gap().offer(-tally.worst_pair.ratio);
    });
  }

 private:
  /// So that the first leaves are not compared with all others: the smallest gap in some leaves, that of the
  /// largest ball among them, which would reach the farthest.
  void guess() const {
    constexpr std::size_t most = 256;
    const std::size_t step = balls_.leaves() / most + 1;
    for (std::size_t l = 0; l < balls_.leaves(); l += step) guess_in(balls_.leaf(l));
    const auto balls = balls_.items();
    const auto largest =
        static_cast<std::size_t>(std::ranges::max_element(balls, {}, &Ball<D>::r) - balls.begin());
    constexpr std::size_t around = 8;
    const std::size_t first = largest - std::min(largest, around);
    guess_in(balls.subspan(first, std::min(2 * around, balls.size() - first)));
  }
  void guess_in(std::span<const Ball<D>> balls) const {
    for (std::size_t i = 0; i < balls.size(); ++i)
      for (std::size_t j = i + 1; j < balls.size(); ++j)
        job_.least_pair_gap().offer(with_sign(ratio(balls[i], balls[j]), true));
  }

  /// Tests every pair within a leaf, and between it and later leaves.
  void judge_leaf(std::size_t l, Tally& tally) const {
    const Widening widening = job_.to_nearest_so_far(largest_);
    const auto mine = balls_.leaf(l);
    const Box<D>& box = balls_.box_of_leaf(l);
    const double own = widening.of(box);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      if constexpr (Space::repeats) judge_own_images(mine[i], at_least_known(2 * own), tally);
      judge_near(mine[i], mine.subspan(i + 1), at_least_known(2 * own), tally);
    }
    const auto judge_other = [&](std::size_t m) {
      const Box<D>& other = balls_.box_of_leaf(m);
      const double distance = at_least_known(own + widening.of(other));
      const auto reach = reach_of(other, distance);
      for (const Ball<D>& ball : mine)
        if (touch(ball.box(), reach)) judge_near(ball, balls_.leaf(m), distance, tally);
    };
    // Where even the largest ball grows little, all boxes of the tree may be taken to be wider by as much.
    const double most = widening.of_largest();
    if (most <= 0.1 * least_extent(box))
      balls_.for_each_leaf_touching_after(l, reach_of(box, at_least_known(own + most)), judge_other);
    else
      balls_.for_each_leaf_touching_after(l, WidenedQuery{reach_of(box, at_least_known(own)), widening},
                                          judge_other);
    job_.least_pair_gap().offer(-tally.worst_pair.ratio);
  }

  /// Decides near pairs; of others the smallest gap counts. `distance`: how far apart boxes are at most whose
  /// balls are near, or nearer than the nearest so far.
  void judge_near(const Ball<D>& ball, std::span<const Ball<D>> others, double distance, Tally& tally) const {
    const Box<D> box = ball.box();
    const auto reach = reach_of(box, distance);
    std::optional<std::decay_t<decltype(reach)>> near;
    for (const Ball<D>& other : others) {
      if (!touch(other.box(), reach)) continue;
      if (!near) near = near_reach_of(box);
      look_at(other, ball, *near, tally);
    }
  }

  /// `near`: the reach of b.
  template <class Reach>
  void look_at(const Ball<D>& a, const Ball<D>& b, const Reach& near, Tally& tally) const {
    if (touch(a.box(), near))
      a.index < b.index ? judge(a, b, tally) : judge(b, a, tally);
    else
      tally.add_distant_pair(a.index, b.index, ratio(a, b));
  }

  /// Above rounding.
  double at_least_known(double distance) const {
    return std::max(known_ * (1 + 0x1p-40) + 0x1p-46 * largest_, distance);
  }
  /// The region whose contents count as near.
  auto near_reach_of(const Box<D>& box) const { return space_.reach_of(widened(box, known_)); }
  /// The region of what may be near, or nearer than the nearest so far; `distance` is above all rounding.
  auto reach_of(const Box<D>& box, double distance) const {
    return space_.reach_of(widened_by_about(box, distance));
  }

  void judge(const Ball<D>& a, const Ball<D>& b, Tally& tally) const {
    record_pair(job_, a.index, b.index, distance(a, b), a.r + b.r, tally, [&]<class Number>(double allowed) {
      return balls_clear<Number>(space_, a, b, allowed, gap_);
    });
  }

  /// Tests a ball against its nearest images, an edge away. `distance`: as above.
  void judge_own_images(const Ball<D>& ball, double distance, Tally& tally) const {
    const double edge = space_.edges.minCoeff(), diameter = 2 * ball.r;
    if (diameter + distance < edge || edge == Box<D>::infinity) return;
    if (diameter + known_ < edge)
      tally.add_distant_pair(ball.index, ball.index, gap_ratio(edge, diameter, gap_));
    else
      record_pair(job_, ball.index, ball.index, edge, diameter, tally, [&]<class Number>(double allowed) {
        return own_images_clear<Number>(ball.r, edge, allowed, gap_);
      });
  }

  double ratio(const Ball<D>& a, const Ball<D>& b) const {
    return gap_ratio(distance(a, b), a.r + b.r, gap_);
  }

  double distance(const Ball<D>& a, const Ball<D>& b) const {
    Vector<D> d;
    for (int k = 0; k < D; ++k) d[k] = space_.template offset<double>(k, a.c[k], b.c[k]);
    const double squared = d.squaredNorm();
    return squared > 0x1p-900 && squared < 0x1p900 ? std::sqrt(squared) : d.stableNorm();
  }

  const BallTree<D>& balls_;
  const Space& space_;
  const Job& job_;
  const double gap_, known_;  ///< distances up to `known_` count as near
  double largest_;            ///< of all coordinates and periods
};

}  // namespace

Tally judge_pairs(const BallTree<3>& balls, const OpenSpace<3>& space, const Job& job) {
  return PairJudge(balls, space, job).judge_all();
}

template <int D>
Tally judge_pairs(const BallTree<D>& balls, const PeriodicSpace<D>& space, const Job& job) {
  return PairJudge(balls, space, job).judge_all();
}

Tally judge_pairs_with(std::span<const Ball<3>> others, const BallTree<3>& balls, const OpenSpace<3>& space,
                       const Job& job) {
  return PairJudge(balls, space, job).judge_with(others);
}

template <int D>
Tally judge_pairs_with(std::span<const Ball<D>> others, const BallTree<D>& balls,
                       const PeriodicSpace<D>& space, const Job& job) {
  return PairJudge(balls, space, job).judge_with(others);
}
#define BERNAL_INSTANTIATE(D)                                                                            \
  template Tally judge_pairs(const BallTree<D>&, const PeriodicSpace<D>&, const Job&);                   \
  template Tally judge_pairs_with(std::span<const Ball<D>>, const BallTree<D>&, const PeriodicSpace<D>&, \
                                  const Job&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal::verify

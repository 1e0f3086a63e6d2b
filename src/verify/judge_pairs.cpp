#include "verify/judge.hpp"

#include <cmath>
#include <span>

#include "core/every_dimension.hpp"
#include "verify/predicates.hpp"
#include "verify/record_pair.hpp"

namespace bernal::verify {
namespace {

/// Tests the pairs of balls of a tree in an OpenSpace or a PeriodicSpace.
template <int D, class Space>
class PairJudge {
 public:
  PairJudge(const BallTree<D>& balls, const Space& space, const Job& job)
      : balls_(balls), space_(space), job_(job), gap_(job.options().gap) {}

  Tally judge_all() const {
    return job_.for_each("pairs", balls_.leaves(), 16,
                         [this](std::size_t l, Tally& tally) { judge_leaf(l, tally); });
  }

  Tally judge_with(std::span<const Ball<D>> others) const {
    return job_.for_each("pairs", others.size(), 256, [&](std::size_t k, Tally& tally) {
      const Ball<D>& other = others[k];
      balls_.for_each_touching(reach_of(other.box()), [&](const Ball<D>& ball) {
        ball.index < other.index ? judge(ball, other, tally) : judge(other, ball, tally);
      });
    });
  }

 private:
  /// Tests every near pair within a leaf, and between it and later leaves.
  void judge_leaf(std::size_t l, Tally& tally) const {
    const auto mine = balls_.leaf(l);
    for (std::size_t i = 0; i < mine.size(); ++i) {
      if constexpr (Space::repeats) judge_own_images(mine[i], tally);
      judge_near(mine[i], mine.subspan(i + 1), tally);
    }
    balls_.for_each_leaf_touching_after(l, reach_of(balls_.box_of_leaf(l)), [&](std::size_t m) {
      const auto reach = reach_of(balls_.box_of_leaf(m));
      for (const Ball<D>& ball : mine)
        if (touch(ball.box(), reach)) judge_near(ball, balls_.leaf(m), tally);
    });
  }

  void judge_near(const Ball<D>& ball, std::span<const Ball<D>> others, Tally& tally) const {
    const auto reach = reach_of(ball.box());
    for (const Ball<D>& other : others)
      if (touch(other.box(), reach))
        ball.index < other.index ? judge(ball, other, tally) : judge(other, ball, tally);
  }

  /// The region whose contents count as near.
  auto reach_of(const Box<D>& box) const {
    return space_.reach_of(widened(box, distances_known_up_to(gap_)));
  }

  void judge(const Ball<D>& a, const Ball<D>& b, Tally& tally) const {
    record_pair(job_, a.index, b.index, distance(a, b), a.r + b.r, tally, [&]<class Number>(double allowed) {
      return balls_clear<Number>(space_, a, b, allowed, gap_);
    });
  }

  /// Tests a ball against its nearest images, an edge away.
  void judge_own_images(const Ball<D>& ball, Tally& tally) const {
    const double edge = space_.edges.minCoeff(), diameter = 2 * ball.r;
    if (diameter + distances_known_up_to(gap_) < edge) return;
    record_pair(job_, ball.index, ball.index, edge, diameter, tally, [&]<class Number>(double allowed) {
      return own_images_clear<Number>(ball.r, edge, allowed, gap_);
    });
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
  const double gap_;
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

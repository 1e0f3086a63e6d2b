#include "verify/judge_pairs.hpp"

#include <cmath>
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "verify/predicates.hpp"

namespace bernal::verify {
namespace {

/// (d - s) / s for s = ri + rj.
double gap_ratio(const Ball& a, const Ball& b) {
  const Vector<3> difference = a.c - b.c;
  const double reach = a.r + b.r;
  const double squared = difference.squaredNorm();
  const bool safe = squared > 0x1p-900 && squared < 0x1p900;
  const double d = safe ? std::sqrt(squared) : std::hypot(difference[0], difference[1], difference[2]);
  return (d - reach) / reach;
}

class PairJudge {
 public:
  PairJudge(const BallTree& balls, double allowed, Arithmetic arithmetic)
      : balls_(balls), allowed_(allowed), arithmetic_(arithmetic) {}

  /// Every near pair within a leaf, and of it with a later leaf.
  void judge_leaf(std::size_t l, Tally& tally) const {
    const auto mine = balls_.leaf(l);
    for (std::size_t i = 0; i < mine.size(); ++i) judge_near(mine[i], mine.subspan(i + 1), tally);
    balls_.for_each_later_leaf_touching(l, [&](std::size_t m) {
      const Box& theirs = balls_.box_of_leaf(m);
      for (const Ball& ball : mine)
        if (touch(ball.box(), theirs)) judge_near(ball, balls_.leaf(m), tally);
    });
  }

 private:
  void judge_near(const Ball& ball, std::span<const Ball> others, Tally& tally) const {
    const Box box = ball.box();
    for (const Ball& other : others)
      if (touch(box, other.box()))
        ball.index < other.index ? judge(ball, other, tally) : judge(other, ball, tally);
  }

  void judge(const Ball& a, const Ball& b, Tally& tally) const {
    ++tally.pairs;
    const bool clear = apart(a, b, allowed_, tally);
    if (!clear) ++tally.overlapping;
    Tally only_for_the_sign;
    const bool strictly = allowed_ == 0 ? clear : apart(a, b, 0, only_for_the_sign);
    tally.add_pair_ratio(a.index, b.index, 0.0 - with_sign(gap_ratio(a, b), strictly));
  }

  bool apart(const Ball& a, const Ball& b, double allowed, Tally& tally) const {
    return decide(arithmetic_, tally, [&]<class Number>() {
             return spheres_clear<Number>(a.c, a.r, b.c, b.r, allowed);
           }) == Truth::yes;
  }

  const BallTree& balls_;
  double allowed_;
  Arithmetic arithmetic_;
};

}  // namespace

Tally judge_pairs(const BallTree& balls, double allowed, Arithmetic arithmetic) {
  const PairJudge judge(balls, allowed, arithmetic);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, balls.leaves(), 16), Tally{},
      [&](const tbb::blocked_range<std::size_t>& range, Tally tally) {
        for (std::size_t l = range.begin(); l < range.end(); ++l) judge.judge_leaf(l, tally);
        return tally;
      },
      [](Tally a, const Tally& b) { return a += b; });
}

}  // namespace bernal::verify

#include "verify/tilted.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "verify/box_tree.hpp"
#include "verify/predicates.hpp"
#include "verify/record_pair.hpp"
#include "verify/space.hpp"

namespace bernal::verify {
namespace {

/// Whole numbers of cell vectors.
template <int D>
using Turns = std::array<double, D>;

/// The cell vectors, by the plain data of the domain: component k of the vector of `axis`, 0 for k > axis.
template <int D>
struct CellVectors {
  std::array<std::array<double, D>, D> of{};

  explicit CellVectors(const bernal::Box& box) {
    for (int axis = 0; axis < D; ++axis) of[axis][axis] = box.size[axis];
    of[1][0] = box.tilt[0];
    if constexpr (D == 3) {
      of[2][0] = box.tilt[1];
      of[2][1] = box.tilt[2];
    }
  }
  double edge(int axis) const { return of[axis][axis]; }
  double sum_of_lengths() const {
    double sum = 0;
    for (const auto& vector : of)
      for (const double x : vector) sum += std::abs(x);
    return sum;
  }
  Vector<D> moved(Vector<D> p, const Turns<D>& turns) const {
    for (int axis = 0; axis < D; ++axis)
      for (int k = 0; k <= axis; ++k) p[k] += turns[axis] * of[axis][k];
    return p;
  }
};

/// A ball as it is given, and the image of it near the origin by which it is found.
template <int D>
struct TiltedBall {
  Vector<D> c;
  double r;
  std::uint64_t index;
  Vector<D> near;  ///< c moved by `turns`, to rounding
  Turns<D> turns;
  double half;  ///< of the box around `near`

  Box<D> box() const { return box_of_ball<D>(near, half); }
  double center(int axis) const { return near[axis]; }
};

/// |ci - cj + n·H| >= (1 - allowed)(ri + rj + gap)
template <class Number, int D>
Truth images_clear(const TiltedBall<D>& a, const TiltedBall<D>& b, const Turns<D>& turns,
                   const CellVectors<D>& cell, double allowed, double gap) {
  Number squared(0);
  for (int k = 0; k < D; ++k) {
    Number offset = Number(a.c[k]) - Number(b.c[k]);
    for (int axis = k; axis < D; ++axis)
      if (turns[axis] != 0 && cell.of[axis][k] != 0)
        offset = offset + Number(turns[axis]) * Number(cell.of[axis][k]);
    squared = squared + square(offset);
  }
  return at_least(squared, square(least_distance<Number>(a.r, b.r, allowed, gap)));
}

/// Of opposite ones exactly one.
template <int D>
bool is_positive(const Turns<D>& turns) {
  for (int axis = D - 1; axis >= 0; --axis)
    if (turns[axis] != 0) return turns[axis] > 0;
  return false;
}

template <int D>
class TiltedJudge {
 public:
  TiltedJudge(const Spheres<dynamic>& spheres, const bernal::Box& box, const Job& job)
      : cell_(box),
        job_(job),
        farthest_(cell_.sum_of_lengths()),
        known_(std::min(distances_known_up_to(job.options().gap), farthest_)),
        balls_(balls_of(spheres)) {
    for (std::size_t l = 0; l < balls_.leaves(); ++l)
      if (!balls_.leaf(l).empty()) all_.include(balls_.box_of_leaf(l));
  }

  Tally judge_all() const {
    guess();
    return job_.for_each("pairs", balls_.items().size(), 64, [this](std::size_t k, Tally& tally) {
      judge_ball(balls_.items()[k], tally);
      job_.least_pair_gap().offer(-tally.worst_pair.ratio);
    });
  }

 private:
  /// Relative to what is summed: far above the rounding of the sums of a few products.
  static constexpr double rounding = 0x1p-46;

  std::vector<TiltedBall<D>> balls_of(const Spheres<dynamic>& spheres) const {
    constexpr double most_turns = 0x1p20;
    std::vector<TiltedBall<D>> balls(spheres.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
      TiltedBall<D>& ball = balls[i];
      ball.r = spheres.r[i];
      ball.index = i;
      double summed = farthest_;
      for (int k = 0; k < D; ++k) {
        ball.c[k] = spheres.x[static_cast<std::size_t>(k)][i];
        summed += std::abs(ball.c[k]);
      }
      Vector<D> rest = ball.c;
      for (int axis = D - 1; axis >= 0; --axis) {
        ball.turns[axis] = -std::floor(rest[axis] / cell_.edge(axis));
        if (!(std::abs(ball.turns[axis]) <= most_turns))
          throw Error(ErrorCode::bad_argument,
                      fmt::format("sphere {} lies more than a million periods away from its tilted box; "
                                  "replace it by an image in the box",
                                  i));
        for (int k = 0; k <= axis; ++k) {
          rest[k] += ball.turns[axis] * cell_.of[axis][k];
          summed += std::abs(ball.turns[axis] * cell_.of[axis][k]);
        }
      }
      ball.near = rest;
      ball.half = std::min(ball.r, farthest_) + rounding * summed;
    }
    return balls;
  }

  /// So that the first balls are not compared with all images of all others: the gaps in some leaves, and
  /// those of balls and their images along the first axis.
  void guess() const {
    constexpr std::size_t most = 256;
    const std::size_t step = balls_.leaves() / most + 1;
    for (std::size_t l = 0; l < balls_.leaves(); l += step) {
      const auto balls = balls_.leaf(l);
      for (std::size_t i = 0; i < balls.size(); ++i) {
        Turns<D> turns{};
        for (std::size_t j = i + 1; j < balls.size(); ++j) offer(balls[i], balls[j], turns);
        turns[0] = 1;
        offer(balls[i], balls[i], turns);
      }
    }
  }
  void offer(const TiltedBall<D>& a, const TiltedBall<D>& b, const Turns<D>& turns) const {
    const double ratio = gap_ratio(distance(a, b, turns), a.r + b.r, job_.options().gap);
    job_.least_pair_gap().offer(with_sign(ratio, true));
  }

  void judge_ball(const TiltedBall<D>& ball, Tally& tally) const {
    const Widening widening = job_.to_nearest_so_far(largest_coordinate(all_));
    const double nearer = std::min(std::max(known_, widening.of(ball.box())), farthest_);
    Turns<D> turns{};
    judge_images<D - 1>(ball, {widened(ball.box(), known_), widened(ball.box(), nearer), widening}, turns,
                        tally);
  }

  /// Where the balls are whose pairs with an image of a ball are decided, and where those are that may be
  /// nearer to it than the nearest pair so far.
  struct Reaches {
    Box<D> near;
    Box<D> nearer;
    Widening widening;  ///< of the balls in `nearer`
  };

  /// All images of the ball, moved by `turns` along the axes above K, that may touch the box of all.
  template <int K>
  void judge_images(const TiltedBall<D>& ball, const Reaches& reaches, Turns<D>& turns, Tally& tally) const {
    if constexpr (K < 0) {
      balls_.for_each_touching(WidenedQuery{reaches.nearer, reaches.widening},
                               [&](const TiltedBall<D>& other) {
                                 judge(ball, other, turns, touch(other.box(), reaches.near), tally);
                               });
    } else {
      const double edge = cell_.edge(K);
      const Box<D> all = widened(all_, std::min(reaches.widening.of(all_), farthest_));
      const double first = std::ceil((all.lower[K] - reaches.nearer.upper[K]) / edge -
                                     rounding * farthest_ / edge),
                   last = std::floor((all.upper[K] - reaches.nearer.lower[K]) / edge +
                                     rounding * farthest_ / edge);
      for (double turn = first; turn <= last; ++turn) {
        turns[K] = turn;
        judge_images<K - 1>(ball,
                            {moved<K>(reaches.near, turn), moved<K>(reaches.nearer, turn), reaches.widening},
                            turns, tally);
      }
      turns[K] = 0;
    }
  }

  /// The box moved by so many cell vectors of axis K, and wider by what that is rounded.
  template <int K>
  Box<D> moved(Box<D> box, double turn) const {
    for (int k = 0; k <= K; ++k) {
      const double way = turn * cell_.of[K][k];
      const double slack = turn == 0 ? 0 : rounding * (std::abs(way) + farthest_);
      box.lower[k] = rounded_down(box.lower[k] + way) - slack;
      box.upper[k] = rounded_up(box.upper[k] + way) + slack;
    }
    return box;
  }

  /// The image of `a` moved by `turns`, and b. Each pair is met from both of its balls.
  void judge(const TiltedBall<D>& a, const TiltedBall<D>& b, const Turns<D>& turns, bool near,
             Tally& tally) const {
    if (a.index > b.index || (a.index == b.index && !is_positive<D>(turns))) return;
    const double apart = distance(a, b, turns);
    if (!near) {
      tally.add_distant_pair(a.index, b.index, gap_ratio(apart, a.r + b.r, job_.options().gap));
      return;
    }
    Turns<D> of_given;
    for (int axis = 0; axis < D; ++axis) of_given[axis] = turns[axis] + a.turns[axis] - b.turns[axis];
    record_pair(job_, a.index, b.index, apart, a.r + b.r, tally, [&]<class Number>(double allowed) {
      return images_clear<Number, D>(a, b, of_given, cell_, allowed, job_.options().gap);
    });
  }

  double distance(const TiltedBall<D>& a, const TiltedBall<D>& b, const Turns<D>& turns) const {
    const Vector<D> way = cell_.moved(a.near, turns) - b.near;
    return way.stableNorm();
  }

  const CellVectors<D> cell_;
  const Job& job_;
  const double farthest_, known_;
  const BoxTree<TiltedBall<D>, D> balls_;
  Box<D> all_;
};

}  // namespace

Tally judge_tilted(const Spheres<dynamic>& spheres, const bernal::Box& box, const Job& job) {
  constexpr double most_slender = 1000;
  const int dimension = box.dimension();
  require(dimension == 2 || dimension == 3, "a tilted box has two or three dimensions");
  require(!box.has_walls(), "a tilted box repeats itself along every axis");
  const double shortest = box.size.minCoeff();
  for (int k = 0; k < dimension; ++k)
    require(box.size[k] > 0 && box.size[k] <= most_slender * shortest,
            "the longest edge of a tilted box is at most 1000 of the shortest");
  for (const double length : box.tilt)
    require(std::abs(length) <= most_slender * shortest,
            "the tilt of a box is at most 1000 of its shortest edge");
  require(dimension == 3 || (box.tilt[1] == 0 && box.tilt[2] == 0),
          "in two dimensions the tilt of a box is one length, xy");
  return dimension == 2 ? TiltedJudge<2>(spheres, box, job).judge_all()
                        : TiltedJudge<3>(spheres, box, job).judge_all();
}

}  // namespace bernal::verify

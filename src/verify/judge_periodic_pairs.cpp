#include "verify/judge_pairs.hpp"

#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "verify/pair_judge.hpp"

namespace bernal::verify {
namespace {

template <int D>
std::vector<Ball<D>> representatives(const Spheres<dynamic>& spheres, const PeriodicSpace<D>& space) {
  std::vector<Ball<D>> balls(spheres.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    for (int k = 0; k < D; ++k)
      balls[i].c[k] = space.representative(k, spheres.x[static_cast<std::size_t>(k)][i]);
    balls[i].r = spheres.r[i];
    balls[i].index = i;
  }
  return balls;
}

/// The two walls of every axis that has them, for every ball. Nothing is allowed to stick out.
Tally judge_walls_of(const Spheres<dynamic>& spheres, const PeriodicBox& box, Arithmetic arithmetic) {
  Tally tally;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    bool inside = true;
    const auto judge = [&](double clearance, double r, const auto& predicate) {
      ++tally.walls;
      const bool holds = decide(arithmetic, tally, predicate) == Truth::yes;
      inside = inside && holds;
      tally.add_wall_ratio(i, with_sign((clearance - r) / r, holds));
    };
    for (int k = 0; k < box.dimension(); ++k) {
      if (!box.has_wall(k)) continue;
      const double c = spheres.x[static_cast<std::size_t>(k)][i], r = spheres.r[i], edge = box.edges[k];
      judge(c, r, [=]<class Number>() { return above<Number>(c, r, 0); });
      judge(edge - c, r, [=]<class Number>() { return below<Number>(c, r, edge); });
    }
    if (!inside) ++tally.protruding;
  }
  return tally;
}

}  // namespace

Tally judge_pairs(const Spheres<dynamic>& spheres, const PeriodicBox& box, double allowed,
                  Arithmetic arithmetic) {
  if (!box.edges.allFinite() || !(box.edges.array() > 0).all())
    throw Error(ErrorCode::bad_argument, "a periodic box needs positive finite edges");
  if (!box.walls.empty() && box.walls.size() != static_cast<std::size_t>(box.dimension()))
    throw Error(ErrorCode::bad_argument, "a periodic box has walls or none on each of its axes");
  return with_dimension(box.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    PeriodicSpace<D> space{box.edges};
    for (int k = 0; k < D; ++k)
      if (box.has_wall(k)) space.edges[k] = Box<D>::infinity;
    const BallTree<D> balls(representatives<D>(spheres, space));
    Tally tally = PairJudge(balls, space, allowed, arithmetic).judge_all();
    return tally += judge_walls_of(spheres, box, arithmetic);
  });
}

}  // namespace bernal::verify

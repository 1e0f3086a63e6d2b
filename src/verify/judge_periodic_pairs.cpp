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

}  // namespace

Tally judge_pairs(const Spheres<dynamic>& spheres, const PeriodicBox& box, double allowed,
                  Arithmetic arithmetic) {
  if (!box.edges.allFinite() || !(box.edges.array() > 0).all())
    throw Error(ErrorCode::bad_argument, "a periodic box needs positive finite edges");
  return with_dimension(box.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    const PeriodicSpace<D> space{box.edges};
    const BallTree<D> balls(representatives<D>(spheres, space));
    return PairJudge(balls, space, allowed, arithmetic).judge_all();
  });
}

}  // namespace bernal::verify

#include "verify/judge_pairs.hpp"

#include <cmath>
#include <variant>
#include <vector>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "verify/pair_judge.hpp"

namespace bernal::verify {
namespace {

/// What repeats is said here once more, from the plain data: the packer's own metric is not trusted.
template <int D>
PeriodicSpace<D> space_of(const Domain& domain) {
  PeriodicSpace<D> space{Vector<D>::Constant(Box<D>::infinity)};
  const auto repeat = [&](int axis, double period) {
    if (!std::isfinite(period) || !(period > 0))
      throw Error(ErrorCode::bad_argument, "what repeats itself needs a positive finite period");
    space.edges[axis] = period;
  };
  if (const auto* box = std::get_if<bernal::Box>(&domain)) {
    if (!box->periodic.empty() && box->periodic.size() != static_cast<std::size_t>(D))
      throw Error(ErrorCode::bad_argument, "a box repeats itself or ends on each of its axes");
    for (int k = 0; k < D; ++k)
      if (box->repeats(k)) repeat(k, box->size[k]);
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&domain); cylinder && cylinder->periodic && D == 3) {
    const int axis = cylinder->coordinate_axis();
    if (axis < 0)
      throw Error(ErrorCode::bad_argument, "a cylinder that repeats itself needs an axis along x, y or z");
    repeat(axis, cylinder->height);
  }
  return space;
}

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

Tally judge_pairs(const Spheres<dynamic>& spheres, const Domain& domain, double allowed,
                  Arithmetic arithmetic) {
  return with_dimension(dimension_of(domain), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    const PeriodicSpace<D> space = space_of<D>(domain);
    const BallTree<D> balls(representatives<D>(spheres, space));
    return PairJudge(balls, space, allowed, arithmetic).judge_all();
  });
}

}  // namespace bernal::verify

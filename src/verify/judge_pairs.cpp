#include "verify/judge_pairs.hpp"

#include "core/every_dimension.hpp"
#include "verify/pair_judge.hpp"

namespace bernal::verify {

Tally judge_pairs(const BallTree<3>& balls, const OpenSpace<3>& space, const Course& course) {
  return PairJudge(balls, space, course).judge_all();
}

template <int D>
Tally judge_pairs(const BallTree<D>& balls, const PeriodicSpace<D>& space, const Course& course) {
  return PairJudge(balls, space, course).judge_all();
}
#define BERNAL_INSTANTIATE(D) \
  template Tally judge_pairs(const BallTree<D>&, const PeriodicSpace<D>&, const Course&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal::verify

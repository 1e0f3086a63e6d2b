#include "verify/judge_pairs.hpp"

#include "verify/pair_judge.hpp"

namespace bernal::verify {

Tally judge_pairs(const BallTree<3>& balls, double allowed, Arithmetic arithmetic) {
  return PairJudge(balls, OpenSpace<3>(), allowed, arithmetic).judge_all();
}

}  // namespace bernal::verify

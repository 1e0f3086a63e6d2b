#pragma once
#include <algorithm>
#include <cstdint>

#include "verify/job.hpp"
#include "verify/least_gap.hpp"
#include "verify/sign.hpp"

namespace bernal::verify {

/// Decides a near pair, and adds it to the tally: `clear` is asked, in any arithmetic, whether its centres
/// are at least (1 - allowed) times the sum of radii and the gap apart. `distance` and the sum of radii are
/// in double.
template <class Predicate>
void record_pair(const Job& job, std::uint64_t first, std::uint64_t second, double distance, double sum,
                 Tally& tally, const Predicate& clear) {
  const auto holds = [&](double allowed, Decisions& decisions) {
    return decide(job.options().arithmetic, decisions,
                  [&]<class Number>() { return clear.template operator()<Number>(allowed); }) == Truth::yes;
  };
  const double allowed = job.options().allowed_overlap, gap = job.options().gap;
  const bool as_allowed = holds(allowed, tally.decisions);
  Decisions only_for_the_sign;
  const bool strictly = allowed == 0 ? as_allowed : holds(0, only_for_the_sign);
  tally.add_pair({{first, second}, 0.0 - with_sign(gap_ratio(distance, sum, gap), strictly)}, as_allowed);
  if (gap > 0)
    tally.least_distance = std::min(tally.least_distance, on_side_of(gap, distance - sum, strictly));
}

}  // namespace bernal::verify

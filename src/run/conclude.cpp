#include "run/conclude.hpp"

#include <fmt/format.h>

#include "bernal/core/text.hpp"

namespace bernal {
namespace {

struct Conclusion {
  Outcome outcome;
  std::string reason;
};

Conclusion limit_reached(const std::string& n) {
  return {Outcome::hit_limit, fmt::format("the last stage reached its limit with {} spheres", n)};
}

/// In a box all spheres are wanted, and have places together.
Conclusion of_box(const Packing& packing, const Work& work, StageEnd end) {
  const std::string n = grouped(packing.spheres.size());
  const std::string account = work.account.empty() ? "" : " " + work.account;
  if (const std::size_t wanted = work.supply->wanted(); packing.spheres.size() < wanted)
    return {end == StageEnd::full ? Outcome::full : Outcome::hit_limit,
            fmt::format("{} of {} spheres are placed, packing fraction {:.4f}{}", n, grouped(wanted),
                        packing.packing_fraction(), account)};
  if (work.target_edges && work.edges != *work.target_edges)
    return {Outcome::full, fmt::format("{} spheres need a box {:.4g} times as large by volume as the one "
                                       "asked for; this is the box that they need",
                                       n, work.edges.prod() / work.target_edges->prod())};
  if (end == StageEnd::hit_limit) return limit_reached(n);
  return {Outcome::converged, fmt::format("all {} spheres are placed{}", n, account)};
}

/// In a bed they come one after the other, until the target is reached or no place is left.
Conclusion of_bed(const Packing& packing, const Work& work, StageEnd end, bool meets_expectation) {
  const Target& target = work.target;
  const std::string n = grouped(packing.spheres.size());
  if (!work.missed.empty())
    return {Outcome::hit_limit, fmt::format("{} spheres are placed; {}", n, work.missed)};
  if (!target.is_open() && work.supply->exhausted())
    return {Outcome::converged, fmt::format("all {} spheres are placed", n)};
  if (end == StageEnd::hit_limit) return limit_reached(n);
  if (target.is_open())
    return {Outcome::converged, end == StageEnd::converged && !target.fill && meets_expectation
                                    ? fmt::format("{} spheres are placed, as many as were expected to fit", n)
                                    : fmt::format("the stages of the scene place {} spheres and no more", n)};
  if (target.count)
    return {Outcome::full,
            fmt::format("{} of {} spheres are placed; the stages of the scene find no place for more", n,
                        grouped(static_cast<std::size_t>(*target.count)))};
  return {Outcome::full,
          fmt::format("packing fraction {:.4f} of {} is reached with {} spheres; the stages of "
                      "the scene find no place for more",
                      packing.packing_fraction(), *target.packing_fraction, n)};
}

std::string resized(double size_scale) {
  return size_scale == 1
             ? ""
             : fmt::format("; all sizes are {:.9g} times those drawn, so that they jam", size_scale);
}

/// What was left out of the drawn sequence.
std::string left_out(const Supply& supply) {
  std::string text;
  if (supply.cut_off() > 0)
    text += fmt::format(
        "; {} draws from the tail of the sizes were discarded because less than a hundredth of "
        "the container has room for such spheres",
        grouped(supply.cut_off()));
  if (const std::size_t passed = supply.passed_over(); passed > 0)
    text += fmt::format("; {} larger ones of the drawn sequence were passed over", grouped(passed));
  return text;
}

}  // namespace

void conclude(Packing& packing, const Work& work, StageEnd end, bool meets_expectation) {
  const bool in_bed = work.stands_in_bed();
  const bool cancelled = end == StageEnd::cancelled;
  Conclusion conclusion = in_bed ? of_bed(packing, work, end, meets_expectation) : of_box(packing, work, end);
  if (cancelled) {
    const bool short_of = !in_bed && packing.spheres.size() < work.supply->wanted();
    conclusion = {Outcome::cancelled, short_of ? "stopped by the user: " + conclusion.reason
                                               : fmt::format("stopped by the user with {} spheres",
                                                             grouped(packing.spheres.size()))};
  }
  packing.outcome = conclusion.outcome;
  packing.reason =
      conclusion.reason + (in_bed ? resized(work.size_scale) + left_out(*work.supply) : std::string());
}

}  // namespace bernal

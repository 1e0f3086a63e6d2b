#include "run/conclude.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/measure/rest.hpp"
#include "plan/caution.hpp"
#include "plan/estimate.hpp"
#include "plan/few_large.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/shortfall.hpp"

namespace bernal {
namespace {

struct Conclusion {
  Outcome outcome;
  std::string reason;
};

/// A result that reaches less than this share of what was expected is none that was asked for; so is an
/// expectation of less than this share of the random close packing of the same sizes.
constexpr double near_expectation = 0.7, least_expectation = 0.1;
/// So much less of the volume than expected relaxation was found to fill in a part, with all that it can.
constexpr double least_error = 0.03;

/// "1 sphere", "1,668 spheres".
std::string counted(std::size_t n) { return fmt::format("{} {}", grouped(n), n == 1 ? "sphere" : "spheres"); }
std::string_view are(std::size_t n) { return n == 1 ? "is" : "are"; }

std::string all_placed(std::size_t n) {
  return n == 1 ? "the sphere is placed" : fmt::format("all {} are placed", counted(n));
}
/// "25 of 30 spheres are placed"
std::string some_placed(std::size_t n, std::size_t wanted) {
  if (n == 0 && wanted == 1) return "the sphere is not placed";
  return fmt::format("{} of {} {} placed", grouped(n), counted(wanted), are(n));
}

Conclusion limit_reached(std::size_t n) {
  return {Outcome::hit_limit, fmt::format("the last stage reached its limit with {}", counted(n))};
}

/// Why no more are placed.
std::string_view why_no_more(StageEnd end) {
  return end == StageEnd::converged ? "the stages of the scene place no more"
                                    : "the stages of the scene find no place for more";
}

std::string larger(double factor) {
  if (factor < 1 + 1e-12) return "larger by a rounding than";
  return factor < 1.001 ? fmt::format("larger by a share of {:.2g} of its volume than", factor - 1)
                        : fmt::format("{:.4g} times as large by volume as", factor);
}

/// Where it is left open how many spheres there are: what the stages place is what was asked for, unless it
/// is far from what was to be expected. `fills`: they have tried to place one more.
Conclusion of_open_target(const Packing& packing, bool fills, StageEnd end, const Ending& ending) {
  const std::size_t n = packing.spheres.size();
  const Plan& plan = ending.plan;
  const double phi = packing.packing_fraction(), expected = packing.expected_packing_fraction;
  const auto fraction = [](double f) { return fmt::format("{:.3g}", f); };
  // Of few, one more or less is a large share.
  const double expected_count = phi > 0 ? static_cast<double>(n) * expected / phi : 1;
  const double near = near_expectation * (1 - 1 / std::sqrt(std::max(1.0, expected_count)));
  if (phi < near * expected || n == 0)
    return {Outcome::full,
            fmt::format("{} {} placed, packing fraction {}, where {} was expected; {}", counted(n), are(n),
                        fraction(phi), fraction(expected), why_no_more(end))};
  if (ending.attainable < least_expectation * ending.close_packing)
    return {Outcome::full,
            fmt::format("{} {} placed, packing fraction {}: the container has so little room for "
                        "these sizes that hardly more was to be expected, where random close packing is {}; "
                        "use smaller ones or check the units",
                        counted(n), are(n), fraction(phi), fraction(ending.close_packing))};
  std::string guess;  // where walls are everywhere
  if (const auto error = give_or_take(plan); error && !fills && !plan.scene.target.bed.gives_height())
    guess = fmt::format(", give or take {}: fill = true may place more", grouped(*error));
  if (end == StageEnd::converged && !fills && ending.places_expected)
    return {Outcome::converged,
            fmt::format("{} {} placed, as many as were expected to fit{}", counted(n), are(n), guess)};
  // What relaxation is known to reach and did not is not what was to be there.
  const double error = std::max(least_error, stated_error(plan.scene, plan.domain, *plan.radii, expected)),
               one_sphere = expected / std::max(1.0, expected_count);
  if (ending.places_expected && phi < expected - std::min(error, one_sphere))
    return {phi < expected - error - one_sphere ? Outcome::full : Outcome::converged,
            fmt::format("{} {} placed, packing fraction {}, where {} was expected, give or take {:.2g}; {}{}",
                        counted(n), are(n), fraction(phi), fraction(expected), error, why_no_more(end),
                        guess.empty() ? "" : "; fill = true may place more")};
  return {Outcome::converged, fmt::format("the stages of the scene place {} and no more{}", counted(n),
                                          guess.empty() ? guess
                                                        : fmt::format("; about {} were expected{}",
                                                                      grouped(static_cast<std::uint64_t>(
                                                                          std::llround(plan.expected_count))),
                                                                      guess))};
}

/// In a box all spheres are wanted, and have places together.
Conclusion of_box(const Packing& packing, const SpheresInBox& in_box, const Reporter& report, StageEnd end,
                  const Ending& ending) {
  const Target& target = in_box.task.target;
  const std::optional<Vector<dynamic>>& asked = in_box.task.target_edges;
  const std::size_t n = packing.spheres.size();
  const std::string account = report.account.empty() ? "" : " " + report.account;
  const std::size_t wanted = in_box.supply->wanted();
  // From a bed, or where there are no more places than these.
  const bool as_many_as_fit = target.is_open() && (in_box.task.container || n < wanted);
  if (n < wanted && !as_many_as_fit)
    return {end == StageEnd::full ? Outcome::full : Outcome::hit_limit,
            fmt::format("{}, packing fraction {:.4f}{}", some_placed(n, wanted), packing.packing_fraction(),
                        account)};
  if (asked && in_box.edges != *asked)
    return {Outcome::full,
            fmt::format("{} {} a box {} the one asked for; this is the box that {}", counted(n),
                        n == 1 ? "needs" : "need", larger(in_box.edges.prod() / asked->prod()),
                        n == 1 ? "it needs" : "they need")};
  if (!report.missed.empty())
    return {Outcome::hit_limit, fmt::format("{}; {}", all_placed(n), report.missed)};
  if (end == StageEnd::hit_limit) return limit_reached(n);
  if (as_many_as_fit) return of_open_target(packing, target.fill, end, ending);
  return {Outcome::converged, all_placed(n) + account};
}

/// What is less dense than was to be expected says so.
void admit_shortfall(Conclusion& conclusion, const Packing& packing, const Plan& plan) {
  if (conclusion.outcome != Outcome::converged && conclusion.outcome != Outcome::full) return;
  const std::optional<Shortfall> shortfall = shortfall_of(packing, plan);
  if (!shortfall) return;
  conclusion.reason += "; " + shortfall->reason;
  if (shortfall->is_loose && conclusion.outcome == Outcome::converged) conclusion.outcome = Outcome::loose;
}

/// In a bed they come one after the other, until the target is reached or no place is left.
Conclusion of_bed(const Packing& packing, const SpheresInBed& in_bed, const Reporter& report, StageEnd end,
                  const Ending& ending) {
  const Target& target = in_bed.task.target;
  const std::size_t n = packing.spheres.size();
  if (!report.missed.empty())
    return {Outcome::hit_limit, fmt::format("{} {} placed; {}", counted(n), are(n), report.missed)};
  if (!target.is_open() && in_bed.supply->exhausted()) {
    if (!ending.pressed || end != StageEnd::hit_limit) return {Outcome::converged, all_placed(n)};
    return {Outcome::hit_limit, all_placed(n) + ", but the last stage reached its limit"};
  }
  if (end == StageEnd::hit_limit) return limit_reached(n);
  if (target.is_open()) {
    const bool tried_one_more = end == StageEnd::full && !report.account.empty();
    return of_open_target(packing, target.fill || tried_one_more, end, ending);
  }
  if (target.count)
    return {Outcome::full,
            fmt::format("{}; {}", some_placed(n, static_cast<std::size_t>(*target.count)), why_no_more(end))};
  const double as_drawn =  // sizes that grew until they jam fill more than was asked of them
      packing.packing_fraction() / std::pow(packing.size_scale, packing.scene.dimension());
  return {Outcome::full, fmt::format("packing fraction {:.4f} of {} is reached with {}; {}", as_drawn,
                                     *packing.scene.target.packing_fraction, counted(n), why_no_more(end))};
}

/// Says whether every sphere of a bed that was pressed last rests. It is what it was meant to be only where
/// all do; by the paper's criterion, where nothing hangs.
void tell_rest(Conclusion& conclusion, const Packing& packing, const Pressing& pressed) {
  const Scene& scene = packing.scene;
  const Rest rest = measure_rest(packing.spheres, packing.domain, pressed.direction,
                                 {.gap = scene.gap, .wall_gap = scene.wall_gap, .friction = pressed.friction},
                                 packing.container);
  if (rest.held_by_friction > 0)
    conclusion.reason +=
        fmt::format("; {} {} held by friction, up to an angle of {:.3g} degrees",
                    counted(rest.held_by_friction), are(rest.held_by_friction), rest.friction);
  if (rest.unsettled == 0) {
    if (rest.held_by_friction == 0)
      conclusion.reason += packing.spheres.size() == 1 ? ", at rest" : "; every sphere rests";
    return;
  }
  std::string what = fmt::format("{} {} not at rest", counted(rest.unsettled), are(rest.unsettled));
  if (pressed.loosely && rest.hanging == 0) {
    conclusion.reason += fmt::format("; {}, none hangs", what);
    return;
  }
  if (conclusion.outcome == Outcome::converged) conclusion.outcome = Outcome::hit_limit;
  if (rest.hanging > 0)
    what = fmt::format("{} {} {:.3g} {}", counted(rest.hanging),
                       rest.hanging == 1 ? "hangs, and could fall" : "hang, and the farthest could fall",
                       rest.farthest, name_of(scene.unit));
  conclusion.reason += fmt::format("; {}: {}", what, pressed.remedy);
}

/// What is there of a bulk density that the scene asks for: by the porosity of the bed that a stage laid, or
/// where none did by the packing fraction.
void tell_bulk_density(Packing& packing, const Reporter& report) {
  const Scene& scene = packing.scene;
  if (!scene.target.bulk_density_asked || !scene.material_density) return;
  const bool of_bed = scene.target.bed.porosity.has_value();
  if (of_bed && !report.bed_porosity) return;
  const double solid = of_bed ? 1 - *report.bed_porosity : packing.packing_fraction();
  packing.bulk_density = {*scene.target.bulk_density_asked, solid * *scene.material_density};
  packing.reason += fmt::format("; the bulk density is {:.5g} kg/m3, and {:.5g} was asked for",
                                packing.bulk_density->reached, packing.bulk_density->asked);
}

std::string resized(double size_scale, bool jams) {
  return size_scale == 1 ? ""
                         : fmt::format("; all sizes are {:.9g} times those drawn{}", size_scale,
                                       jams ? ", so that they jam" : "");
}

/// What was left out of the drawn sequence.
std::string left_out(const Packing& packing, const Supply& supply, double unit) {
  const double shown = (packing.scene.sizes_are_diameters ? 2 : 1) * unit;
  const double coat = coat_of(packing.scene) / unit;
  const auto size = [&](double with_coat) {
    const double r = with_coat - coat;
    return fmt::format("{} {:.4g} {}", packing.scene.sizes_are_diameters ? "diameter" : "radius", shown * r,
                       name_of(packing.scene.unit));
  };
  std::string text;
  if (supply.cut_off() > 0)
    text += fmt::format(
        "; {} draw{} from the tail of the sizes, above {}, {} left out because the "
        "container has no room for their share of the volume",
        grouped(supply.cut_off()), supply.cut_off() == 1 ? "" : "s", size(supply.cut()),
        supply.cut_off() == 1 ? "was" : "were");
  const std::size_t passed = supply.passed_over();
  if (passed == 0) return text;
  if (supply.smallest() == supply.largest())
    return text + fmt::format("; {} of the drawn sequence found no place", grouped(passed));
  const int dimension = packing.spheres.dimension();
  double least = supply.largest(), most = 0, missing = 0, placed = 0, largest_placed = 0;
  for (std::size_t k = 0; k < passed; ++k) {
    const double r = supply.radius(supply.window()[k]);
    least = std::min(least, r);
    most = std::max(most, r);
    missing += std::pow(r - coat, dimension);
  }
  for (const double r : packing.spheres.r) {
    const double drawn = r / (unit * packing.size_scale);
    placed += std::pow(drawn, dimension);
    largest_placed = std::max(largest_placed, drawn);
  }
  text += fmt::format("; {} of the drawn sequence found no place and {} passed over: {}{}", grouped(passed),
                      passed == 1 ? "was" : "were", size(most),
                      least < most ? fmt::format(" down to {:.4g}", shown * (least - coat)) : "");
  constexpr double worth_saying = 0.01, same_size = 1 - 1e-6;
  const double share = missing / (missing + placed);
  if (share < worth_saying) return text;
  text += fmt::format("; {:.0f} % of the volume drawn is missing with {}", 100 * share,
                      passed == 1 ? "it" : "them");
  if (largest_placed < same_size * (most - coat))
    text += fmt::format(", and nothing above {} is placed", size(largest_placed + coat));
  return text;
}

}  // namespace

void conclude(Packing& packing, const SpheresOfRun& spheres, const Reporter& report, StageEnd end,
              const Ending& ending) {
  const auto* in_bed = std::get_if<SpheresInBed>(&spheres);
  const auto* in_box = std::get_if<SpheresInBox>(&spheres);
  const Supply& supply = *supply_of(spheres);
  Conclusion conclusion =
      in_bed ? of_bed(packing, *in_bed, report, end, ending) : of_box(packing, *in_box, report, end, ending);
  if (!in_bed && end != StageEnd::cancelled) admit_shortfall(conclusion, packing, ending.plan);
  if (ending.pressed && end != StageEnd::cancelled) tell_rest(conclusion, packing, *ending.pressed);
  if (end == StageEnd::cancelled) {
    const bool short_of = !in_bed && packing.spheres.size() < supply.wanted();
    conclusion = {Outcome::cancelled,
                  short_of ? "stopped by the user: " + conclusion.reason
                           : fmt::format("stopped by the user with {}", counted(packing.spheres.size()))};
    const double asked = in_box && in_box->task.target_edges ? in_box->task.target_edges->prod() : 0;
    if (asked > 0 && in_box->edges.prod() > asked)
      conclusion.reason +=
          fmt::format(", which stand in a box {} the one asked for", larger(in_box->edges.prod() / asked));
  } else if (packing.spheres.empty()) {
    conclusion = {
        conclusion.outcome == Outcome::hit_limit ? Outcome::hit_limit : Outcome::full,
        fmt::format("no sphere has found a place; {}: use smaller ones or check the units",
                    largest_in_words(ending.plan, has_walls(ending.plan.domain) ? packing.scene.wall_gap
                                                                                : coat_of(packing.scene)))};
  }
  packing.outcome = conclusion.outcome;
  packing.reason =
      conclusion.reason + (in_bed && !report.account.empty() ? "; " + report.account : std::string()) +
      (in_bed ? resized(packing.size_scale, report.missed.empty()) : std::string()) +
      (in_bed && end != StageEnd::cancelled ? left_out(packing, supply, ending.unit) : std::string());
  if (!packing.spheres.empty()) tell_bulk_density(packing, report);
}

}  // namespace bernal

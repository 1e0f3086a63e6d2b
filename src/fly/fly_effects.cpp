// What filling a box brings with it, and what that costs: one core, seconds and bytes. The constants are
// fitted to runs of 200 to 10,000 spheres; tests/bench/estimates_table holds the estimates against runs.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fly/fly.hpp"
#include "soft/relax.hpp"

namespace bernal {
namespace {

constexpr double microsecond = 1e-6;

/// Flight slows down as the packing fraction comes near to some more than what it reaches in a second,
/// `limit` times that: of each sphere first / (1 - phi / limit)^power, most of it for collisions, one in so
/// much time.
struct Slowing {
  double first, power;
  double of(double phi, double limit) const {
    return first * std::pow(std::max(0.03, 1 - phi / limit), -power);
  }
};
constexpr double limit_over_reached = 1.1;
/// Of random close packing, what flight reaches with 2,000 equal spheres in about a second, by dimension; and
/// of that between walls.
constexpr double share_of_flight[] = {0.75, 0.80, 0.71, 0.59, 0.47, 0.43, 0.41, 0.38};
constexpr double share_between_walls = 0.5;
constexpr Slowing flight{1.03 * microsecond, 2.8};
/// Each of the batches that come looks at all that are there: of each pair of spheres, by dimension. Measured
/// with 10,000 to 100,000 in a loose box.
constexpr double of_pair[] = {0.5e-9, 0.2e-9, 0.15e-9, 0.7e-9, 1.6e-9, 8e-9, 60e-9, 200e-9};
/// The patent's steps cost O(N) each: for each pair of spheres.
constexpr Slowing patent{0.067 * microsecond, 1.2};
constexpr double share_of_collisions = 0.7;
/// A trial place among classes, and how many of them a sphere takes where phi of what is attainable is asked
/// for.
constexpr double trial = 0.8 * microsecond, limit_of_classes = 1.06;
constexpr Slowing trials{1.5, 1.4};
constexpr double bytes_a_sphere = 130, bytes_of_pairs = 100;

double seconds_of_flight(FillMethod method, const Outlook& outlook) {
  const FillTask& task = outlook.task;
  const double limit = limit_over_reached * share_of_flight[task.dimension - 1] * task.attainable *
                       (task.has_walls ? share_between_walls : 1);
  const double n = outlook.spheres;
  return method == FillMethod::patent
             ? n * n * patent.of(outlook.aim, limit)
             : n * flight.of(outlook.aim, limit) + n * n * of_pair[task.dimension - 1];
}

}  // namespace

std::vector<PlanItem> effects_of_flight(const Fly& options, const Outlook& outlook) {
  const FillChoice choice = choose_filling(options.method, outlook.task);
  const double n = outlook.spheres;
  std::vector<PlanItem> items = {
      {.name = "fly", .what = fmt::format("by {}, {}", name_of(choice.method), choice.reason), .cost = ""}};
  if (outlook.placed) return items;
  if (choice.method == FillMethod::flight || choice.method == FillMethod::patent) {
    const double seconds = seconds_of_flight(choice.method, outlook);
    items.push_back({.name = "flight",
                     .what = "new spheres at random places, from large to small, while others fly",
                     .cost = "O(N) a batch",
                     .seconds = seconds,
                     .bytes = bytes_a_sphere * n});
    items.push_back({.name = "collisions",
                     .what = outlook.task.has_walls ? "elastic, between spheres and at walls"
                                                    : "elastic, between spheres",
                     .cost = choice.method == FillMethod::patent ? "O(N) each" : "O(log N) each",
                     .seconds = share_of_collisions * seconds,
                     .bytes = bytes_of_pairs * n,
                     .part = true});
    return items;
  }
  const bool by_classes = choice.method == FillMethod::classes;
  if (by_classes) {
    const double places = n * trials.of(outlook.aim, limit_of_classes * outlook.task.attainable);
    items.push_back({.name = "insertion",
                     .what = "from large to small, between those that are there",
                     .cost = "O(1) a trial",
                     .seconds = trial * places,
                     .bytes = bytes_a_sphere * n});
    items.push_back({.name = "trial places",
                     .what = "random, and pushed out of what they overlap",
                     .cost = "O(1) each",
                     .seconds = 0.7 * trial * places,
                     .part = true});
  }
  for (PlanItem& item :
       effects_of_pushing(seconds_of_filling_box(outlook), outlook,
                          by_classes ? "of all together, where not all found a place"
                                     : "spheres push each other apart; what is stuck is stirred")) {
    item.if_needed = by_classes;
    items.push_back(item);
  }
  return items;
}

}  // namespace bernal

// What insertion, compression, shaking and refilling bring with them, and what that costs: one core, seconds
// and bytes. The constants are fitted to runs of 500 to 30,000 spheres; data/results/estimates.md holds the
// estimates against runs.
#include <algorithm>
#include <cmath>

#include "settle/compress.hpp"
#include "settle/insert.hpp"
#include "work/stage_entry.hpp"

namespace bernal {
namespace {

/// A place that is tried. So many are for one sphere: 1 / (1 - phi / limit)^power, where phi is filled, at
/// most the attempts that the stage allows.
constexpr double seconds_a_trial = 0.35e-6, limit_of_insertion = 0.385, power_of_insertion = 1.2;
/// A sphere's way down, a mean diameter of the container's height, and what comes on top of that while a bed
/// is refilled; that of a bed that has settled before; and how these grow with the spread of sizes.
constexpr double first_compression = 3e-6, power_of_first = 2, refilled_compression = 12e-6,
                 below_refilled = 120e-6, power_of_refilled = 1, later_compression = 11e-6;
/// What local directions add, and the share that the paper's tolerance takes.
constexpr double of_tilt = 1.2, of_tolerance = 0.45;
/// A round of shaking without the compression after it. A probe.
constexpr double shaking_round = 5e-6, seconds_a_probe = 0.12e-6;
/// Rounds of refilling until 1,000 spheres have settled densely, how they become more with their number, and
/// fewer where less is asked for.
constexpr double rounds_until_full = 7, rounds_by_count = 0.1, rounds_by_share = 4;
/// To walls, of a sphere: while it is inserted, sinks for the first time, and in each compression after that.
constexpr double questions_of_insertion = 2, questions_of_first = 18, questions_of_later = 1.5;
constexpr double share_of_lists = 0.25;
constexpr double bytes_a_sphere = 120, bytes_of_lists = 190, bytes_a_probe = 40;
/// Packing fraction of what has settled.
constexpr double settled = 0.57;

double compression(const Compress& options, double spheres, double each) {
  return spheres * each * (options.tilt > 0 ? 1 + of_tilt : 1) * (options.tolerance ? of_tolerance : 1);
}

/// Of the container along the direction, which in two dimensions may still be that of three, in mean
/// diameters.
double height_along(const Coordinates& direction, const Outlook& outlook) {
  if (direction.size() != outlook.size.size()) return outlook.size[outlook.size.size() - 1];
  return direction.cwiseAbs().dot(outlook.size) / direction.norm();
}

std::vector<PlanItem> effects_of_compressing(double sweeping, double questions, std::string when,
                                             const Outlook& outlook) {
  const PlanItem walls = questions_to_walls(questions, outlook);
  const double seconds = sweeping + walls.seconds;
  return {walls,
          neighbor_lists(share_of_lists * seconds, bytes_of_lists * outlook.spheres),
          {.name = "compression",
           .what = std::move(when),
           .cost = "about 0.5 µs a sphere and sweep",
           .seconds = seconds,
           .bytes = bytes_a_sphere * outlook.spheres}};
}

PlanItem shaking(double rounds, std::string what, const Outlook& outlook) {
  return {.name = "shaking",
          .what = std::move(what),
          .cost = "about 0.5 µs a sphere and sweep",
          .seconds = rounds * shaking_round * outlook.spheres};
}

}  // namespace

double seconds_of_insertion(double phi, double spheres, double attempts) {
  const double crowded = std::max(1e-3, 1 - phi / limit_of_insertion);
  return spheres * seconds_a_trial * std::min(attempts, std::pow(crowded, -power_of_insertion));
}

std::vector<PlanItem> effects_of_insertion(const Insert& options, const Outlook& outlook) {
  const double phi = std::min(options.until(), outlook.aim);
  const double spheres = outlook.spheres * phi / outlook.aim;
  const PlanItem walls = questions_to_walls(questions_of_insertion, outlook);
  const bool on_lattice = options.layout != Layout::random;
  return {walls,
          {.name = "insertion",
           .what = on_lattice ? "sites of a lattice, one sphere after the other"
                              : "random places, one sphere after the other",
           .cost = on_lattice ? "O(1) a site" : "O(1) a trial",
           .seconds = walls.seconds + (on_lattice ? spheres * seconds_a_trial
                                                  : seconds_of_insertion(phi, spheres, options.attempts)),
           .bytes = bytes_a_sphere * outlook.spheres}};
}

std::vector<PlanItem> effects_of_compression(const Compress& options, const Outlook& outlook) {
  Outlook now = outlook;
  now.spheres *= std::min(1.0, outlook.filled / outlook.aim);
  const double each =
      first_compression * height_along(options.direction, outlook) * std::pow(outlook.spread, power_of_first);
  return effects_of_compressing(compression(options, now.spheres, each), questions_of_first,
                                "to first touch along the global and local directions", now);
}

std::vector<PlanItem> effects_of_shaking(const Shake& options, const Outlook& outlook) {
  Outlook now = outlook;
  now.spheres *= std::min(1.0, outlook.filled / outlook.aim);
  std::vector<PlanItem> items =
      effects_of_compressing(options.rounds * compression(options.compress, now.spheres, later_compression),
                             options.rounds * questions_of_later, "after each round of shaking", now);
  items.insert(items.begin() + 2, shaking(options.rounds, "local directions across the global one", now));
  return items;
}

std::vector<PlanItem> effects_of_refilling(const Refill& options, const Outlook& outlook) {
  const double share = outlook.is_filled ? 1 : std::min(1.0, outlook.aim / settled);
  const double rounds = std::min(static_cast<double>(options.max_rounds),
                                 1 + rounds_until_full * std::pow(outlook.spheres / 1000, rounds_by_count) *
                                         std::pow(share, rounds_by_share));
  const double probes = std::min(4e6, 1000 + options.probes * outlook.spheres / outlook.aim);
  std::vector<PlanItem> items = {{.name = "refilling",
                                  .what = "random probes of the free space",
                                  .cost = "O(1) a probe",
                                  .seconds = probes * seconds_a_probe * (1 + rounds),
                                  .bytes = bytes_a_probe * probes}};
  const Compress& compress = options.shake.compress;
  const double each = (below_refilled + refilled_compression * height_along(compress.direction, outlook)) *
                      std::pow(outlook.spread, power_of_refilled);
  const double refilled = outlook.spheres * (1 - std::min(1.0, outlook.filled / outlook.aim));
  for (PlanItem& item : effects_of_compressing(compression(compress, refilled, each),
                                               rounds * (1 + options.shake.rounds) * questions_of_later,
                                               "after each refilling", outlook))
    items.push_back(item);
  items.push_back(shaking(rounds * options.shake.rounds, "after each refilling", outlook));
  if (outlook.placed && !outlook.is_filled && outlook.filled >= outlook.aim)
    for (PlanItem& item : items) item.if_needed = true, item.seconds = 0;
  return items;
}

}  // namespace bernal

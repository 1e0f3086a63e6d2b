// What growth brings with it, and what that costs: one core, seconds and bytes. The constants are fitted to
// runs of 300 to 30,000 spheres; tests/bench/estimates_table holds the estimates against runs.
#include <algorithm>
#include <cmath>

#include "hard/grow.hpp"
#include "jam/polish.hpp"

namespace bernal {
namespace {

/// Collisions a sphere of the default rate until spheres jam at the default pressure; of spheres that a stage
/// before has nearly jammed, until the pressure has risen tenfold; and of a fluid.
constexpr double collisions_until_jammed = 2000, default_rate = 0.01, collisions_a_decade = 20;
/// delta is published against the box: this many times the rate, by the length of the box in diameters.
constexpr double rate_of_delta = 0.45, cost_of_patience = 0.8;
/// A collision, the cost of sizes that differ, of a memory that has to be waited for, of more dimensions.
constexpr double collision = 0.53e-6, growth_with_count = 0.03;
constexpr double cost_of_spread = 0.6;
constexpr double by_dimension[] = {1, 0.6, 1, 1.5, 2.9, 3.8};
/// Of the whole, what collisions, shells and reflections take; shells left for each collision.
constexpr double share_of_collisions = 0.85, share_of_shells = 0.06, share_of_reflections = 0.2;
constexpr double bytes_a_sphere = 200, bytes_of_shells = 700, bytes_of_calendar = 100, bytes_at_wall = 80;
/// A random place; questions to the walls of a container, for each sphere.
constexpr double trial = 1.5e-6, questions = 3;
/// In a container spheres have their radii before they jam: of the collisions until then, room being what is
/// free of what is attainable, share / (room + least_room).
constexpr double share_of_room = 0.008, least_room = 0.02;
/// As many as can be placed jam, lose the last drawn and grow again: 1,900 to 4,000 collisions of 640 to
/// 1,800 spheres and discs in seven containers, four of which are not convex.
constexpr double factor_of_filling = 1.5;

double collisions_a_sphere(const Grow& options, const Outlook& outlook) {
  const double length =
      std::cbrt(outlook.spheres / std::max(0.1, outlook.aim));  // of the box, about, in diameters
  const double rate = options.delta ? rate_of_delta * *options.delta / length : options.rate;
  const double decades = std::log10(options.pressure);
  if (!outlook.in_bed && outlook.placed) return collisions_a_decade * decades;
  double jammed = collisions_until_jammed * std::pow(rate / default_rate, -cost_of_patience) * decades / 6;
  if (outlook.in_bed && outlook.is_filled) jammed *= factor_of_filling;
  if (outlook.in_bed && !outlook.is_filled) {
    const double room = std::max(0.0, 1 - outlook.aim / outlook.task.attainable);
    jammed *= std::min(1.0, share_of_room / (room + least_room));
  }
  return jammed;
}

double seconds_a_collision(const Outlook& outlook) {
  return collision * by_dimension[static_cast<std::size_t>(std::clamp(outlook.task.dimension, 1, 6) - 1)] *
         std::pow(std::max(1.0, outlook.spheres / 1000), growth_with_count) *
         std::pow(outlook.spread, cost_of_spread);
}

}  // namespace

std::vector<PlanItem> effects_of_growth(const Grow& options, const Outlook& outlook) {
  const double n = outlook.spheres;
  const double seconds = n * collisions_a_sphere(options, outlook) * seconds_a_collision(outlook);
  const bool reflects = outlook.in_bed || outlook.task.has_walls;
  std::vector<PlanItem> items;
  if (!outlook.placed || outlook.in_bed)
    items.push_back({.name = "insertion",
                     .what = "random places at the start, the largest first",
                     .cost = "O(1) a trial",
                     .seconds = trial * n,
                     .part = !outlook.in_bed});
  items.push_back({.name = "neighbour shells",
                   .what = reflects ? "each sphere renews its own list, and that of its walls"
                                    : "each sphere renews its own list",
                   .cost = "about 1 µs",
                   .seconds = share_of_shells * seconds,
                   .bytes = bytes_of_shells * n,
                   .part = true});
  items.push_back({.name = "collisions",
                   .what = "of growing spheres, from a calendar of events",
                   .cost = "0.5 to 0.8 µs",
                   .seconds = share_of_collisions * seconds,
                   .bytes = bytes_of_calendar * n,
                   .part = true});
  if (reflects)
    items.push_back({.name = "reflections",
                     .what = "of growing spheres from the walls",
                     .cost = "0.5 to 0.8 µs",
                     .seconds = share_of_reflections * outlook.at_walls * seconds,
                     .bytes = bytes_at_wall * n,
                     .part = true});
  if (outlook.in_bed) items.push_back(questions_to_walls(questions, outlook));
  items.push_back({.name = "growth",
                   .what = outlook.in_bed
                               ? "until the spheres have their radii; what jams loses the last drawn"
                               : "until the spheres jam",
                   .cost = "some 2,000 collisions a sphere",
                   .seconds = seconds,
                   .bytes = bytes_a_sphere * n});
  // Where they are that few, spheres may have their radii before any two meet.
  const bool starts_grown =
      outlook.task.packing_fraction > 0 && outlook.aim <= options.phi_init.value_or(0.2);
  for (PlanItem& item : items)
    if (starts_grown && (item.name == "collisions" || item.name == "reflections")) item.if_needed = true;
  if (options.polish > 0) add_polishing(items, outlook);
  return items;
}

}  // namespace bernal

#include "bernal/soft/settle.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "domain/volume_below.hpp"
#include "settle/compress.hpp"
#include "settle/roll_to_rest.hpp"
#include "soft/pour.hpp"
#include "soft/relax.hpp"
#include "work/stage_entry.hpp"

namespace bernal {
namespace {

/// Of what relaxation fills of the same container: a poured bed. Settled without friction by compression,
/// columns of 4, 6 and 20 diameters have porosities of 0.466, 0.442 and 0.404 far from their ends; so have
/// those with this share, to 0.003.
constexpr double share_of_relaxed = 0.963;

/// In mean diameters.
constexpr double shallow = 3;

/// What a sphere takes that falls by some hundredths of its radius and rolls to rest; and walls asked.
constexpr double seconds_of_rolling = 15e-6, questions_of_rolling = 4;

std::vector<PlanItem> effects_of_settling(const Settle& options, const Outlook& outlook) {
  Outlook relaxed = outlook;
  // As densely as the bed below its level, however little of the container that is.
  relaxed.aim = options.bed.porosity ? 1 - *options.bed.porosity : share_of_relaxed * outlook.task.attainable;
  std::vector<PlanItem> items = effects_of_relaxation({}, relaxed);
  // A few on a wide floor find places at random.
  const double height = direction_of(options.direction).cwiseAbs().dot(outlook.size);
  if (outlook.task.packing_fraction > 0 && outlook.task.packing_fraction * height < shallow * relaxed.aim)
    for (PlanItem& item : items) item.if_needed = true;
  const PlanItem walls = questions_to_walls(questions_of_rolling, outlook);
  items.push_back({.name = "rolling",
                   .what = "every sphere falls and rolls until all rest",
                   .cost = "some five sweeps of O(N)",
                   .seconds = walls.seconds + seconds_of_rolling * outlook.spheres});
  items.push_back(walls);
  return items;
}

/// Weighted by the volumes of the spheres.
double mean_height(const Bed& bed, const BedTop& top) {
  double sum = 0, volume = 0;
  for (Bed::Id i = 0; i < bed.size(); ++i) {
    const double own = ball_volume(3, bed[i].r);
    sum += own * top.height(bed[i].center);
    volume += own;
  }
  return sum / volume;
}

/// Says how porous the bed has become, and that it is not as was asked where it differs by more than this.
constexpr double as_asked = 0.015;

void tell_porosity(Work& work, const Settle& options, const Heights& heights, const BedTop& top) {
  const double filled = work.bed().packing_fraction() * work.container->volume();
  const double height = work.target.bed.above_ground;
  const double porosity = 1 - filled / (height > 0 ? heights.volume_below(heights.ground() + height)
                                                   : heights.volume_below_mean(mean_height(work.bed(), top)));
  if (!(porosity > 0 && porosity < 1)) return;  // of a few spheres on a floor there is none
  work.account = fmt::format("the bed has a porosity of {:.3f}", porosity);
  if (!options.bed.porosity || std::abs(porosity - *options.bed.porosity) <= as_asked) return;
  work.missed =
      fmt::format("a porosity of {:.3g} was asked for: {}", *options.bed.porosity,
                  porosity > *options.bed.porosity ? "they find no room in less than that"
                                                   : "they fall until they rest, and then that is left");
}

/// Says that the bed is not as high as was asked where it differs by more than that, in largest diameters.
constexpr double as_high = 1.05;

void tell_height(Work& work, const Heights& heights, const BedTop& top) {
  const double asked = work.target.bed.above_ground;
  if (!(asked > 0) || work.bed().size() == 0) return;
  double highest = 0;
  for (Bed::Id i = 0; i < work.bed().size(); ++i)
    highest = std::max(highest, top.up().dot(work.bed()[i].center) + work.bed()[i].r - heights.ground());
  if (highest < asked - as_high * 2 * work.supply->largest())
    work.missed = fmt::format("the bed is only {:.3g} of the height that was asked for", highest / asked);
  else if (highest > asked * (1 + 1e-3))
    work.missed =
        fmt::format("what was there before is {:.3g} times as high as the bed was to be", highest / asked);
}

/// Packing fraction of the bed by what is expected of the whole container.
double aim_of(const Work& work, const BedTarget& bed, const Heights& heights) {
  if (bed.porosity) return 1 - *bed.porosity;
  const double height = work.target.bed.above_ground, whole = work.container->volume();
  return height > 0 ? work.attainable * whole / heights.volume_below(heights.ground() + height)
                    : work.attainable;
}

/// Onto a start, which rests, the others are poured; what other stages have placed is placed anew. Then each
/// falls and rolls to rest. Cost: that of relaxation, and of `roll_to_rest`.
StageEnd settle(Work& work, const Settle& options) {
  const Vector<3> down = direction_of(options.direction);
  require_support(work.bed().container().boundary(), down);
  const NotResumable whole_or_not_at_all(work);
  const BedTop top(work.target.bed, *work.container, down);
  const Heights heights(*work.container, top, VolumeBelow(work.domain, down).lowest());
  const std::size_t held = work.begun;
  if (held == 0)
    work.put_in_bed({});
  else if (rest_first(work, down, options.rest) == StageEnd::cancelled)
    return StageEnd::cancelled;
  const StageEnd end = pour(work, top, heights.ground(), aim_of(work, options.bed, heights));
  if (end == StageEnd::cancelled) return end;
  const EffectTimer timer(work.effects["rolling"]);
  const Made made("rolling");
  const StageEnd rest = roll_to_rest(work, down, options.rest, held);
  tell_porosity(work, options, heights, top);
  tell_height(work, heights, top);
  const bool to_the_brim = !work.target.is_open() && !work.supply->exhausted();
  if (to_the_brim && !work.account.empty()) work.account += " and reaches the brim";
  return rest == StageEnd::converged ? end : rest;
}

void take_bed_target(Settle& options, Scene& scene, const schema::Section&) {
  options.bed = scene.target.bed;
}

}  // namespace

template <>
const StageEntry& entry_of<Settle>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Settle>(
          {.name = "settle",
           .help = "a bed under gravity: spheres lie at the bottom, as dense as poured ones, and every one "
                   "of them rests",
           .keys =
               {key(Type::push, &Settle::direction, "direction", "of gravity; its length is of no matter"),
                buys_accuracy({1e-2, 1e-3, 1e-5, 1e-7},
                              number(&Settle::rest, "rest",
                                     "how far a sphere may still fall and roll, in radii, and count as "
                                     "at rest; with more than 1e-7 it is only judged whether spheres hang",
                                     above(0, 1)))},
           .complete = completion(take_bed_target)},
          {.in_bed = true, .keeps_sizes = true, .places_expected = true, .makes_bed = true}),
      .act_in_bed = act(settle),
      .may_bring = {"insertion", "neighbour lists", "relaxation", "rolling"},
      .effects = of_options(effects_of_settling),
      .require = of_options(+[](const Settle& o, const Domain& domain, double, const FillTask&) {
        require_support(boundary_of<3>(domain), direction_of(o.direction));
      }),
      .reached = of_options(+[](const Settle& o) { return o.bed.porosity ? 1 - *o.bed.porosity : 1; }),
      .full = of_options(+[](const Settle& o, const EmptyBed& bed) {
        return bed.share * (o.bed.porosity ? 1 - *o.bed.porosity : share_of_relaxed * bed.relaxed);
      })};
  return entry;
}

}  // namespace bernal

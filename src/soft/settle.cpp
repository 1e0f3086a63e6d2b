#include "bernal/soft/settle.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "domain/volume_below.hpp"
#include "settle/compress.hpp"
#include "settle/roll_to_rest.hpp"
#include "soft/above_spheres.hpp"
#include "soft/bed_density.hpp"
#include "soft/pour.hpp"
#include "soft/relax.hpp"
#include "soft/settle_as_dense.hpp"
#include "soft/tap.hpp"
#include "work/stage_entry.hpp"

namespace bernal {
namespace {

/// Of what relaxation fills of the same container: a poured bed. Settled without friction by compression,
/// columns of 4, 6 and 20 diameters have porosities of 0.466, 0.442 and 0.404 far from their ends; so have
/// those with this share, to 0.003.
constexpr double share_of_relaxed = 0.963;
/// In mean diameters.
constexpr double shallow = 3;

/// So many beds are laid until one is as porous as is asked, about.
constexpr double beds_tapped = 2, beds_tried = 5;
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
  const bool vibrated = options.bed.density == BedTarget::Density::vibrated;
  const double beds = vibrated ? beds_tapped : options.bed.porosity ? beds_tried : 1;
  for (PlanItem& item : items) item.seconds *= beds;
  if (vibrated || options.bed.porosity)
    items.push_back({.name = "tapping",
                     .what = "spheres are displaced and pushed apart, by less and less, for a denser bed",
                     .cost = "some 10,000 sweeps of O(N)",
                     .seconds = vibrated ? beds_tapped * usual_taps * seconds_a_tap * outlook.spheres : 0,
                     .if_needed = !vibrated});
  items.push_back({.name = "rolling",
                   .what = "every sphere falls and rolls until all rest",
                   .cost = "some five sweeps of O(N)",
                   .seconds = beds * (walls.seconds + seconds_of_rolling * outlook.spheres)});
  items.push_back(walls);
  return items;
}

/// What is expected of a bed by its walls, floor and lid among them.
double as_dense_as_aimed(const BedTarget& target, const EmptyBed& bed) {
  const double poured = share_of_relaxed * bed.relaxed, across = 4 / bed.wall_share;
  const auto aim = aim_of(target, {across, true}, 1).first;
  if (!aim) return poured;
  return bed.evenness == 1 ? 1 - aim->porosity
                           : std::min(1.0, poured * (1 - aim->porosity) / (1 - porosity_poured(across)));
}

/// Says that the bed is not as high as was asked where it differs by more than that, in largest diameters.
constexpr double as_high = 1.05;

void tell_height(const SpheresInBed& in_bed, Reporter& report, double ground, const BedTop& top) {
  const double asked = in_bed.task.target.bed.above_ground;
  if (!(asked > 0) || in_bed.bed().size() == 0) return;
  double highest = 0;
  for (Bed::Id i = 0; i < in_bed.bed().size(); ++i)
    highest = std::max(highest, top.up().dot(in_bed.bed()[i].center) + in_bed.bed()[i].r - ground);
  if (highest < asked - as_high * 2 * in_bed.supply->largest())
    report.missed = fmt::format("the bed is only {:.3g} of the height that was asked for", highest / asked);
  else if (highest > asked * (1 + 1e-3))
    report.missed =
        fmt::format("what was there before is {:.3g} times as high as the bed was to be", highest / asked);
}

/// Packing fraction of a poured bed, by what is expected of the whole container.
double poured_of(const SpheresInBed& in_bed, const Heights& heights) {
  const double height = in_bed.task.target.bed.above_ground, whole = in_bed.task.container->volume();
  return height > 0 ? in_bed.task.attainable * whole / heights.volume_below(heights.ground() + height)
                    : in_bed.task.attainable;
}

/// Onto a start, which rests, the others are poured; what other stages have placed is placed anew. Then each
/// falls and rolls to rest. Cost: that of relaxation, and of `roll_to_rest`.
StageEnd settle(const Settle& options, SpheresInBed& in_bed, Reporter& report) {
  const Task& task = in_bed.task;
  const Vector<3> down = direction_of(options.direction);
  require_support(in_bed.bed().container().boundary(), down);
  const NotResumable whole_or_not_at_all(report);
  const BedTop top(task.target.bed, *task.container, down);
  const Heights heights(*task.container, top, VolumeBelow(task.domain, down).lowest());
  const std::size_t held = in_bed.begun;
  if (held == 0)
    in_bed.put_in_bed({});
  else if (rest_first(in_bed.bed(), report, down, options.rest) == StageEnd::cancelled)
    return StageEnd::cancelled;
  const std::shared_ptr<const Container> room =
      held == 0 ? task.container : above_spheres(task.container, in_bed.bed().spheres(), top.up());
  const Heights of_room = held == 0 ? heights : Heights(*room, top, heights.ground());
  const auto lay = [&](Laying& how) {
    const StageEnd end = pour(in_bed, report, top, room, of_room, how);
    if (end == StageEnd::cancelled) return end;
    const EffectTimer timer(report.effects["rolling"]);
    const Made made("rolling");
    const StageEnd rest = roll_to_rest(in_bed.bed(), report, down,
                                       {.still = options.rest, .friction = how.friction, .held = held});
    return rest == StageEnd::converged ? end : rest;
  };
  const StageEnd end =
      settle_as_dense(in_bed, report, options.bed, heights, top, poured_of(in_bed, heights), lay);
  if (end == StageEnd::cancelled) return end;
  tell_height(in_bed, report, heights.ground(), top);
  const bool to_the_brim = !task.target.is_open() && !in_bed.supply->exhausted();
  if (to_the_brim && !report.account.empty()) report.account += "; it reaches the brim";
  return end;
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
          {.in_bed = true,
           .in_repeated_mesh = true,
           .keeps_sizes = true,
           .places_expected = true,
           .makes_bed = true}),
      .act_in_bed = of_options(settle),
      .may_bring = {"insertion", "neighbour lists", "relaxation", "tapping", "rolling"},
      .effects = of_options(effects_of_settling),
      .pressing = of_options(+[](const Settle& o) {
        return Pressing{direction_of(o.direction), o.rest > Settle{}.rest, o.bed.friction(),
                        "make \"rest\" of settle smaller, or take another \"seed\""};
      }),
      .require = of_options(+[](const Settle& o, const Domain& domain, double, const FillTask&) {
        require_support(boundary_of<3>(domain), direction_of(o.direction));
      }),
      .reached = of_options(+[](const Settle& o) { return o.bed.porosity ? 1 - *o.bed.porosity : 1; }),
      .full = of_options(+[](const Settle& o, const EmptyBed& bed) {
        return bed.share * (o.bed.porosity ? 1 - *o.bed.porosity : as_dense_as_aimed(o.bed, bed));
      })};
  return entry;
}

}  // namespace bernal

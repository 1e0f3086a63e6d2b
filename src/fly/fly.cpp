#include "fly/fly.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "fly/fill_by_classes.hpp"
#include "fly/fly_events.hpp"
#include "fly/fly_patent.hpp"
#include "work/stage_entry.hpp"

namespace bernal {
namespace {

/// Where radii differ more than this, small spheres have room between the large ones: those come first.
constexpr double wide_sizes = 4;

constexpr std::string_view methods[] = {"auto", "flight", "patent", "classes", "relaxation"};

/// What `fly` fills the box to is the scene's target.
void complete_fly(Fly& fly, Scene& scene, const schema::Section& section) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (!fly.packing_fraction || !box) return;
  Target& target = scene.target;
  if (target.packing_fraction || target.fill || (target.count && !box->scalable))
    section.fail("packing_fraction",
                 "\"packing_fraction\" in [[stage]] fly says again what [spheres] says; leave it out");
  target.packing_fraction = std::exchange(fly.packing_fraction, std::nullopt);
  target.where = section.locations.of("packing_fraction");
}

/// Takes out the spheres that overlap their own image or do not fit between two walls.
std::size_t drop_too_wide(Work& work) {
  Spheres<dynamic> fitting(work.dimension());
  fitting.reserve(work.spheres.size());
  const double skin = 1 + 1e-9;  // more than the margin that flying spheres keep from walls
  for (std::size_t i = 0; i < work.spheres.size(); ++i) {
    bool fits = true;
    for (int k = 0; k < work.dimension(); ++k)
      fits = fits && 2 * work.spheres.r[i] * (work.has_wall(k) ? skin : 1) <= (*work.target_edges)[k];
    if (fits) fitting.push_back(work.spheres.center(i), work.spheres.r[i]);
  }
  const std::size_t dropped = work.spheres.size() - fitting.size();
  if (dropped > 0) work.spheres = std::move(fitting);
  return dropped;
}

StageEnd fill(Work& work, FillMethod method, const Fly& options) {
  switch (method) {
    case FillMethod::patent:
    case FillMethod::flight: {
      const EffectTimer timer(work.effects["flight"]);
      return method == FillMethod::patent ? fly_by_patent(work, options) : fly_by_events(work, options);
    }
    case FillMethod::classes:
      return fill_by_classes(work, {.sweeps = static_cast<double>(options.sweeps)});
    case FillMethod::relaxation:
    case FillMethod::automatic:
      break;
  }
  return fill_by_relaxation(work, {.sweeps = static_cast<double>(options.sweeps)});
}

bool flies(FillMethod method) { return method == FillMethod::patent || method == FillMethod::flight; }

}  // namespace

std::string_view name_of(FillMethod method) { return methods[static_cast<std::size_t>(method)]; }

FillChoice choose_filling(FillMethod method, const FillTask& task) {
  if (method != FillMethod::automatic) {
    if (task.has_walls && method == FillMethod::classes)
      throw Error(ErrorCode::bad_argument,
                  "\"classes\" does not know walls; with walls, the methods are \"auto\", \"flight\", "
                  "\"patent\" and \"relaxation\"");
    return {method, "as the scene asks for it"};
  }
  if (task.size_ratio > wide_sizes && !task.has_walls)
    return {FillMethod::classes, fmt::format("as the largest sphere is {:.3g} times the smallest: small ones "
                                             "find room between the large",
                                             task.size_ratio)};
  return {FillMethod::relaxation, "which fills a box fastest"};
}

StageEnd fly(Work& work, const FillChoice& choice, const Fly& options) {
  std::size_t wanted = work.spheres.size(), too_wide = 0;
  const Resumable part(work, "fly", [&](Archive& a) { a(wanted, too_wide, work.spheres); });
  if (!part.resumed()) {
    if (work.placed && work.edges == *work.target_edges) {
      work.account = "all had places in this box before";
      return StageEnd::converged;
    }
    too_wide = drop_too_wide(work);
  }
  StageEnd end = StageEnd::converged;
  if (!work.spheres.empty()) {
    end = fill(work, choice.method, options);
  }
  work.edges = *work.target_edges;
  work.placed = true;
  work.needed_volume = work.edges.prod();

  work.account = fmt::format("by {}, {}", name_of(choice.method), choice.reason);
  if (too_wide > 0) {
    end = end == StageEnd::converged ? StageEnd::full : end;
    work.account += fmt::format("; {} wider than the box", grouped(too_wide));
  }
  const std::size_t missing = wanted - too_wide - work.spheres.size();
  if (missing > 0 && flies(choice.method) && end == StageEnd::full)
    work.account += fmt::format(
        "; no place was free among {} in a row",
        grouped(static_cast<std::uint64_t>(options.patience * static_cast<double>(wanted - too_wide))));
  return end;
}

template <>
const StageEntry& entry_of<Fly>() {
  using namespace schema;
  static const StageEntry entry = {
      .table = stage_table<Fly>(
          {.name = "fly",
           .help = "fill a box of given size with spheres of given radii that fly and collide",
           .keys = {word(&Fly::method, "method",
                         "auto: classes where sizes are wide and there are no walls, else relaxation; "
                         "flight: from collision to collision; patent: in steps of "
                         "one collision; classes: large ones first, small ones between them; relaxation: all "
                         "at once, pushed apart",
                         {std::begin(methods), std::end(methods)}),
                    number(&Fly::packing_fraction, "packing_fraction",
                           "where [spheres] does not say it: the one to fill the box to",
                           packing_fractions()),
                    integer(&Fly::batch, "batch",
                            "flight, patent: new spheres tried between two steps; 0: half of all, for the "
                            "patent's procedure a tenth",
                            {0, 1e9}),
                    number(&Fly::dt, "dt",
                           "flight, patent: way between two batches in mean diameters; if absent 0.25, for "
                           "the patent's procedure 0.01",
                           above(0, 1e6)),
                    buys_accuracy({10, 100, 1000, 10000},
                                  number(&Fly::patience, "patience",
                                         "flight, patent: full when so many places in a row, for each "
                                         "sphere, were not free",
                                         above(0, 1e9))),
                    integer(&Fly::sweeps, "sweeps",
                            "classes, relaxation: of all spheres, after which it stops", {1, 1e9})},
           .complete = completion(complete_fly)},
          {.in_box = true, .box_between_walls = true, .leaves_overlap = true, .fills_given_box = true}),
      .act_in_box = act(+[](Work& work, const Fly& options) {
        const FillChoice choice = choose_filling(options.method, work.fill_task);
        Fly chosen = options;
        if (!chosen.dt) chosen.dt = choice.method == FillMethod::patent ? 0.01 : 0.25;
        return fly(work, choice, chosen);
      }),
      .may_bring = {"flight", "collisions", "insertion", "trial places", "neighbour lists", "relaxation"},
      .effects = of_options(effects_of_flight),
      .leaves_overlap = of_options(+[](const Fly& options, const FillTask& task) {
        return !flies(choose_filling(options.method, task).method);
      })};
  return entry;
}

}  // namespace bernal

#include "fly/fly.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "fly/fill_by_classes.hpp"
#include "fly/fly_events.hpp"
#include "fly/fly_patent.hpp"

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
std::size_t drop_too_wide(SpheresInBox& in_box) {
  const Task& task = in_box.task;
  const Spheres<dynamic>& spheres = in_box.spheres;
  std::vector<std::uint32_t> fitting;
  const double skin = 1 + 1e-9;  // more than the margin that flying spheres keep from walls
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    bool fits = true;
    for (int k = 0; k < in_box.dimension(); ++k)
      fits = fits && 2 * spheres.r[i] * (task.has_wall(k) ? skin : 1) <= (*task.target_edges)[k];
    if (fits) fitting.push_back(i);
  }
  const std::size_t dropped = spheres.size() - fitting.size();
  if (dropped > 0) in_box.leave(fitting);
  return dropped;
}

StageEnd fill(SpheresInBox& in_box, Reporter& report, FillMethod method, const Fly& options) {
  const FillOptions filling{.sweeps = static_cast<double>(options.sweeps)};
  switch (method) {
    case FillMethod::patent:
    case FillMethod::flight: {
      const EffectTimer timer(report.effects["flight"]);
      return method == FillMethod::patent ? fly_by_patent(in_box, report, options)
                                          : fly_by_events(in_box, report, options);
    }
    case FillMethod::classes:
      return fill_by_classes(in_box, report, filling);
    case FillMethod::relaxation:
    case FillMethod::automatic:
      break;
  }
  return fill_by_relaxation(in_box, report, filling);
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

StageEnd fly(SpheresInBox& in_box, Reporter& report, const FillChoice& choice, const Fly& options) {
  std::size_t wanted = in_box.spheres.size(), too_wide = 0;
  const Resumable part(report, "fly", [&](Archive& a) { a(wanted, too_wide, in_box.spheres, in_box.tags); });
  if (!part.resumed()) {
    if (in_box.placed && in_box.edges == *in_box.task.target_edges) {
      report.account = "all had places in this box before";
      return StageEnd::converged;
    }
    too_wide = drop_too_wide(in_box);
  }
  StageEnd end = StageEnd::converged;
  if (!in_box.spheres.empty()) {
    end = fill(in_box, report, choice.method, options);
  }
  in_box.edges = *in_box.task.target_edges;
  in_box.placed = true;
  in_box.needed_volume = in_box.edges.prod();

  report.account = fmt::format("by {}, {}", name_of(choice.method), choice.reason);
  if (too_wide > 0) {
    end = end == StageEnd::converged ? StageEnd::full : end;
    report.account += fmt::format("; {} wider than the box", grouped(too_wide));
  }
  const std::size_t missing = wanted - too_wide - in_box.spheres.size();
  if (missing > 0 && flies(choice.method) && end == StageEnd::full)
    report.account += fmt::format(
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
      .act_in_box = of_options(+[](const Fly& options, SpheresInBox& in_box, Reporter& report) {
        const FillChoice choice = choose_filling(options.method, in_box.task.fill_task);
        Fly chosen = options;
        if (!chosen.dt) chosen.dt = choice.method == FillMethod::patent ? 0.01 : 0.25;
        return fly(in_box, report, choice, chosen);
      }),
      .may_bring = {"flight", "collisions", "insertion", "trial places", "neighbour lists", "relaxation"},
      .effects = of_options(effects_of_flight),
      .leaves_overlap = of_options(+[](const Fly& options, const FillTask& task) {
        return !flies(choose_filling(options.method, task).method);
      })};
  return entry;
}

}  // namespace bernal

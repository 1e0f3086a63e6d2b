#include "run/run_in_domain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/text.hpp"
#include "bernal/domain/container.hpp"
#include "run/fitting.hpp"
#include "run/stages.hpp"
#include "work/work.hpp"

namespace bernal {
namespace {

/// The frame in which the packer works. Throws where coordinates are so large that neighbouring spheres could
/// not be told apart.
Frame working_frame(const Plan& plan) {
  Frame frame = frame_of(plan.domain);
  const double smallest = plan.radii->min() > 0 ? plan.radii->min() : plan.radii->quantile(1e-9);
  if (1e6 * frame.resolution * frame.scale > smallest) {
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the container is so far from the origin that its coordinates are only good to {:.1g} "
                    "{}: move it closer or use larger spheres",
                    frame.resolution * frame.scale, name_of(plan.scene.unit)),
        plan.scene.container.locations.whole);
  }
  return frame;
}

/// What a stage cannot do, only it knows; where the scene asks for it, only the run.
StageEnd run_stage(const Stage& stage, Work& work) {
  const StageEntry& entry = entry_of(stage);
  try {
    return entry.run(entry.table.options(stage), work);
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), error.what(), stage.locations.whole);
  }
}

/// How the last stage's end, and what the scene asked for, make the outcome of the run.
void conclude(Packing& packing, const Supply& supply, StageEnd end) {
  const Target& target = packing.scene.target;
  const auto n = grouped(packing.spheres.size());
  if (end == StageEnd::cancelled) {
    packing.outcome = Outcome::cancelled;
    packing.reason = fmt::format("stopped by the user with {} spheres", n);
  } else if (!target.is_open() && supply.exhausted()) {
    packing.outcome = Outcome::converged;
    packing.reason = fmt::format("all {} spheres are placed", n);
  } else if (end == StageEnd::hit_limit) {
    packing.outcome = Outcome::hit_limit;
    packing.reason = fmt::format("the last stage reached its limit with {} spheres", n);
  } else if (target.is_open()) {
    packing.outcome = Outcome::converged;
    packing.reason = end == StageEnd::converged && !target.fill &&
                             table_of(packing.scene.stages.back()).traits.places_expected
                         ? fmt::format("{} spheres are placed, as many as were expected to fit", n)
                         : fmt::format("the stages of the scene place {} spheres and no more", n);
  } else {
    packing.outcome = Outcome::full;
    packing.reason =
        target.count
            ? fmt::format("{} of {} spheres are placed; the stages of the scene find no place for more", n,
                          grouped(static_cast<std::size_t>(*target.count)))
            : fmt::format(
                  "packing fraction {:.4f} of {} is reached with {} spheres; the stages of "
                  "the scene find no place for more",
                  packing.packing_fraction(), *target.packing_fraction, n);
  }
  if (supply.cut_off() > 0) {
    packing.reason += fmt::format(
        "; {} draws from the tail of the sizes were discarded because less than a hundredth of "
        "the container has room for such spheres",
        grouped(supply.cut_off()));
  }
  if (const std::size_t passed = supply.passed_over(); passed > 0) {
    packing.reason += fmt::format("; {} larger ones of the drawn sequence were passed over", grouped(passed));
  }
}

}  // namespace

void run_in_container(const Plan& plan, const Monitor& monitor, const Stopwatch& watch, Packing& packing) {
  const Domain& shape = plan.domain;
  const Frame frame = working_frame(plan);
  const Domain local = to_local(shape, frame);
  const std::unique_ptr<Container> container = make_container(local, plan.scene.walls, frame.resolution);
  const double unbounded = std::numeric_limits<double>::infinity();
  const double cut =
      plan.radii->max() < unbounded ? unbounded : radius_with_hardly_any_room(*container, packing.seed);
  Supply supply(*plan.radii, frame.scale, container->volume(), cut, plan.scene.target, packing.seed,
                *plan.scene.draw);
  require_fitting(plan.scene, shape, supply.largest() * frame.scale);

  EffectLog effects;
  Bed bed(*container, supply.smallest(), supply.largest(), supply.wanted(), effects);
  const Vector<3> up = Vector<3>::UnitZ();
  const auto milestone = [&](std::string_view stage) {
    const double fraction = bed.packing_fraction();
    packing.history.push_back({std::string(stage), bed.size(), fraction,
                               frame.scale * bed.potential(-up) + frame.origin[2], 0, watch.seconds()});
    const double share = plan.expected_packing_fraction > 0 ? fraction / plan.expected_packing_fraction : 0;
    monitor.report({stage, std::min(share, 0.99),
                    fmt::format("{} spheres, packing fraction {:.4f}", grouped(bed.size()), fraction)});
  };
  const auto crowd_milestone = [&](std::string_view stage, std::size_t spheres, double volume,
                                   double max_overlap, double done) {
    const double fraction = volume / container->volume();
    packing.history.push_back({std::string(stage), spheres, fraction, 0, max_overlap, watch.seconds()});
    const std::string overlap =
        max_overlap > 0 ? fmt::format(", largest overlap {:.1e}", max_overlap) : std::string();
    monitor.report(
        {stage, std::clamp(done, 0.0, 0.99),
         fmt::format("{} spheres, packing fraction {:.4f}{}", grouped(spheres), fraction, overlap)});
  };
  Work work{bed,       supply,          packing.seed,      monitor, effects,
            milestone, crowd_milestone, plan.scene.target, local,   plan.attainable_packing_fraction};

  StageEnd end = StageEnd::converged;
  for (const Stage& stage : plan.scene.stages) {
    end = run_stage(stage, work);
    milestone(stage.name());
    if (end == StageEnd::cancelled) break;
  }
  if (supply.passed_over() > 0 && supply.trimming_is_cheap()) bed.remove_tags_from(supply.first_missing());

  Spheres<3> spheres = bed.spheres();
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    spheres.set_center(i, frame.to_scene(spheres.center(i)));
    spheres.r[i] *= frame.scale;
  }
  packing.spheres = std::move(spheres);
  Effect& walls = effects["walls"];
  walls.calls += bed.wall_queries().calls;
  walls.seconds += bed.wall_queries().seconds;
  packing.effects = effects.all();
  conclude(packing, supply, end);
}

}  // namespace bernal

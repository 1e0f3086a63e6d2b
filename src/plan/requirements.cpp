#include "plan/requirements.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "plan/stages.hpp"

namespace bernal {

void require_stage_that_places(const Scene& scene) {
  if (scene.start.file || any_stage(scene, &StageTraits::only_moves, false)) return;
  throw Error(ErrorCode::bad_scene,
              "the stages only move spheres, and none places any: begin with \"insert\" or \"relax\"",
              scene.stages.front().locations.whole);
}

/// What is asked of the accuracy has an effect, or is refused.
void require_effect_of_accuracy(const Scene& scene) {
  const auto fail = [&](std::string_view key, std::string_view why) {
    throw Error(ErrorCode::bad_scene,
                fmt::format("\"{}\" in [accuracy] would be without effect: {}", key, why),
                scene.locations.of(key));
  };
  const auto leaves_overlap = [&](const Stage& stage) {
    const StageTraits& traits = table_of(stage).traits;
    return traits.leaves_overlap && !traits.stands_in_bed(scene);
  };
  if (scene.overlap > 0 && std::ranges::none_of(scene.stages, leaves_overlap))
    fail("overlap", "no stage of this scene leaves any overlap; \"relax\" and \"fly\" in periodic boxes can");
  if (scene.walls != WallArithmetic::filtered && !any_in_bed(scene))
    fail("walls", "no stage of this scene asks a container about its walls");
}

/// What is allowed to overlap has to have an effect on some stage, too, as it fills this box.
void require_overlap(const Plan& plan) {
  const Scene& scene = plan.scene;
  if (!(scene.overlap > 0)) return;
  for (const Stage& stage : scene.stages) {
    const StageEntry& entry = entry_of(stage);
    const StageTraits& traits = entry.table.traits;
    if (!traits.leaves_overlap || traits.stands_in_bed(scene)) continue;
    if (!entry.leaves_overlap || entry.leaves_overlap(entry.table.options(stage), fill_task_of(plan))) return;
  }
  throw Error(ErrorCode::bad_scene,
              "\"overlap\" in [accuracy] would be without effect: spheres that fly keep none; \"fly\" by "
              "\"relaxation\" or \"classes\" can, and so can \"relax\"",
              scene.locations.of("overlap"));
}

/// Throws where a stage has demands on containers that this one does not meet.
void require_fit_for_stages(const Plan& plan) {
  const double rarest = std::min(0.5, 1 / std::max(1.0, plan.expected_count));
  const double smallest = std::max(plan.radii->min(), plan.radii->quantile(rarest));
  for (const Stage& stage : plan.scene.stages) {
    const StageEntry& entry = entry_of(stage);
    if (!entry.require || !entry.table.traits.stands_in_bed(plan.scene)) continue;
    try {
      const Frame frame = frame_of(plan.domain);
      entry.require(entry.table.options(stage), to_local(plan.domain, frame), smallest / frame.scale,
                    fill_task_of(plan));
    } catch (const Error& error) {
      const Location at = stage.locations.of("direction");  // none of a stage that the scene does not name
      throw Error(error.code(), error.what(), at.line == 0 ? plan.scene.container.locations.whole : at);
    }
  }
}

}  // namespace bernal

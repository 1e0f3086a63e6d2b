#pragma once
#include <optional>
#include <span>

#include "bernal/plan/plan.hpp"
#include "work/stage_entry.hpp"

namespace bernal {

/// All stages, in the order in which people are told of them.
std::span<const StageEntry* const> stage_entries();

/// The one with these options. Throws Error{bad_scene} where there is none.
const StageEntry& entry_of(const Stage& stage);

/// How the stage presses spheres, if it does.
std::optional<Pressing> pressing_of(const Stage& stage);

/// Whether spheres stand in a bed for any stage of the scene.
bool any_in_bed(const Scene& scene);

/// What a stage that fills a box of given edges has to do, by the plan's box, sizes and target.
FillTask fill_task_of(const Plan& plan);

/// Whether any stage of the scene has the trait.
template <class Trait>
bool any_stage(const Scene& scene, Trait StageTraits::*trait, Trait value) {
  for (const Stage& stage : scene.stages)
    if (table_of(stage).traits.*trait == value) return true;
  return false;
}

}  // namespace bernal

#include "plan/stages.hpp"

#include <algorithm>
#include <array>

namespace bernal {

template <class... Options>
constexpr std::array<const StageEntry& (*)(), sizeof...(Options)> entries_of() {
  return {entry_of<Options>...};
}

/// A line a stage: the struct of its options, which its own file describes.
constexpr auto all_stages = entries_of<struct Insert,    //
                                       struct Settle,    //
                                       struct Compress,  //
                                       struct Shake,     //
                                       struct Refill,    //
                                       struct Relax,     //
                                       struct Grow,      //
                                       struct Fly        //
                                       >();

std::span<const StageEntry* const> stage_entries() {
  static const auto entries = [] {
    std::array<const StageEntry*, all_stages.size()> made;
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = &all_stages[k]();
    return made;
  }();
  return entries;
}

std::span<const StageTable* const> stage_tables() {
  static const auto tables = [] {
    std::array<const StageTable*, all_stages.size()> made;
    for (std::size_t k = 0; k < made.size(); ++k) made[k] = &stage_entries()[k]->table;
    return made;
  }();
  return tables;
}

const StageEntry& entry_of(const Stage& stage) {
  const StageTable& table = table_of(stage);
  for (const StageEntry* entry : stage_entries())
    if (&entry->table == &table) return *entry;
  throw Error(ErrorCode::bad_scene, "these are the options of no stage", stage.locations.whole);
}

std::optional<Pressing> pressing_of(const Stage& stage) {
  const StageEntry& entry = entry_of(stage);
  if (!entry.pressing) return {};
  return entry.pressing(entry.table.options(stage));
}

Vector<3> down_in(const Scene& scene) {
  Vector<3> down = -Vector<3>::Unit(scene.dimension() - 1);
  for (const Stage& stage : scene.stages)
    if (const auto pressed = pressing_of(stage)) down = pressed->direction;
  return down;
}

BedOptions bed_options_of(const Scene& scene) {
  const bool ends_settled = !scene.stages.empty() && pressing_of(scene.stages.back()).has_value();
  return {.direction = down_in(scene), .is_bed = ends_settled, .friction = scene.target.bed.friction()};
}

bool any_in_bed(const Scene& scene) {
  return std::ranges::any_of(scene.stages,
                             [&](const Stage& stage) { return table_of(stage).traits.stands_in_bed(scene); });
}

}  // namespace bernal

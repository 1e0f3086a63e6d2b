#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "bernal/run/packing.hpp"
#include "scene/stage_table.hpp"
#include "work/work.hpp"

namespace bernal {

/// All that there is to know of a stage. Each defines its own beside its act, as entry_of<Its options>().
struct StageEntry {
  StageTable table;
  /// What it does on spheres that stand in a bed, and in a box; empty where it cannot.
  std::function<StageEnd(const void*, Work&)> act_in_bed = {}, act_in_box = {};
  /// Effects that it may bring with it there, for `Plan::items`.
  std::vector<PlanItem> bed_effects = {}, box_effects = {};
  /// Those of box_effects that the plan calls for, where that is a choice. Throws Error{bad_argument}
  /// where the options ask for what cannot be done.
  std::function<std::vector<PlanItem>(const void*, const FillTask&)> chosen_effects = {};
  /// In a bed: throws Error{bad_scene} where a container, in the packer's coordinates, is none for it and
  /// spheres of that radius.
  std::function<void(const void*, const Domain&, double smallest_radius, const FillTask&)> require = {};
  /// Of one that may leave overlap, whether it does with these options.
  std::function<bool(const void*, const FillTask&)> leaves_overlap = {};
  /// Of a stage that reaches what its options say: that packing fraction.
  std::function<double(const void*)> reached = {};
};

template <class Options>
const StageEntry& entry_of();

inline const PlanItem neighbor_lists{"neighbour lists", "of all spheres together, from the background grid",
                                     "O(N) an iteration"};

/// The part of an entry that its scenes need.
template <class Options>
StageTable stage_table(schema::Entry keys, StageTraits traits) {
  return {schema::entry<Options>(std::move(keys)), traits, [] { return Stage(Options{}); },
          [](const Stage& stage) -> const void* { return stage.as<Options>(); }};
}

/// A function of a stage's options as one of a struct whose type is known to its entry.
template <class Result, class Options, class... Context>
auto of_options(Result (*function)(const Options&, Context...)) {
  return [function](const void* options, Context... context) -> Result {
    return function(*static_cast<const Options*>(options), std::forward<Context>(context)...);
  };
}
template <class Options>
auto act(StageEnd (*function)(Work&, const Options&)) {
  return [function](const void* options, Work& work) {
    return function(work, *static_cast<const Options*>(options));
  };
}

}  // namespace bernal

#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bernal/scene/packing.hpp"
#include "scene/stage_table.hpp"
#include "work/pressing.hpp"
#include "work/reporter.hpp"
#include "work/spheres_in_bed.hpp"
#include "work/spheres_in_box.hpp"
#include "work/task.hpp"

namespace bernal {

/// What stands around spheres that a stage makes denser than they are by themselves.
struct WallsAround {
  bool has_walls = false;
  bool in_bed = false;
  bool is_round = true;  ///< in a bed: some walls may be
  /// In a bed: the volume within the walls, in mean volumes of a sphere.
  double volume_in_spheres = std::numeric_limits<double>::infinity();
};

/// What a stage is expected to meet: all that the price of its effects depends on.
struct Outlook {
  FillTask task;
  bool in_bed = false;
  bool placed = false;     ///< stages before it have given all spheres places
  double filled = 0;       ///< packing fraction in the bed that stages before it are likely to leave
  double spheres = 0;      ///< expected in the end
  double aim = 0;          ///< packing fraction, expected in the end
  double gain = 1;         ///< of that, by stages that make denser packings than sizes reach by themselves
  double spread = 1;       ///< mean of r³ over that of r, cubed: 1 for equal spheres
  Coordinates size = {};   ///< edges of the bounds, in mean diameters
  double at_walls = 0;     ///< share of the spheres that touch or nearly touch a wall
  double wall_query = 0;   ///< seconds that a question to the walls takes; 0 without walls
  bool is_filled = false;  ///< as many as can be placed are asked for, at any price
};

/// Where spheres are placed one after the other and stay: what decides how densely.
struct EmptyBed {
  int dimension = 3;
  double relaxed = 0;     ///< packing fraction that relaxation would reach there
  double wall_share = 0;  ///< area of the wall times the mean diameter, over the volume
  double largest = 0;     ///< radius, in the scene's unit
  double evenness = 1;    ///< mean volume of a sphere over that of the largest: 1 for equal spheres
  /// Of the container's volume, where the scene says how high the bed is: the rest is of that part.
  double share = 1;
};

/// All that there is to know of a stage. Each defines its own beside its act, as entry_of<Its options>().
struct StageEntry {
  StageTable table;
  /// What it does on spheres that stand in a bed, and in a box; empty where it cannot.
  std::function<StageEnd(const void*, SpheresInBed&, Reporter&)> act_in_bed = {};
  std::function<StageEnd(const void*, SpheresInBox&, Reporter&)> act_in_box = {};
  /// Names of all effects that it may bring with it anywhere: those that a plan does not call for are absent.
  std::vector<std::string> may_bring = {};
  /// Those that it brings with it there, with what they are expected to cost. Throws Error{bad_argument}
  /// where the options ask for what cannot be done.
  std::function<std::vector<PlanItem>(const void*, const Outlook&)> effects = {};
  /// Of one that presses spheres along a direction: how.
  std::function<Pressing(const void*)> pressing = {};
  /// In a bed: throws Error{bad_scene} where a container, in the packer's coordinates, is none for it and
  /// spheres of that radius.
  std::function<void(const void*, const Domain&, double smallest_radius, const FillTask&)> require = {};
  /// Of one that may leave overlap, whether it does with these options.
  std::function<bool(const void*, const FillTask&)> leaves_overlap = {};
  /// Of a stage that reaches what its options say and no more: that packing fraction.
  std::function<double(const void*)> reached = {};
  /// Of one that makes denser packings of these sizes than they reach by themselves: by which factor.
  std::function<double(const void*, const SizeDistribution& radii, int dimension, const WallsAround&)> gain =
      {};
  /// Of one that places spheres which then stay: the packing fraction at which no more find room.
  std::function<double(const void*, const EmptyBed&)> full = {};
};

template <class Options>
const StageEntry& entry_of();

/// Lists of neighbours that are a part of what another effect costs.
inline PlanItem neighbor_lists(double seconds, double bytes) {
  return {.name = "neighbour lists",
          .what = "of all spheres together, from the background grid",
          .cost = "O(N) an iteration",
          .seconds = seconds,
          .bytes = bytes,
          .part = true};
}

/// So many questions of each sphere to the walls, a part of what another effect costs.
inline PlanItem questions_to_walls(double each, const Outlook& outlook) {
  return {.name = "walls",
          .what = {},
          .cost = {},
          .seconds = each * outlook.spheres * outlook.wall_query,
          .part = true};
}

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

}  // namespace bernal

#pragma once
#include <span>
#include <string_view>

#include "scene/entry.hpp"

namespace bernal {

/// What a packing can be expected to reach with a stage.
enum class Reaches {
  nothing,        ///< of its own
  insertion,      ///< its option packing_fraction
  settled,        ///< that of a settled bed
  close_packing,  ///< that of random close packing
};

/// What a stage needs and promises, so that nobody asks for its name.
struct StageTraits {
  bool in_bed = false;    ///< it works on spheres that stand in a bed: in containers and between fixed walls
  bool in_box = false;    ///< it works on spheres that stand in a box: in periodic boxes
  bool in_plane = false;  ///< in a bed of two dimensions, too
  bool box_between_walls = false;  ///< in a box that ends at walls along some axes, too
  bool in_tilted_box = false;      ///< in a tilted periodic box, too
  bool in_repeated_mesh = false;   ///< in the bed of a mesh that repeats itself, too
  bool prefers_bed = false;        ///< of one that works in both: where walls are fixed it takes the bed
  int least_dimension = 1, most_dimensions = max_dimension;  ///< of boxes
  bool keeps_sizes = false;      ///< in a bed the sizes stay exactly as they are drawn
  bool places_expected = false;  ///< in a bed it places as many spheres as are expected to fit
  bool leaves_overlap = false;   ///< in a box it may leave as much overlap as [accuracy] allows
  bool fills_given_box = false;  ///< it needs a box of given size and the end that it is filled to
  bool only_moves = false;       ///< it places no sphere
  bool frees_bed = false, frees_box = false;  ///< it may begin with spheres that overlap there
  bool joins_start = false;          ///< in a box it finds others their places among those that have some
  bool is_default = false;           ///< it packs a scene that names no stage
  bool is_default_in_plane = false;  ///< it is one of those that do in containers of two dimensions
  bool makes_bed = false;  ///< it makes the bed that a scene asks for, and where that names no stage
  Reaches reaches = Reaches::nothing;

  /// Whether spheres stand in a bed for it there: in every container, and in a periodic box of three
  /// dimensions and given size that ends at walls, unless it rather has them in a box.
  bool stands_in_bed(const Scene& scene) const;
  bool works_in(const Scene& scene) const;
};

/// A stage as a scene knows it: its keys and the plain struct that they fill.
struct StageTable {
  schema::Entry keys;
  StageTraits traits;
  Stage (*make)();                       ///< with its defaults
  const void* (*options)(const Stage&);  ///< of that stage; null of another

  std::string_view name() const { return keys.name; }
  void* options_of(Stage& stage) const { return const_cast<void*>(options(stage)); }
};

/// All of them, in the order in which people are told of them; plan/stages.cpp holds the list.
std::span<const StageTable* const> stage_tables();

/// Throws Error{bad_scene} for options that no stage has.
const StageTable& table_of(const Stage& stage);

/// A stage of a scene as its errors name it.
inline schema::Section section_of(const Stage& stage, const StageTable& table) {
  return {"[[stage]] " + std::string(table.name()), stage.locations};
}

}  // namespace bernal

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
  bool in_containers = false;      ///< it works between walls all around, and in endless columns
  bool in_periodic_boxes = false;  ///< it works in periodic boxes
  bool between_walls = false;      ///< those may end at walls along some axes
  int least_dimension = 1, most_dimensions = max_dimension;  ///< of periodic boxes
  bool keeps_sizes = false;      ///< in a container the sizes stay exactly as they are drawn
  bool places_expected = false;  ///< in a container it places as many spheres as are expected to fit
  bool fills_given_box = false;  ///< it needs a box of given size and the end that it is filled to
  bool is_default = false;       ///< it packs a scene that names no stage
  Reaches reaches = Reaches::nothing;

  bool works_in(const Scene& scene) const { return scene.is_periodic() ? in_periodic_boxes : in_containers; }
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

/// All of them, in the order in which people are told of them; run/ holds the list.
std::span<const StageTable* const> stage_tables();

/// Throws Error{bad_scene} for options that no stage has.
const StageTable& table_of(const Stage& stage);

/// A stage of a scene as its errors name it.
inline schema::Section section_of(const Stage& stage, const StageTable& table) {
  return {"[[stage]] " + std::string(table.name()), stage.locations};
}

}  // namespace bernal

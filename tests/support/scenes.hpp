#pragma once
#include <algorithm>
#include <filesystem>
#include <vector>

#include "bernal/scene/read_scene.hpp"

namespace bernal::testing {

/// Every scene of data/scenes, by name.
inline std::vector<std::filesystem::path> example_scenes() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(BERNAL_DATA "/scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// The scene with at most `count` spheres, unless they are listed one by one: everything of it runs, in a
/// blink.
inline Scene small(Scene scene, std::int64_t count = 300) {
  if (const ListedSizes* list = each_once(scene.sizes))
    count = static_cast<std::int64_t>(list->values.size());
  // In a box that follows from both, its packing fraction goes with the count.
  const auto* its_box = std::get_if<PeriodicBox>(&scene.container);
  const bool scalable = its_box && its_box->scalable;
  BedTarget bed = scene.target.bed;
  if (bed.gives_height()) {
    bed.height = bed.layers = std::nullopt;
    if (!bed.porosity && !bed.density) bed.density = BedTarget::Density::poured;
  }
  scene.target = {.count = count,
                  .packing_fraction = scalable ? scene.target.packing_fraction : std::nullopt,
                  .fill = false,
                  .bed = bed,
                  .where = scene.target.where};
  return scene;
}

}  // namespace bernal::testing

#include "scene/sphere_matter.hpp"

#include <algorithm>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"

namespace bernal {

std::vector<std::vector<SphereMatter>> matter_by_class(const Scene& scene) {
  std::vector<SphereClass> classes = classes_of(scene);
  if (classes.empty()) classes.push_back({"spheres", scene.material, scene.material_density});
  const std::vector<std::vector<Layer>> layers = layers_by_class(scene);
  std::vector<std::vector<SphereMatter>> all(classes.size());
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (c < layers.size())
      for (const Layer& layer : layers[c])
        all[c].push_back({layer.name, material_of(layer), layer.material_density, true});
    if (all[c].empty())
      all[c].push_back({classes[c].name, material_of(classes[c]), classes[c].material_density, false});
  }
  return all;
}

bool layers_have_densities(const Scene& scene) {
  if (!has_layers(scene)) return false;
  for (const std::vector<SphereMatter>& of_class : matter_by_class(scene))
    for (const SphereMatter& matter : of_class)
      if (!matter.density) return false;
  return true;
}

std::vector<std::string> materials_of(const Scene& scene) {
  std::vector<std::string> materials;
  for (const std::vector<SphereMatter>& of_class : matter_by_class(scene))
    for (const SphereMatter& matter : of_class)
      if (std::ranges::find(materials, matter.material) == materials.end())
        materials.push_back(matter.material);
  return materials;
}

}  // namespace bernal

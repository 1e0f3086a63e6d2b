#include "bernal/scene/layer_amounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"

namespace bernal {
namespace {

double ball(double radius) { return 4.0 / 3 * std::numbers::pi * radius * radius * radius; }

/// Between two spheres of one centre, without the difference of two large numbers.
double shell(double inner, double outer) {
  return 4.0 / 3 * std::numbers::pi * (outer - inner) * (outer * outer + outer * inner + inner * inner);
}

/// Adds what is of one material; a mass that is unknown stays so.
void add(std::vector<MaterialAmount>& materials, const std::string& name, double volume,
         const std::optional<double>& mass) {
  const auto found = std::ranges::find(materials, name, &MaterialAmount::name);
  if (found == materials.end()) {
    materials.push_back({name, volume, 0, mass});
    return;
  }
  found->volume += volume;
  found->mass = found->mass && mass ? std::optional(*found->mass + *mass) : std::nullopt;
}

}  // namespace

LayerAmounts layer_amounts(const Packing& packing) {
  LayerAmounts made;
  const SphereLayers layers = layers_of(packing);
  if (layers.of_class.empty()) return made;
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  const std::size_t n = packing.spheres.size();
  std::vector<std::size_t> begin;  // of each class, in `made.layers`
  for (std::size_t k = 0; k < layers.of_class.size(); ++k) {
    begin.push_back(made.layers.size());
    for (const Layer& layer : layers.of_class[k])
      made.layers.push_back({.of_class = classes[k].name,
                             .name = layer.name,
                             .material = material_of(layer),
                             .material_density = layer.material_density});
  }
  std::vector<double> bare(layers.of_class.size(), 0);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = packing.classes.empty() ? 0 : packing.classes[i];
    if (layers.of_class[k].empty()) bare[k] += ball(packing.spheres.r[i]);
    double inner = 0;
    std::size_t at = begin[k];
    for (const double outer : layers.of(i)) {
      made.layers[at].volume += shell(inner, outer);
      ++made.layers[at++].spheres;
      inner = outer;
    }
  }
  const double cubic_metres = std::pow(metres_per(packing.scene.unit), 3);
  const auto mass = [&](const std::optional<double>& density, double volume) {
    return density ? std::optional(*density * volume * cubic_metres) : std::nullopt;
  };
  for (LayerAmount& layer : made.layers) {
    layer.packing_fraction = packing.volume > 0 ? layer.volume / packing.volume : 0;
    layer.mass = mass(layer.material_density, layer.volume);
    add(made.materials, layer.material, layer.volume, layer.mass);
  }
  for (std::size_t k = 0; k < bare.size(); ++k)
    if (bare[k] > 0)
      add(made.materials, material_of(classes[k]), bare[k], mass(classes[k].material_density, bare[k]));
  for (MaterialAmount& material : made.materials)
    material.packing_fraction = packing.volume > 0 ? material.volume / packing.volume : 0;
  return made;
}

}  // namespace bernal

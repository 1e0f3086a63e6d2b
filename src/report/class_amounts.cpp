#include "report/class_amounts.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/sphere_layers.hpp"

namespace bernal {

std::vector<ClassAmount> class_amounts(const Packing& packing) {
  std::vector<ClassAmount> amounts;
  if (packing.classes.empty() || !(packing.volume > 0)) return amounts;
  for (SphereClass& of : classes_of(packing.scene)) amounts.push_back({.of = std::move(of)});
  const int dimension = packing.spheres.dimension();
  for (std::size_t i = 0; i < packing.classes.size(); ++i) {
    ClassAmount& amount = amounts[packing.classes[i]];
    ++amount.spheres;
    amount.packing_fraction += ball_volume(dimension, packing.spheres.r[i]) / packing.volume;
  }
  const double cubic_metres = packing.volume * std::pow(metres_per(packing.scene.unit), 3);
  std::vector<std::optional<double>> masses(amounts.size());
  if (has_layers(packing.scene) || !packing.inside.empty()) masses = masses_by_class(packing);
  const auto layers = layers_by_class(packing.scene);
  for (std::size_t c = 0; c < amounts.size(); ++c) {
    const bool is_filled =
        std::ranges::find(packing.inside, c, &PackingsInside::of_class) != packing.inside.end();
    const bool has_layers = c < layers.size() && !layers[c].empty();
    ClassAmount& amount = amounts[c];
    if (dimension != 3) continue;
    // A density that is said of spheres with layers is that of the whole; else it is that of their matter.
    if (amount.of.material_density && (has_layers || !is_filled))
      amount.mass = *amount.of.material_density * amount.packing_fraction * cubic_metres;
    else
      amount.mass = masses[c];
  }
  return amounts;
}

}  // namespace bernal

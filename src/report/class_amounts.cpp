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
  for (std::size_t c = 0; c < amounts.size(); ++c) {
    const bool is_filled =
        std::ranges::find(packing.inside, c, &PackingsInside::of_class) != packing.inside.end();
    ClassAmount& amount = amounts[c];
    if (dimension != 3) continue;
    amount.mass = masses[c];
    if (!amount.mass && amount.of.material_density && !is_filled)  // of the whole spheres
      amount.mass = *amount.of.material_density * amount.packing_fraction * cubic_metres;
  }
  return amounts;
}

}  // namespace bernal

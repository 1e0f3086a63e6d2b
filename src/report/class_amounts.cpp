#include "report/class_amounts.hpp"

#include <cmath>

#include "bernal/core/dimension.hpp"

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
  for (ClassAmount& amount : amounts)
    if (dimension == 3 && amount.of.material_density)
      amount.mass = *amount.of.material_density * amount.packing_fraction * cubic_metres;
  return amounts;
}

}  // namespace bernal

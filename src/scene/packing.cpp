#include "bernal/scene/packing.hpp"

#include <cmath>

#include "bernal/core/dimension.hpp"

namespace bernal {

std::string_view name_of(Outcome outcome) {
  constexpr std::string_view names[] = {"converged", "loose", "full", "hit_limit", "cancelled", "imported"};
  return names[static_cast<std::size_t>(outcome)];
}

std::optional<double> mass_of(const Packing& packing, double packing_fraction) {
  const std::optional<double>& density = packing.scene.material_density;
  if (!density || packing.scene.dimension() != 3) return std::nullopt;
  return *density * packing_fraction * packing.volume * std::pow(metres_per(packing.scene.unit), 3);
}

double Packing::packing_fraction() const {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(spheres.dimension(), r);
  return volume > 0 ? sum / volume : 0;
}

}  // namespace bernal

#include "bernal/scene/packing.hpp"

#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"

namespace bernal {

std::string_view name_of(Outcome outcome) {
  constexpr std::string_view names[] = {"converged", "loose", "full", "hit_limit", "cancelled", "imported"};
  return names[static_cast<std::size_t>(outcome)];
}

namespace {

/// The mean density of the spheres by volume, where all that they are made of have one.
std::optional<double> density_of_matter(const Packing& packing) {
  double mass = 0, volume = 0;
  for (const MaterialAmount& material : layer_amounts(packing).materials) {
    if (!material.mass) return std::nullopt;
    mass += *material.mass;
    volume += material.volume;
  }
  return volume > 0 ? std::optional(mass / (volume * std::pow(metres_per(packing.scene.unit), 3)))
                    : std::nullopt;
}

/// The mean density of the spheres by volume.
std::optional<double> density_of(const Packing& packing) {
  if (has_layers(packing.scene) || !packing.inside.empty()) {
    const std::optional<double> known = density_of_matter(packing);
    if (known || !packing.inside.empty()) return known;
    if (packing.scene.material_density) return packing.scene.material_density;  // of the whole spheres
    return std::nullopt;
  }
  if (packing.scene.zones.empty()) return packing.scene.material_density;
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  double mass = 0, volume = 0;
  for (std::size_t i = 0; i < packing.classes.size(); ++i) {
    const std::optional<double>& density = classes[packing.classes[i]].material_density;
    if (!density) return std::nullopt;
    const double of_sphere = std::pow(packing.spheres.r[i], 3);
    mass += *density * of_sphere;
    volume += of_sphere;
  }
  return volume > 0 ? std::optional(mass / volume) : std::nullopt;
}

}  // namespace

std::optional<double> mass_of(const Packing& packing, double packing_fraction) {
  const std::optional<double> density = density_of(packing);
  if (!density || packing.scene.dimension() != 3) return std::nullopt;
  return *density * packing_fraction * packing.volume * std::pow(metres_per(packing.scene.unit), 3);
}

double Packing::packing_fraction() const {
  double sum = 0;
  for (const double r : spheres.r) sum += ball_volume(spheres.dimension(), r);
  return volume > 0 ? sum / volume : 0;
}

}  // namespace bernal

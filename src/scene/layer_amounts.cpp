#include "bernal/scene/layer_amounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal {
namespace {

/// Between two spheres of one centre, without the difference of two large numbers.
double shell(double inner, double outer) {
  return 4.0 / 3 * std::numbers::pi * (outer - inner) * (outer * outer + outer * inner + inner * inner);
}

std::optional<double> sum_of(const std::optional<double>& a, const std::optional<double>& b) {
  return a && b ? std::optional(*a + *b) : std::nullopt;
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
  found->mass = sum_of(found->mass, mass);
}

/// What there is of a layer, or of spheres without any; the volume is that of the ball or shell, the mass
/// that of all in it.
struct PartAmount {
  SphereMatter matter;
  std::uint64_t spheres = 0;
  double volume = 0;
  std::optional<double> mass = {};
};

/// All of a packing, with what lies inside of its spheres, in its unit.
struct WholeAmount {
  std::vector<std::vector<PartAmount>> of_class;
  std::vector<MaterialAmount> materials;
  double volume = 0;  ///< of its spheres
};

WholeAmount whole_amount(const Packing&);

/// Of what lies inside the spheres of a class, in the unit of these: each packing as often as it stands.
struct InsideAmount {
  double volume = 0;
  std::optional<double> mass = 0;
  std::vector<MaterialAmount> materials = {};
};

InsideAmount inside_amount(const PackingsInside& inside, Unit around) {
  std::vector<double> uses(inside.templates.size(), 0);
  for (const std::uint32_t t : inside.which) ++uses[t];
  InsideAmount sum;
  for (std::size_t t = 0; t < uses.size(); ++t) {
    const Packing& packing = *inside.templates[t];
    const WholeAmount one = whole_amount(packing);
    const double volumes = uses[t] * std::pow(conversion_factor(packing.scene.unit, around), 3);
    sum.volume += volumes * one.volume;
    for (const MaterialAmount& of : one.materials) {
      const std::optional<double> mass = of.mass ? std::optional(uses[t] * *of.mass) : std::nullopt;
      add(sum.materials, of.name, volumes * of.volume, mass);
      sum.mass = sum_of(sum.mass, mass);
    }
  }
  return sum;
}

/// The balls and shells of all spheres, each class's by itself, with nothing in them.
WholeAmount solid_amount(const Packing& packing) {
  WholeAmount made;
  for (std::vector<SphereMatter>& of_class : matter_by_class(packing.scene)) {
    std::vector<PartAmount>& parts = made.of_class.emplace_back();
    for (SphereMatter& matter : of_class) parts.push_back({.matter = std::move(matter)});
  }
  const SphereLayers layers = layers_of(packing);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    std::vector<PartAmount>& parts = made.of_class[packing.classes.empty() ? 0 : packing.classes[i]];
    const std::span<const double> outer =
        parts.front().matter.is_layer ? layers.of(i) : std::span(&packing.spheres.r[i], 1);
    double inner = 0;
    for (std::size_t k = 0; k < outer.size(); ++k) {
      parts[k].volume += shell(inner, outer[k]);
      ++parts[k].spheres;
      inner = outer[k];
    }
    made.volume += shell(0, inner);
  }
  return made;
}

WholeAmount whole_amount(const Packing& packing) {
  WholeAmount made = solid_amount(packing);
  std::vector<std::vector<double>> matrix;  // what is left of each part around the spheres in it
  for (const auto& parts : made.of_class) {
    std::vector<double>& of_class = matrix.emplace_back();
    for (const PartAmount& part : parts) of_class.push_back(part.volume);
  }
  std::vector<InsideAmount> insides;
  for (const PackingsInside& inside : packing.inside) {
    insides.push_back(inside_amount(inside, packing.scene.unit));
    matrix[inside.of_class][inside.layer] -= insides.back().volume;
  }
  const double cubic_metres = std::pow(metres_per(packing.scene.unit), 3);
  const auto add_parts = [&](bool of_layers) {
    for (std::size_t c = 0; c < made.of_class.size(); ++c)
      for (std::size_t k = 0; k < made.of_class[c].size(); ++k) {
        PartAmount& part = made.of_class[c][k];
        const SphereMatter& of = part.matter;
        if (of.is_layer != of_layers) continue;
        if (of.density) part.mass = *of.density * matrix[c][k] * cubic_metres;
        if (of_layers || part.volume > 0) add(made.materials, of.material, matrix[c][k], part.mass);
      }
  };
  add_parts(true);
  add_parts(false);
  for (std::size_t k = 0; k < insides.size(); ++k) {
    PartAmount& part = made.of_class[packing.inside[k].of_class][packing.inside[k].layer];
    part.mass = sum_of(part.mass, insides[k].mass);
    for (const MaterialAmount& of : insides[k].materials) add(made.materials, of.name, of.volume, of.mass);
  }
  return made;
}

}  // namespace

LayerAmounts layer_amounts(const Packing& packing) {
  LayerAmounts made;
  if (!has_layers(packing.scene) && packing.inside.empty()) return made;
  WholeAmount whole = whole_amount(packing);
  const auto fraction = [&](double volume) { return packing.volume > 0 ? volume / packing.volume : 0; };
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  for (std::size_t c = 0; c < classes.size(); ++c)
    for (const PartAmount& part : whole.of_class[c])
      if (part.matter.is_layer)
        made.layers.push_back({.of_class = classes[c].name,
                               .name = part.matter.name,
                               .material = part.matter.material,
                               .material_density = part.matter.density,
                               .spheres = part.spheres,
                               .volume = part.volume,
                               .packing_fraction = fraction(part.volume),
                               .mass = part.mass});
  made.materials = std::move(whole.materials);
  for (MaterialAmount& of : made.materials) of.packing_fraction = fraction(of.volume);
  return made;
}

std::vector<std::optional<double>> masses_by_class(const Packing& packing) {
  std::vector<std::optional<double>> masses;
  for (const std::vector<PartAmount>& parts : whole_amount(packing).of_class) {
    std::optional<double>& mass = masses.emplace_back(0);
    for (const PartAmount& part : parts) mass = sum_of(mass, part.mass);
  }
  return masses;
}

}  // namespace bernal

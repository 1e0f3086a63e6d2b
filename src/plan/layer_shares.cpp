#include "bernal/plan/layer_shares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/size_kinds.hpp"
#include "scene/sphere_matter.hpp"

namespace bernal {
namespace {

constexpr int interval_count = 400, points_of_lattice = 4096;

/// Spheres of a size, and what they carry of the volume of all.
struct SizeShare {
  double radius, share;
};

/// Intervals of equal numbers, the last one halved again and again, since a tail carries volume.
std::vector<SizeShare> sizes_of(const SizeDistribution& radii) {
  const double all = radii.moment(3);
  if (const std::vector<double> atoms = radii.atoms(); !atoms.empty()) {
    std::vector<SizeShare> exact;
    double sum = 0;
    for (const double r : atoms) {
      const double number = radii.cumulative(r * (1 + 1e-12)) - radii.cumulative(r * (1 - 1e-12));
      exact.push_back({r, number * r * r * r / all});
      sum += exact.back().share;
    }
    if (std::abs(sum - 1) < 1e-9) return exact;
  }
  std::vector<double> limits = {0};
  for (int k = 1; k < interval_count; ++k)
    limits.push_back(radii.quantile(static_cast<double>(k) / interval_count));
  for (double above = 0.5 / interval_count; above > 1e-15; above *= 0.7)
    limits.push_back(radii.quantile(1 - above));
  std::vector<SizeShare> some;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    const bool last = k + 1 == limits.size();
    const auto in = [&](int moment) {
      return radii.moment_above(moment, limits[k]) - (last ? 0 : radii.moment_above(moment, limits[k + 1]));
    };
    const double volume = in(3);
    if (volume > 1e-15 * all) some.push_back({in(4) / volume, volume / all});
  }
  return some;
}

/// Drawn thicknesses, one list for each point of a lattice.
std::vector<std::vector<double>> thicknesses_of(const std::vector<Layer>& layers) {
  std::vector<const Normal*> drawn;
  for (const Layer& layer : layers)
    if (layer.thickness && layer.thickness->sd > 0) drawn.push_back(&*layer.thickness);
  if (drawn.empty()) return {{}};
  // Even along the first axis; along the d others steps of the R-sequence (Roberts 2018): powers of one over
  // the root of x^(d+1) = x + 1.
  double root = 1.5;
  const auto d = static_cast<double>(drawn.size() - 1);
  for (int k = 0; k < 60; ++k) root = std::pow(1 + root, 1 / (d + 1));
  std::vector<std::vector<double>> all(points_of_lattice);
  for (std::size_t axis = 0; axis < drawn.size(); ++axis) {
    const double step = axis == 0 ? 1.0 / points_of_lattice : std::pow(root, -static_cast<double>(axis));
    for (int k = 0; k < points_of_lattice; ++k) {
      const double u = (k + 0.5) * step;
      all[static_cast<std::size_t>(k)].push_back(
          thickness_at(*drawn[axis], std::clamp(u - std::floor(u), 1e-12, 1 - 1e-12)));
    }
  }
  return all;
}

/// Of the volume of these spheres, what each layer takes.
std::vector<double> shares_of(const std::vector<Layer>& layers, const std::vector<SizeShare>& sizes,
                              const Location& where) {
  const std::vector<std::vector<double>> thicknesses = thicknesses_of(layers);
  std::vector<double> shares(layers.size(), 0), outer(layers.size());
  for (const auto& [radius, share] : sizes)
    for (const std::vector<double>& thickness : thicknesses) {
      const std::string wrong = place_layers(layers, radius, thickness, outer);
      if (!wrong.empty())
        throw Error(ErrorCode::bad_scene,
                    fmt::format("the layers of a sphere of radius {:.6g}: {}", radius, wrong), where);
      double inner = 0;
      for (std::size_t k = 0; k < layers.size(); ++k) {
        const double ends = std::pow(outer[k] / radius, 3);
        shares[k] += share * (ends - inner) / static_cast<double>(thicknesses.size());
        inner = ends;
      }
    }
  return shares;
}

/// Of the volume of all spheres, what each layer takes, or the spheres of a class without any: class by class
/// as in `matter_by_class`.
std::vector<std::vector<double>> matter_shares(const Scene& scene) {
  if (!scene.zones.empty())
    throw Error(ErrorCode::bad_scene, "the layers of zones follow from what is packed: see bernal measure",
                scene.zones.front().locations.whole);
  const Location& where = scene.locations.of("layers");
  std::vector<std::vector<Layer>> layers = layers_by_class(scene);
  layers.resize(matter_by_class(scene).size());
  const auto* sizes = std::get_if<Classes>(&scene.sizes);
  if (!sizes || layers.size() != sizes->values.size()) {
    if (layers.front().empty()) return {{1.0}};
    return {shares_of(layers.front(), sizes_of(*radii_of(scene)), where)};
  }
  const double unit = scene.scale * (scene.sizes_are_diameters ? 0.5 : 1);
  std::vector<double> volumes = shares_of_one_density(*sizes);
  for (std::size_t k = 0; k < volumes.size(); ++k)
    if (sizes->basis == Basis::number) volumes[k] *= std::pow(sizes->values[k], 3);
  const double sum = std::accumulate(volumes.begin(), volumes.end(), 0.0);
  std::vector<std::vector<double>> all;
  for (std::size_t k = 0; k < layers.size(); ++k)
    all.push_back(layers[k].empty()
                      ? std::vector{volumes[k] / sum}
                      : shares_of(layers[k], {{unit * sizes->values[k], volumes[k] / sum}}, where));
  return all;
}

double cubic_metres_of(const Plan& plan) {
  return plan.expected_packing_fraction * volume_of(plan.domain) * std::pow(metres_per(plan.scene.unit), 3);
}

}  // namespace

std::vector<LayerShare> layer_shares(const Scene& scene) {
  std::vector<LayerShare> all;
  if (!has_layers(scene)) return all;
  const std::vector<std::vector<double>> shares = matter_shares(scene);
  const std::vector<std::vector<SphereMatter>> matter = matter_by_class(scene);
  const std::vector<SphereClass> classes = classes_of(scene);
  for (std::size_t c = 0; c < matter.size(); ++c)
    for (std::size_t k = 0; k < matter[c].size(); ++k)
      if (matter[c][k].is_layer)
        all.push_back({classes[c].name, matter[c][k].name, matter[c][k].material, shares[c][k]});
  return all;
}

std::optional<double> expected_mass(const Plan& plan) {
  const Scene& scene = plan.scene;
  if (scene.dimension() != 3 || !scene.zones.empty()) return std::nullopt;
  const double volume = cubic_metres_of(plan);
  if (has_layers(scene) && scene.inside.empty() && !layers_have_densities(scene))
    return scene.material_density ? std::optional(*scene.material_density * volume) : std::nullopt;
  std::vector<std::vector<double>> volumes;
  try {
    volumes = matter_shares(scene);
  } catch (const Error&) {  // a size that is hardly ever drawn has no room for its layers
    return std::nullopt;
  }
  for (std::vector<double>& of_class : volumes)
    for (double& of : of_class) of *= volume;
  double mass = 0;
  for (const PlannedInside& inside : plan.insides) {
    const std::optional<double> held = expected_mass(inside.plan);
    if (!held) return std::nullopt;
    mass += inside.filled * *held;
    volumes[inside.of_class][inside.layer] -= inside.filled * cubic_metres_of(inside.plan);
  }
  const std::vector<std::vector<SphereMatter>> matter = matter_by_class(scene);
  for (std::size_t c = 0; c < matter.size(); ++c)
    for (std::size_t k = 0; k < matter[c].size(); ++k) {
      if (!matter[c][k].density) return std::nullopt;
      mass += *matter[c][k].density * volumes[c][k];
    }
  return mass;
}

std::vector<LayerShare> by_material(const std::vector<LayerShare>& layers) {
  std::vector<LayerShare> all;
  for (const LayerShare& layer : layers) {
    const auto same = std::ranges::find(all, layer.material, &LayerShare::material);
    if (same == all.end())
      all.push_back({{}, {}, layer.material, layer.share});
    else
      same->share += layer.share;
  }
  return all;
}

}  // namespace bernal

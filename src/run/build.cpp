#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "bernal/predict/predict.hpp"
#include "run/catalogue.hpp"
#include "run/fitting.hpp"

namespace bernal {
namespace {

/// What compression reaches of the random close packing fraction of the same sizes, away from walls, and by
/// how much a wall lowers it: measured, see `expected_packing_fraction`.
constexpr double share_of_close_packing = 0.966;
constexpr double wall_deficit = 0.33;
/// Bytes a sphere takes in the packer: its place, its lists of about 30 neighbours, its cell, and the copies
/// that writing and certifying make.
constexpr double bytes_a_sphere = 600;

/// The packing fraction that the scene's stages are likely to reach when they may fill the container.
/// Compression leaves a share of close packing that falls with x = A d / V, for a wall of area A, a volume V
/// and the surface-weighted mean diameter d. Fitted to fills with x from 0.18 (Han's cylinder) to 1.6 (a part
/// only two spheres thick), all of them met within 0.03.
double expected_packing_fraction(const Scene& scene, const Shape& container, const SizeDistribution& radii) {
  const auto runs = [&](std::string_view name) {
    return std::ranges::any_of(scene.stages, [&](const Spec& s) { return s.name == name; });
  };
  if (!runs("refill")) {
    double fraction = 0;
    for (const Spec& s : scene.stages) {
      if (s.name == "insert") fraction = s.number("packing_fraction");
    }
    return fraction;
  }
  const double mean_diameter = 2 * radii.moment(3) / radii.moment(2);
  const double wall = area_of(container) * mean_diameter / volume_of(container);
  return share_of_close_packing * predict_packing_fraction(radii).phi *
         std::max(0.1, 1 - wall_deficit * wall);
}

}  // namespace

Shape shape_of(const Scene& scene, std::string* notes) {
  std::string unused;
  return find_entry(container_catalogue(), scene.container).make(scene, notes ? *notes : unused);
}

std::unique_ptr<SizeDistribution> radii_of(const Scene& scene) {
  return find_entry(sizes_catalogue(), scene.sizes).make(scene.sizes, scene.sizes_are_diameters ? 0.5 : 1.0);
}

Plan build(const Scene& scene) {
  Plan plan;
  plan.scene = scene;
  plan.container = shape_of(scene, &plan.container_notes);
  plan.radii = radii_of(scene);

  require_fitting(scene, plan.container, plan.radii->min());
  if (std::isfinite(plan.radii->max())) require_fitting(scene, plan.container, plan.radii->max());

  const double mean_volume = 4.0 / 3.0 * std::numbers::pi * plan.radii->moment(3);
  const double volume = volume_of(plan.container);
  double attainable = expected_packing_fraction(scene, plan.container, *plan.radii);
  if (scene.target.packing_fraction) attainable = std::min(attainable, *scene.target.packing_fraction);
  plan.expected_count = attainable * volume / mean_volume;
  if (scene.target.count)
    plan.expected_count = std::min(plan.expected_count, static_cast<double>(*scene.target.count));
  plan.expected_packing_fraction = plan.expected_count * mean_volume / volume;
  plan.expected_memory_bytes = plan.expected_count * bytes_a_sphere;

  plan.items.push_back(
      {"walls", fmt::format("{}, {}", kind_of(plan.container), scene.walls),
       std::holds_alternative<Mesh>(plan.container) ? "O(log faces) a query" : "O(1) a query"});
  for (const Spec& stage : scene.stages) {
    for (const PlanItem& item : find_entry(stage_catalogue(), stage).effects) {
      const auto same = [&](const PlanItem& other) { return other.name == item.name; };
      if (std::ranges::none_of(plan.items, same)) plan.items.push_back(item);
    }
  }
  for (const StageEntry& stage : stage_catalogue()) {
    for (const PlanItem& item : stage.effects) {
      const auto same = [&](const PlanItem& other) { return other.name == item.name; };
      const bool runs = std::ranges::any_of(plan.items, same);
      if (!runs && std::ranges::find(plan.absent, item.name) == plan.absent.end())
        plan.absent.push_back(item.name);
    }
  }
  return plan;
}

}  // namespace bernal

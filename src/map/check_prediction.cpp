#include "bernal/map/check_prediction.hpp"

#include <cmath>
#include <map>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {
namespace {

constexpr double largest_share_of_one = 0.02;

/// The rod model for spheres of these radii and no others, with 16,000 rods.
double predicted_for(const std::vector<double>& radii, double gap_factor) {
  std::map<double, double> classes;
  for (const double r : radii) classes[r] += 1;
  std::vector<double> sizes, numbers;
  for (const auto& [size, number] : classes) {
    sizes.push_back(size);
    numbers.push_back(number);
  }
  return predict_packing_fraction(*make_classes(std::move(sizes), std::move(numbers), Basis::number), 16000,
                                  gap_factor)
      .phi;
}

}  // namespace

std::int64_t spheres_for(const SizeDistribution& radii) {
  for (const std::int64_t count : {10'000, 20'000, 50'000, 100'000}) {
    const auto n = static_cast<double>(count);
    const double largest = radii.quantile(1 - 0.5 / n);
    if (std::pow(largest, 3) <= largest_share_of_one * n * radii.moment(3)) return count;
  }
  return 200'000;
}

Scene scene_to_check(const SceneSizes& sizes, bool sizes_are_diameters, const CheckOptions& options) {
  Scene scene;
  scene.container = PeriodicBox{};
  scene.sizes = sizes;
  scene.sizes_are_diameters = sizes_are_diameters;
  scene.draw = Draw::quantiles;
  if (auto* list = std::get_if<ListedSizes>(&scene.sizes)) list->draw = ListedSizes::Draw::resample;
  scene.seed = options.seed;
  scene.target.count = options.spheres == 0 ? spheres_for(*radii_of(scene)) : options.spheres;
  scene.stages = {options.stage};
  complete(scene);
  return scene;
}

PredictionCheck check_prediction(const Scene& scene, const CheckOptions& options) {
  const Packing packing = run(build(scene), {{}, options.threads, options.monitor});
  return {
      .phi = packing.packing_fraction(),
      .predicted = predicted_for(packing.spheres.r, options.gap_factor),
      .spheres = packing.spheres.size(),
      .certified = certify(packing.spheres, packing.domain,
                           {.allowed_overlap = scene.overlap, .gap = scene.gap, .wall_gap = scene.wall_gap})
                       .certified,
      .coordination = measure_contacts(packing.spheres, packing.domain).coordination,
      .outcome = packing.outcome,
      .seconds = packing.seconds};
}

}  // namespace bernal

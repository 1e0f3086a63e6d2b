#include "bernal/figures/check_prediction.hpp"

#include <cmath>
#include <map>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"

namespace bernal {
namespace {

constexpr double largest_share_of_one = 0.02;

SceneSizes population(double mean, double sigma) {
  if (sigma < 1e-9) return Constant{mean};
  return Lognormal{.median = mean * std::exp(-0.5 * sigma * sigma), .sigma = sigma, .basis = Basis::volume};
}

}  // namespace

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

std::int64_t spheres_for(const SizeDistribution& radii) {
  for (const std::int64_t count : {10'000, 20'000, 50'000, 100'000}) {
    const auto n = static_cast<double>(count);
    const double largest = radii.quantile(1 - 0.5 / n);
    if (std::pow(largest, 3) <= largest_share_of_one * n * radii.moment(3)) return count;
  }
  return 200'000;
}

SceneSizes sizes_of(const TwoPopulations& p) {
  if (p.share == 0) return population(1, p.sigma_a);
  if (p.share == 1 || (p.ratio == 1 && p.sigma_a == p.sigma_b)) return population(p.ratio, p.sigma_b);
  return Mixture{.of = {population(1, p.sigma_a), population(p.ratio, p.sigma_b)},
                 .shares = {1 - p.share, p.share},
                 .basis = Basis::volume};
}

Scene scene_to_check(const SceneSizes& sizes, bool sizes_are_diameters, const CheckOptions& options) {
  Scene scene;
  scene.container = PeriodicBox{};
  scene.sizes = sizes;
  scene.sizes_are_diameters = sizes_are_diameters;
  scene.draw = Draw::quantiles;
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

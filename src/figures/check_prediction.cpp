#include "bernal/figures/check_prediction.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

constexpr double largest_share_of_one = 0.02;

/// The rod model for these spheres and no others.
double predicted_for(const std::vector<double>& radii) {
  std::map<double, double> classes;
  for (const double r : radii) classes[r] += 1;
  std::vector<double> sizes, numbers;
  for (const auto& [size, number] : classes) {
    sizes.push_back(size);
    numbers.push_back(number);
  }
  return predict_packing_fraction(*make_classes(std::move(sizes), std::move(numbers), Basis::number), 16000)
      .phi;
}

Spec size_spec(std::string_view name, std::initializer_list<std::pair<std::string, Value>> parameters) {
  Spec spec{std::string(name), {}, {}};
  for (const auto& [key, value] : parameters) spec.parameters[key] = {value, {}};
  return spec;
}

Spec population(double mean, double sigma) {
  if (sigma < 1e-9) return size_spec("constant", {{"value", mean}});
  return size_spec("lognormal", {{"median", mean * std::exp(-0.5 * sigma * sigma)},
                                 {"sigma", sigma},
                                 {"basis", std::string("volume")}});
}

/// Of a text that no user has seen, so that errors name no line of it.
Scene scene_of(const std::string& text) {
  try {
    Scene scene = parse_scene(text, {});
    scene.stages.front().where = {};
    return scene;
  } catch (const Error& error) {
    const std::string place = error.location().text();
    throw Error(ErrorCode::bad_argument,
                std::string(error.what()).substr(place.empty() ? 0 : place.size() + 2));
  }
}

}  // namespace

std::int64_t spheres_for(const SizeDistribution& radii) {
  for (const std::int64_t count : {10'000, 20'000, 50'000, 100'000}) {
    const double n = static_cast<double>(count);
    const double largest = radii.quantile(1 - 0.5 / n);
    if (std::pow(largest, 3) <= largest_share_of_one * n * radii.moment(3)) return count;
  }
  return 200'000;
}

Spec sizes_of(const TwoPopulations& p) {
  if (p.share == 0) return population(1, p.sigma_a);
  if (p.share == 1 || (p.ratio == 1 && p.sigma_a == p.sigma_b)) return population(p.ratio, p.sigma_b);
  Spec both = size_spec(
      "mixture", {{"shares", std::vector<double>{1 - p.share, p.share}}, {"basis", std::string("volume")}});
  both.parts = {population(1, p.sigma_a), population(p.ratio, p.sigma_b)};
  return both;
}

Scene scene_to_check(const Spec& sizes, bool sizes_are_diameters, const CheckOptions& options) {
  Scene scene =
      scene_of(fmt::format("[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\nradius = 1\n"
                           "draw = \"quantiles\"\n[[stage]]\ndo = {}\n",
                           std::max<std::int64_t>(options.spheres, 1), toml_string(options.stage)));
  scene.seed = options.seed;
  scene.sizes = sizes;
  scene.sizes_are_diameters = sizes_are_diameters;
  if (options.spheres == 0) scene.target.count = spheres_for(*radii_of(scene));
  return scene;
}

PredictionCheck check_prediction(const Scene& scene, const CheckOptions& options) {
  const Packing packing = run(build(scene), {{}, options.threads, options.monitor});
  return {.phi = packing.packing_fraction(),
          .predicted = predicted_for(packing.spheres.r),
          .spheres = packing.spheres.size(),
          .certified = certify(packing.spheres, packing.domain, {.allowed_overlap = scene.overlap}).certified,
          .coordination = measure_contacts(packing.spheres, packing.domain).coordination,
          .outcome = packing.outcome,
          .seconds = packing.seconds};
}

}  // namespace bernal

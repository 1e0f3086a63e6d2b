#include <algorithm>
#include <limits>
#include <utility>

#include "bernal/plan/plan.hpp"
#include "plan/cell_sizes.hpp"
#include "plan/start.hpp"
#include "scene/size_kinds.hpp"
#include "sizes/scaled.hpp"

namespace bernal {
namespace {

using Radii = std::unique_ptr<SizeDistribution>;
using Limit = std::optional<double>;

/// The distribution of radii; `half` is 0.5 where the scene speaks of diameters and 1 where of radii.
struct MakeRadii {
  double half;

  double min_of(const Limit& min) const { return min ? half * *min : 0; }
  double max_of(const Limit& max) const {
    return max ? half * *max : std::numeric_limits<double>::infinity();
  }

  std::vector<double> halved(std::vector<double> sizes) const {
    for (double& size : sizes) size *= half;
    return sizes;
  }

  /// Points (radius, amount) by ascending radius.
  struct Points {
    std::vector<double> radii, amounts;
  };
  Points sorted(const std::vector<double>& sizes, const std::vector<double>& amounts) const {
    std::vector<std::pair<double, double>> pairs;
    for (std::size_t i = 0; i < sizes.size(); ++i) pairs.emplace_back(half * sizes[i], amounts.at(i));
    std::ranges::sort(pairs);
    Points points;
    for (const auto& [radius, amount] : pairs) {
      points.radii.push_back(radius);
      points.amounts.push_back(amount);
    }
    return points;
  }

  Radii operator()(const Constant& of) const { return make_constant(half * of.value); }
  Radii operator()(const Classes& of) const {
    return make_classes(halved(of.values), shares_of_one_density(of), of.basis);
  }
  Radii operator()(const Uniform& of) const { return make_uniform(half * of.min, half * of.max, of.basis); }
  Radii operator()(const Normal& of) const {
    return make_normal(half * of.mean, half * of.sd, of.basis, min_of(of.min), max_of(of.max));
  }
  Radii operator()(const Lognormal& of) const {
    const double min = min_of(of.min), max = max_of(of.max);
    if (of.mean) return make_lognormal_of_mean(half * *of.mean, half * of.sd.value(), of.basis, min, max);
    if (of.d43) return make_lognormal_of_means(0.5 * *of.d43, 0.5 * of.d32.value(), min, max);
    return make_lognormal(half * of.median.value(), of.sigma.value(), of.basis, min, max);
  }
  Radii operator()(const Tabulated& of) const {
    auto [radii, densities] = sorted(of.x, of.density);
    return make_table(std::move(radii), std::move(densities), of.basis);
  }
  Radii operator()(const Sieve& of) const {
    SieveCurve curve = curve_of(of);
    return make_sieve(halved(std::move(curve.openings)), std::move(curve.passing));
  }
  Radii operator()(const Percentiles& of) const {
    return make_from_percentiles(given_percentiles(of, 0.5), of.law, of.basis, min_of(of.min),
                                 max_of(of.max));
  }
  Radii operator()(const Histogram& of) const {
    return of.counts.empty() ? make_histogram(halved(of.edges), of.masses, Basis::mass)
                             : make_histogram(halved(of.edges), of.counts, Basis::number);
  }
  Radii operator()(const ListedSizes& of) const { return radii_there(halved(of.values)); }
  Radii operator()(const RosinRammler& of) const {
    return make_rosin_rammler(0.5 * of.d63, of.n, half * of.min, max_of(of.max));
  }
  Radii operator()(const Fuller& of) const { return make_fuller(half * of.max, of.exponent, half * of.min); }
  Radii operator()(const Mixture& of) const {
    std::vector<Radii> parts;
    for (const SceneSizes& part : of.of) parts.push_back(std::visit(*this, part));
    return make_mixture(std::move(parts), of.shares, of.basis);
  }
};

}  // namespace

Radii radii_of(const Scene& scene) {
  if (!scene.draws() && scene.start.file) {
    Scene copy = scene;
    return radii_there(read_start(copy).spheres.r);
  }
  if (scene.cells) return first_radii_of(scene);
  try {
    Radii radii = std::visit(MakeRadii{scene.sizes_are_diameters ? 0.5 : 1.0}, scene.sizes);
    return scene.scale == 1 ? std::move(radii) : std::make_unique<Scaled>(std::move(radii), scene.scale);
  } catch (const Error& error) {  // what only the numbers together show
    if (error.code() != ErrorCode::bad_argument) throw;
    throw Error(ErrorCode::bad_scene, error.what(), scene.sizes.locations.whole);
  }
}

}  // namespace bernal

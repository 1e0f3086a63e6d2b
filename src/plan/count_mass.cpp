#include "plan/count_mass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "plan/fitting.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"
#include "scene/sphere_matter.hpp"
#include "work/supply.hpp"

namespace bernal {

namespace count_mass_of {

/// What spheres weigh, in kg, that are drawn one after the other: by their density, or by their layers, which
/// are those of the sphere with that number.
class Scales {
 public:
  explicit Scales(const Scene& scene) : by_layers_(layers_have_densities(scene)) {
    cubic_metres_ = std::pow(metres_per(scene.unit), 3);
    if (!by_layers_) {
      density_ = *scene.material_density;
      return;
    }
    packing_.scene = scene;
    packing_.seed = scene.seed;
    matter_ = matter_by_class(scene);
    for (const auto& of_class : layers_by_class(scene))
      for (const Layer& layer : of_class) differ_ = differ_ || (layer.thickness && layer.thickness->sd > 0);
  }

  /// Whether spheres of one size differ.
  bool differ() const { return differ_; }

  /// What no sphere of that radius is below, whatever its layers.
  double least_of(double radius) const {
    double density = by_layers_ ? std::numeric_limits<double>::infinity() : density_;
    for (const auto& of_class : matter_)
      for (const SphereMatter& of : of_class) density = std::min(density, *of.density);
    return density * cubic_metres_ * ball_volume(3, radius);
  }

  /// Of all of these, the first of which has the number 0.
  std::vector<double> masses_of(const std::vector<double>& radii) {
    std::vector<double> masses;
    masses.reserve(radii.size());
    if (!by_layers_) {
      for (const double r : radii) masses.push_back(density_ * cubic_metres_ * ball_volume(3, r));
      return masses;
    }
    packing_.spheres = Spheres<dynamic>(3);
    packing_.spheres.r = radii;
    for (auto& x : packing_.spheres.x) x.assign(radii.size(), 0);
    packing_.classes = classes_by_size(packing_);
    const SphereLayers layers = layers_of(packing_);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      const auto& of = matter_[packing_.classes.empty() ? 0 : packing_.classes[i]];
      const std::span<const double> outer =
          of.front().is_layer ? layers.of(i) : std::span(&packing_.spheres.r[i], 1);
      double mass = 0, inner = 0;
      for (std::size_t k = 0; k < outer.size(); ++k) {
        const double volume = ball_volume(3, outer[k]);
        mass += *of[k].density * cubic_metres_ * (volume - inner);
        inner = volume;
      }
      masses.push_back(mass);
    }
    return masses;
  }

 private:
  bool by_layers_, differ_ = false;
  double density_ = 0, cubic_metres_ = 1;
  Packing packing_;
  std::vector<std::vector<SphereMatter>> matter_;
};

/// The radii of a plan without what gaps add, those of its start first, then as many as are asked for.
class Drawn {
 public:
  Drawn(const Plan& plan, double cut, double coat)
      : sequence_(*plan.radii, plan.scene.seed, *plan.scene.draw), cut_(cut), coat_(coat) {
    for (const double r : plan.start.spheres.r) radii_.push_back(r - coat);
  }
  const std::vector<double>& first(std::size_t count) {
    while (radii_.size() < count)
      if (const double r = sequence_.next(); r <= cut_) radii_.push_back(r - coat_);
    return radii_;
  }

 private:
  RadiusSequence sequence_;
  double cut_, coat_;
  std::vector<double> radii_;
};

}  // namespace count_mass_of

void count_mass(Plan& plan, const SizeDistribution& radii, double cut) {
  Target& target = plan.scene.target;
  if (!target.mass) return;
  const double coat = coat_of(plan.scene), wanted = *target.mass;
  count_mass_of::Scales scales(plan.scene);
  if (wanted < 0.5 * scales.least_of(radii.min() - coat))
    throw Error(ErrorCode::bad_scene,
                fmt::format("a \"mass\" of {:g} kg is less than half of the smallest sphere: check the units",
                            wanted),
                plan.scene.locations.of("mass"));
  if (!plan.scene.draw) plan.scene.draw = Draw::quantiles;
  const std::size_t there = plan.start.spheres.size();
  count_mass_of::Drawn drawn(plan, cut, coat);
  const auto weigh = [&](std::size_t count) {
    std::vector<double> some = drawn.first(count);
    some.resize(count);
    return scales.masses_of(some);
  };
  double sum = 0, last = 0;
  for (const double mass : weigh(there)) sum += mass;
  if (sum > wanted)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the start alone weighs {:.4g} of the \"mass\", which is of all spheres", sum / wanted),
        plan.scene.locations.of("mass"));
  std::size_t count = there;
  if (radii.min() == radii.max() && !scales.differ()) {
    const double each = scales.masses_of({radii.min() - coat}).front();
    if (!((wanted - sum) / each < Supply::most_spheres)) Supply::refuse_count(target);
    count += static_cast<std::size_t>(std::llround((wanted - sum) / each));
  } else {
    // Twice as many at a time, until they are enough.
    for (std::size_t block = 64; sum < wanted; block *= 2) {
      if (!(static_cast<double>(count) < Supply::most_spheres)) Supply::refuse_count(target);
      const std::vector<double> masses = weigh(count + block);
      for (; count < masses.size() && sum < wanted; ++count) sum += last = masses[count];
    }
    if (sum - wanted > 0.5 * last) --count;
  }
  target.count = std::max<std::int64_t>(1, static_cast<std::int64_t>(count));
  target.mass_counted = std::exchange(target.mass, std::nullopt);
}

double share_of_mass(const Plan& plan) {
  const Scene& scene = plan.scene;
  const bool has_no_tail = std::isfinite(plan.radii->max()) || (scene.is_periodic() && !any_in_bed(scene));
  const double cut =
      has_no_tail ? plan.radii->max() : tail_cut(scene, plan.domain, *plan.radii, plan.container);
  count_mass_of::Scales scales(scene);
  std::vector<double> radii =
      count_mass_of::Drawn(plan, cut, coat_of(scene)).first(static_cast<std::size_t>(*scene.target.count));
  radii.resize(static_cast<std::size_t>(*scene.target.count));
  double mass = 0;
  for (const double each : scales.masses_of(radii)) mass += each;
  return mass / *scene.target.mass_counted;
}

}  // namespace bernal

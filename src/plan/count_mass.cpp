#include "plan/count_mass.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "plan/fitting.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"
#include "work/supply.hpp"

namespace bernal {

void count_mass(Plan& plan, const SizeDistribution& radii, double cut) {
  Target& target = plan.scene.target;
  if (!target.mass) return;
  const double coat = coat_of(plan.scene);
  const auto volume_of_drawn = [&](double r) { return ball_volume(3, r - coat); };
  const double wanted =
      *target.mass / *plan.scene.material_density / std::pow(metres_per(plan.scene.unit), 3);
  const double mean = radii.min() == radii.max() ? volume_of_drawn(radii.min())
                                                 : ball_volume(3, 1) * radii.moment(3);  // more, with coats
  if (!(wanted / mean < Supply::most_spheres)) Supply::refuse_count(target);
  if (wanted < 0.5 * volume_of_drawn(radii.min()))
    throw Error(ErrorCode::bad_scene,
                fmt::format("a \"mass\" of {:g} kg is less than half of the smallest sphere: check the units",
                            *target.mass),
                plan.scene.locations.of("mass"));
  if (!plan.scene.draw) plan.scene.draw = Draw::quantiles;
  auto count = static_cast<std::int64_t>(plan.start.spheres.size());
  double sum = 0, last = 0;
  for (const double r : plan.start.spheres.r) sum += volume_of_drawn(r);
  if (sum > wanted)
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("the start alone weighs {:.4g} of the \"mass\", which is of all spheres", sum / wanted),
        plan.scene.locations.of("mass"));
  if (radii.min() == radii.max()) {
    count += std::llround((wanted - sum) / mean);
  } else {
    RadiusSequence sequence(*plan.radii, plan.scene.seed, *plan.scene.draw);
    while (sum < wanted) {
      if (!(static_cast<double>(count) < Supply::most_spheres)) Supply::refuse_count(target);
      const double r = sequence.next();
      if (r > cut) continue;
      sum += last = volume_of_drawn(r);
      ++count;
    }
    if (sum - wanted > 0.5 * last) --count;
  }
  target.count = std::max<std::int64_t>(1, count);
  target.mass_counted = std::exchange(target.mass, std::nullopt);
}

double share_of_mass(const Plan& plan) {
  const Scene& scene = plan.scene;
  const double coat = coat_of(scene);
  const bool has_no_tail = std::isfinite(plan.radii->max()) || (scene.is_periodic() && !any_in_bed(scene));
  const double cut =
      has_no_tail ? plan.radii->max() : tail_cut(scene, plan.domain, *plan.radii, plan.container);
  double volume = 0;
  for (const double r : plan.start.spheres.r) volume += ball_volume(3, r - coat);
  RadiusSequence sequence(*plan.radii, scene.seed, *scene.draw);
  for (auto n = static_cast<std::int64_t>(plan.start.spheres.size()); n < *scene.target.count;) {
    const double r = sequence.next();
    if (r > cut) continue;
    volume += ball_volume(3, r - coat);
    ++n;
  }
  return volume * std::pow(metres_per(scene.unit), 3) * *scene.material_density / *scene.target.mass_counted;
}

}  // namespace bernal

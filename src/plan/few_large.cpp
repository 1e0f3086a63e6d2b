#include "plan/few_large.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/soft/relax.hpp"
#include "jam/few_spheres.hpp"
#include "plan/estimate.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"
#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

constexpr double enough_carriers = 30, enough_across = 3;
/// Of what is expected between walls: an error that is said.
constexpr double a_guess = 0.07;

/// In one packing.
constexpr double most_spheres = 0x1p31;

/// Up to two digits.
double rounded_up(double x) {
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  return std::ceil(x / unit - 1e-6) * unit;
}

}  // namespace

std::optional<FewLarge> few_large(const SizeDistribution& radii, double count, const Vector<dynamic>& edges) {
  const auto dimension = static_cast<int>(edges.size());
  if (dimension != 2 && dimension != 3) return {};
  const VolumeCarriers largest = volume_carriers(radii, dimension);
  FewLarge few{
      .carriers = count * largest.share, .across = edges.minCoeff() / (2 * largest.radius), .factor = 1};
  if (few.carriers >= enough_carriers && few.across >= enough_across) return {};
  few.factor = std::max(enough_carriers / few.carriers, std::pow(enough_across / few.across, dimension));
  return few;
}

std::string in_words(const FewLarge& few) {
  const double n = std::max(1.0, std::round(few.carriers));
  const std::string across =
      few.across < 1 ? fmt::format("the box is {:.1g} of the largest diameter across", few.across)
                     : fmt::format("the box is {:.1f} of the largest diameters across", few.across);
  if (n >= enough_carriers) return across;
  const std::string carriers = few.carriers < 0.5 ? "less than one sphere"
                               : n == 1           ? "1 sphere"
                                                  : grouped(static_cast<std::uint64_t>(n)) + " spheres";
  return fmt::format("half of the volume is in {} and {}", carriers, across);
}

std::string remedy_of(const FewLarge& few, double count, const Scene& scene, const Vector<dynamic>& edges) {
  if (std::get<PeriodicBox>(scene.container).scalable) {
    const double enough = rounded_up(few.factor * count);
    if (enough > most_spheres) return "more spheres than there can be would have to come";
    return fmt::format("{} spheres would be enough", grouped(static_cast<std::uint64_t>(enough)));
  }
  const double wider = std::pow(few.factor, 1.0 / static_cast<double>(edges.size()));
  return fmt::format("a shortest edge of {:.3g} {} would be enough", rounded_up(wider * edges.minCoeff()),
                     name_of(scene.unit));
}

bool is_guess(const Plan& plan) {
  return plan.places_expected && plan.scene.target.is_open() &&
         error_between_walls(plan.domain, *plan.radii) >= a_guess;
}

bool packs_few(const Scene& scene) {
  const Stage& last = scene.stages.back();
  const StageTraits& traits = table_of(last).traits;
  if (scene.is_periodic() || scene.target.bed.is_asked() || !traits.stands_in_bed(scene)) return false;
  return scene.dimension() == 2 ? traits.reaches == Reaches::settled : last.as<Relax>() != nullptr;
}

bool is_tried(const Plan& plan) {
  const double most = (1 + error_between_walls(plan.domain, *plan.radii)) * plan.expected_count;
  return is_guess(plan) && !is_periodic(plan.domain) && packs_few(plan.scene) &&
         most < static_cast<double>(most_few);
}

bool is_searched_once(const Plan& plan) {
  return packs_few(plan.scene) && *plan.scene.target.count <= static_cast<std::int64_t>(most_few) &&
         !needs_room(plan) && std::isfinite(plan.radii->max());
}

std::optional<PlanItem> search_for_few(const Plan& plan) {
  constexpr double tries = 3;  // of one more, where as many as fit are wanted
  const Target& target = plan.scene.target;
  const double likely = plan.expected_count,
               wanted = target.count ? static_cast<double>(*target.count) : likely + 1;
  if (!packs_few(plan.scene) || is_periodic(plan.domain) || wanted > static_cast<double>(most_few)) return {};
  PlanItem item{.name = "relaxation",
                .what = "of few spheres, from many beginnings, for the tightest arrangement",
                .cost = "O(N²) a step"};
  if (target.is_open())
    item.seconds = tries * effort_of_one_more(wanted) * seconds_of_few(wanted);
  else if (target.count && likely < wanted)
    item.seconds = seconds_of_few(wanted);
  item.if_needed = !(item.seconds > 0);
  return item;
}

std::optional<std::uint64_t> give_or_take(const Plan& plan) {
  if (!is_guess(plan) || plan.scene.target.fill) return {};
  const double share = error_between_walls(plan.domain, *plan.radii);
  return static_cast<std::uint64_t>(std::max(1.0, std::ceil(share * plan.expected_count)));
}

}  // namespace bernal

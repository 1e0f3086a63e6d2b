#include "plan/caution.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "plan/count_mass.hpp"
#include "plan/estimate.hpp"
#include "plan/few_large.hpp"
#include "plan/fitting.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/stages.hpp"

namespace bernal {
namespace {

/// Of what is attainable: a box that is filled to less has room to spare, whatever is in it.
constexpr double closely = 0.9;
/// Of the error of an expectation, what is asked for beyond it and might still be reached.
constexpr double within_reach = 2;

/// The largest packing fraction of equal spheres, proven for one to three and eight dimensions: Lagrange
/// 1773, Thue 1892, Hales 2005, Viazovska 2017; for the others of the best arrangement that is known (Conway
/// & Sloane, Sphere Packings, Lattices and Groups, table 1.2).
double densest_of_equal(int dimension) {
  using std::numbers::pi;
  const double densest[] = {1,
                            pi / std::sqrt(12.0),
                            pi / std::sqrt(18.0),
                            pi * pi / 16,
                            pi * pi / (15 * std::sqrt(2.0)),
                            pi * pi * pi / (48 * std::sqrt(3.0)),
                            pi * pi * pi / 105,
                            std::pow(pi, 4) / 384};
  return densest[dimension - 1];
}

std::string caution_of_few(const Plan& plan) {
  const Box* box = std::get_if<Box>(&plan.domain);
  const bool packs_closely = plan.expected_packing_fraction > closely * plan.attainable_packing_fraction;
  if (!box || box->has_walls() || any_in_bed(plan.scene) || !packs_closely) return {};
  const Vector<dynamic> edges = box->size;
  const std::optional<FewLarge> few = few_large(*plan.radii, plan.expected_count, edges);
  if (!few) return {};
  return fmt::format("{}: too few to pack at random; {}", in_words(*few),
                     remedy_of(*few, plan.expected_count, plan.scene, edges));
}

/// The same of a container with walls. Of equal spheres `caution_of_guess` speaks.
std::string caution_of_few_at_walls(const Plan& plan) {
  const double share = error_of_few_large(plan.domain, *plan.radii);
  const bool packs_closely = plan.expected_packing_fraction > closely * plan.attainable_packing_fraction;
  if (!(share > 0) || !packs_closely || plan.radii->min() == plan.radii->max()) return {};
  return fmt::format(
      "{:.2g} of the largest {} lie across the container: how densely so few pack between walls is a "
      "matter of chance, and the packing fraction is expected give or take {:.2g}; a larger container or "
      "smaller sizes pack as expected",
      largest_across(plan.domain, *plan.radii), plan.scene.dimension() == 2 ? "discs" : "spheres",
      share * plan.expected_packing_fraction);
}

/// "; no arrangement of equal spheres that is known has more than 0.7405", where that much is asked for.
std::string beyond_any(const Plan& plan, double asked) {
  const int dimension = plan.scene.dimension();
  const double densest = densest_of_equal(dimension);
  if (plan.radii->min() != plan.radii->max() || asked <= densest) return {};
  return fmt::format("; no arrangement of equal {} that is known has more than {:.4f}",
                     dimension == 2 ? "discs" : "spheres", densest);
}

/// Of what is asked for beyond what the stages are likely to reach.
std::string caution_of_target(const Plan& plan) {
  const Scene& scene = plan.scene;
  if (scene.target.predicted || plan.start.spheres.size() > 0) return {};
  const bool is_counted = scene.target.count && !plan.box_follows;
  if (!scene.target.packing_fraction && !is_counted) return {};
  const int dimension = scene.dimension();
  const double overlapping =
      std::pow(1 - scene.overlap, dimension);  // what is left of spheres that may overlap
  const double asked = fill_task_of(plan).packing_fraction * overlapping;
  const double attainable = plan.attainable_packing_fraction;
  if (!(asked > attainable + within_reach * stated_error(scene, plan.domain, *plan.radii, attainable)))
    return {};
  return fmt::format(
      "a packing fraction of {:.3g} is asked for{}, and these sizes are expected to reach {:.3f}{}", asked,
      scene.target.mass_counted         ? " by the mass"
      : is_counted                      ? " by the count"
      : scene.target.bulk_density_asked ? " by the bulk density"
                                        : "",
      attainable, beyond_any(plan, asked));
}

/// Of a bed that is to be denser than spheres come to lie.
std::string caution_of_porosity(const Plan& plan) {
  const Target& target = plan.scene.target;
  if (!target.bed.porosity) return {};
  constexpr double error_of_model = 0.01;
  const double asked = 1 - *target.bed.porosity, closest = close_packing_fraction(*plan.radii, 3);
  if (!(asked > closest + within_reach * error_of_model)) return {};
  return fmt::format(
      "a porosity of {:.3g} is asked for{}, and random close packing of these sizes leaves {:.3f} even far "
      "from walls{}",
      *target.bed.porosity, target.bulk_density_asked ? " by the bulk density" : "", 1 - closest,
      beyond_any(plan, asked));
}

std::string caution_of_guess(const Plan& plan) {
  const std::optional<std::uint64_t> error = give_or_take(plan);
  if (!error) return {};
  return fmt::format("walls are near everywhere: that {} fit is known to give or take {}; {}",
                     grouped(static_cast<std::uint64_t>(std::llround(plan.expected_count))), grouped(*error),
                     is_tried(plan) ? "how many do is found by trial"
                                    : "fill = true in [spheres] places as many as can be made to fit");
}

std::string caution_of_size(const Plan& plan) {
  if (!is_faceted(plan.domain) || !(plan.radii->min() > 0)) return {};
  const double thickness = volume_of(plan.domain) / area_of(plan.domain);
  if (plan.radii->min() < 0.5 * thickness) return {};
  if (plan.radii->min() <= largest_known_radius(plan.domain, plan.container, plan.radii->min())) return {};
  return "no place is known for spheres of these sizes: " + largest_in_words(plan, coat_of(plan.scene));
}

/// Of a mass that the drawn sizes come nowhere near.
std::string caution_of_mass(const Plan& plan) {
  constexpr double near_enough = 0.01;
  const Target& target = plan.scene.target;
  if (!target.mass_counted || plan.radii->min() == plan.radii->max()) return {};
  const double share = share_of_mass(plan);
  if (std::abs(share - 1) <= near_enough) return {};
  return fmt::format(
      "the sizes that are drawn come no nearer to {:.4g} kg than {:.4g} kg, as single spheres are heavy; {}",
      *target.mass_counted, share * *target.mass_counted,
      plan.scene.draw == Draw::random ? "say draw = \"quantiles\" or give the sizes a \"max\""
                                      : "take another seed, or give the sizes a \"max\"");
}

}  // namespace

std::string caution_of(const Plan& plan) {
  std::vector<std::string> all;
  for (std::string caution :
       {caution_of_few(plan), caution_of_few_at_walls(plan), caution_of_target(plan),
        caution_of_porosity(plan), caution_of_guess(plan), caution_of_size(plan), caution_of_mass(plan)})
    if (!caution.empty()) all.push_back(std::move(caution));
  return fmt::format("{}", fmt::join(all, "; "));
}

std::string largest_in_words(const Plan& plan, double around) {
  const Scene& scene = plan.scene;
  const double largest =
      std::max(0.0, largest_known_radius(plan.domain, plan.container, plan.radii->min()) - around);
  return fmt::format("the largest sphere that is known to fit has the {} {:.6g} {}",
                     scene.sizes_are_diameters ? "diameter" : "radius",
                     (scene.sizes_are_diameters ? 2 : 1) * largest, name_of(scene.unit));
}

}  // namespace bernal

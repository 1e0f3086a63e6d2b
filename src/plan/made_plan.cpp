#include "plan/made_plan.hpp"

#include <cmath>
#include <optional>
#include <typeinfo>
#include <utility>

#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "jam/few_spheres.hpp"
#include "plan/cell_sizes.hpp"
#include "plan/few_large.hpp"
#include "plan/plan_insides.hpp"
#include "plan/plan_zones.hpp"

namespace bernal {
namespace {

/// Of spheres that are to be as large as fit: on the scale with which the search begins, on which they are
/// easily placed.
Plan plan_of_largest(const Scene& stated) {
  constexpr double first_share = 0.3, least_share = 1e-3;  // of the domain's volume
  // Runs that the search takes, and the time of one that fails, over that of one that does not, and at least.
  constexpr double runs = 100, dear = 20, least_seconds = 0.02;
  Scene scene = stated;
  complete(scene);
  const int dimension = scene.dimension();
  scene.scale = 1;
  const double volume = static_cast<double>(*scene.target.count) * ball_volume(dimension, 1) *
                        radii_of(scene)->moment(dimension);
  const double room = volume_of(domain_of(scene));
  std::optional<Plan> plan;
  for (double share = first_share; !plan && share > least_share; share /= 2) {  // the largest of many sizes
    scene.scale = std::pow(share * room / volume, 1.0 / dimension);
    plan = made_plan_where_all_fit(scene);
  }
  if (!plan) plan = made_plan(scene);  // which says why they do not fit
  plan->expected_packing_fraction = plan->attainable_packing_fraction;
  if (is_searched_once(*plan))
    plan->items.push_back({.name = "search",
                           .what = "for the tightest arrangement of so few spheres, from many beginnings",
                           .cost = "O(N²) a step",
                           .seconds = seconds_of_few(static_cast<double>(*scene.target.count))});
  else
    plan->items.push_back({.name = "search",
                           .what = "the same for larger and larger spheres, and for sizes in between, from "
                                   "several beginnings each, until the largest are known to 1e-4",
                           .cost = "some 100 runs",
                           .seconds = runs * (dear * plan->expected_seconds + least_seconds)});
  plan->expected_seconds += plan->items.back().seconds;
  return std::move(*plan);
}

}  // namespace

Plan build(const Scene& scene) { return build_inside(scene, {}); }

Plan build_inside(const Scene& scene, const ScenesAround& around) {
  const int dimension = scene.dimension();
  try {
    Plan plan = !scene.zones.empty() ? plan_of_zones(scene)
                : scene.largest      ? plan_of_largest(scene)
                : scene.cells        ? plan_of_cells(scene)
                                     : made_plan(scene);
    plan_insides(plan, around);
    plan.caution = in_dimension(dimension, plan.caution);
    for (PlanItem& item : plan.items) item.what = in_dimension(dimension, item.what);
    for (std::string& hint : plan.hints) hint = in_dimension(dimension, hint);
    return plan;
  } catch (const Error& error) {
    const std::string in_words = in_dimension(dimension, error.message());
    if (typeid(error) != typeid(Error) || in_words == error.message()) throw;
    throw Error(error.code(), in_words, error.location());
  }
}

}  // namespace bernal

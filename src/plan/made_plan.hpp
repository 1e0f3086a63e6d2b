#pragma once
#include <optional>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// Where a scene is packed, if not in all of its container.
struct PlaceOfPlan {
  Domain domain;
  std::shared_ptr<const Container> container = {};  ///< see `Plan::container`
};

/// What `build` makes of a scene without zones, before that has it in the words of the scene's dimension.
Plan made_plan(const Scene& scene, const PlaceOfPlan* place = nullptr);

/// The same; nothing where the largest of its spheres do not fit into their domain by themselves, see
/// `may_fit`.
std::optional<Plan> made_plan_where_all_fit(const Scene& scene);
/// Whether they would, by the seed of the plan's scene.
bool all_may_fit(const Plan& plan);

}  // namespace bernal

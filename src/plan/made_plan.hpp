#pragma once
#include <optional>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// What `build` makes, before that has it in the words of the scene's dimension.
Plan made_plan(const Scene& scene);

/// The same; nothing where the largest of its spheres do not fit into their domain by themselves, see
/// `may_fit`.
std::optional<Plan> made_plan_where_all_fit(const Scene& scene);

}  // namespace bernal

#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

/// What `build` makes, before that has it in the words of the scene's dimension.
Plan made_plan(const Scene& scene);

}  // namespace bernal

#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

/// Asks the stages of a plan, whose expectations are there, for their effects and what these cost: sets
/// `items`, `absent`, `expected_seconds` and `expected_memory_bytes`. Throws Error{bad_scene} where options
/// ask for what cannot be done.
void price_effects(Plan& plan);

}  // namespace bernal

#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

/// The plan of a scene with zones: one for each zone and for each piece of what lies in none, and their sum.
/// Throws as `build`, and where zones overlap or have nothing of the container.
Plan plan_of_zones(const Scene&);

/// The plan of a layer once those below it are there, in the scene's unit. Precondition: there are spheres.
Plan plan_of_layer(const Plan& whole, const PlannedPart&, const Spheres<dynamic>& below);

}  // namespace bernal

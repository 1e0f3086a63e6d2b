#pragma once
#include <filesystem>
#include <vector>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// What packing inside of spheres is called among the effects of a run.
inline constexpr const char* inside_effect = "inside";

/// The scenes around one that lies inside, from the outermost on, as `canonical` has them.
using ScenesAround = std::vector<std::filesystem::path>;

/// `build` of a scene that lies inside of these.
Plan build_inside(const Scene&, const ScenesAround&);

/// Adds to a plan what lies inside its spheres, with its time and memory. Throws as `build`, and where a
/// scene would lie inside itself. Nothing is done where the scene has nothing inside.
void plan_insides(Plan&, const ScenesAround&);

/// The plan of what lies inside a sphere, in a ball of that radius in the unit of the plan around it.
Plan plan_in_ball(const Plan& around, const PlannedInside&, double radius);

}  // namespace bernal

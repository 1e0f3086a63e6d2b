#pragma once
#include "bernal/plan/plan.hpp"

namespace bernal {

/// Makes a mass that the scene asks for a count: of the sequence of radii that the plan's seed draws, up to
/// `cut`, as many as come nearest to it, so within half of the last. In a plan with room for gaps radii have
/// half of the gap around them. Sizes are drawn by quantiles unless the scene says otherwise. Throws
/// Error{bad_scene} for less than half a sphere, and for more than have numbers. `radii`: those of the plan
/// up to `cut`. Cost: that of drawing them, nothing for equal ones.
void count_mass(Plan& plan, const SizeDistribution& radii, double cut);

/// Of a plan whose mass has become a count: what so many drawn spheres weigh, over that mass.
double share_of_mass(const Plan& plan);

}  // namespace bernal

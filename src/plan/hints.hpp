#pragma once
#include <string>
#include <vector>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// How a plan understands what its scene leaves open, where many would mean something else: lengths without
/// a unit, spheres that float in a container instead of lying in it, shares by number that are far from
/// those by mass, densities without a unit that no solid has, parts of a container that no sphere reaches;
/// and where a crystal would hold more. Each with the line that says it. Precondition: what is expected is
/// known.
std::vector<std::string> hints_of(const Plan& plan);

}  // namespace bernal

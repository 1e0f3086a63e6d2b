#pragma once
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// "diameter in mm: lognormal, basis number, median 1, sigma 0.3": the sizes with their unit and the word
/// radius or diameter, which are easily confused.
std::string describe_sizes(const Scene& scene);

/// "as many as fit", "10,000", "up to packing fraction 0.45".
std::string describe_target(const Plan& plan);

}  // namespace bernal

#pragma once
#include <cstdint>
#include <string>

#include "bernal/plan/plan.hpp"

namespace bernal {

/// "diameter in mm: lognormal, basis number, median 1, sigma 0.3": the sizes with their unit and the word
/// radius or diameter, which are easily confused.
std::string describe_sizes(const Scene& scene);

/// "as many as fit", "10,000", "up to packing fraction 0.45".
std::string describe_target(const Plan& plan);

/// "about 10 spheres", "about 1 sphere", "about 1.23e+04 spheres": of an expected number, which need not be
/// whole.
std::string spheres_in_words(double count);

/// "2 kg of 2500 kg/m3 in spheres of 3 mm: 56,588 spheres", "1550 kg/m3 of spheres of 2500 kg/m3: porosity
/// 0.38": the sum by which an amount became a count or a fraction; empty where the scene says these itself.
/// Of spheres of that diameter, or, unless they are equal, of that mean volume.
std::string amount_in_words(const Scene& scene, double diameter, bool are_equal, std::uint64_t count);

}  // namespace bernal

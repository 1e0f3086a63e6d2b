#pragma once
#include <memory>
#include <string_view>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The number density is proportional to r^(n-1) on [a, b]: n = 1 is uniform by number; where the share of
/// the volume below r grows as r^q, n is q - 3, because a sphere's volume grows as r³; q = 0 is its limit, ln
/// r. Preconditions: 0 < a < b, finite.
std::unique_ptr<SizeDistribution> make_power_law(std::string_view name, double a, double b, double n);

}  // namespace bernal

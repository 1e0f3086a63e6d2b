#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The sizes of spheres that are there and of so many more that are drawn, as classes: by number those of
/// `there`, and quantiles of `radii`, finer towards the largest, of which no more is there than a draw of
/// `drawn` has. Null where that is the distribution itself: nothing is there, and less than a tenth of the
/// volume is in larger spheres than so many draws bring. Preconditions: three dimensions, `drawn` >= 0,
/// and one sphere in all. Cost: 600 quantiles.
std::unique_ptr<SizeDistribution> sizes_at_hand(const std::vector<double>& there,
                                                const SizeDistribution& radii, double drawn);

}  // namespace bernal

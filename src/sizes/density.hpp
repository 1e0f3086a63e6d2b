#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// What a density by volume is divided by to be one by number.
inline double cube(double r) { return r * r * r; }

/// A distribution that is known by its number density alone, in any scale. `density` is smooth and not
/// negative inside each interval between neighbouring `breaks`, which are positive, ascending and at least
/// two; where the density has a feature much narrower than an interval, a break has to mark it.
///
/// Probabilities and moments are integrals by Gauss–Legendre quadrature, 7 points on pieces that are halved
/// until that changes nothing: right to some roundoffs. Quantiles are their roots, by Newton's method.
/// Cost in values of the density: 100 and more an interval to make, 7 a cumulative, about 24 a quantile.
/// Throws Error{bad_argument} if the density is zero everywhere or not finite somewhere.
std::unique_ptr<SizeDistribution> make_from_density(std::string_view name,
                                                    std::function<double(double)> density,
                                                    const std::vector<double>& breaks);

}  // namespace bernal

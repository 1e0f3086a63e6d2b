#pragma once
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Converts a density by volume to one by number when divided by it.
inline double cube(double r) { return r * r * r; }

/// A distribution given by its number density, in any scale. `density` is smooth and not negative within each
/// interval between neighbouring `breaks`, which are positive, ascending and at least two; a feature of the
/// density much narrower than an interval needs a break.
///
/// Probabilities and moments are integrals by Gauss–Legendre quadrature, 7 points on pieces that are halved
/// until the result converges: accurate to some roundoffs. Quantiles are their roots, by Newton's method.
/// Cost in values of the density: at least 100 an interval to make, 7 a cumulative, about 24 a quantile.
/// Throws Error{bad_argument} if the density is zero everywhere or not finite somewhere.
std::unique_ptr<SizeDistribution> make_from_density(std::string_view name,
                                                    std::function<double(double)> density,
                                                    const std::vector<double>& breaks);

}  // namespace bernal

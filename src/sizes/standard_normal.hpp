#pragma once
#include <limits>
#include <numbers>

#include <boost/math/special_functions/erf.hpp>

namespace bernal {

/// Probability that a standard normal variable is below z.
inline double normal_below(double z) { return 0.5 * boost::math::erfc(-z / std::numbers::sqrt2); }

/// z with normal_below(z) = p.
inline double normal_quantile(double p) {
  if (p <= 0) return -std::numeric_limits<double>::infinity();
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

}  // namespace bernal

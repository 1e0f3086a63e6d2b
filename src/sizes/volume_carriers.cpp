#include "sizes/volume_carriers.hpp"

#include <cmath>

namespace bernal {
namespace {

constexpr double few_equal = 1000, few_of_all = 0.1;
/// Relative to a radius: closer ones are one size. Relative to the volume: so that of two sizes with half of
/// it each the larger alone holds half.
constexpr double one_size = 1e-9, half_to_rounding = 1e-6;

}  // namespace

double radius_holding(const SizeDistribution& radii, double share, int dimension) {
  const double held = share * (1 - half_to_rounding) * radii.moment(dimension);
  double low = radii.min(), high = radii.max();
  if (!std::isfinite(high))
    for (high = radii.quantile(0.5); radii.moment_above(dimension, high) >= held;) high *= 2;
  while (high > low * (1 + 0.01 * one_size)) {
    const double middle = low + 0.5 * (high - low);
    if (middle <= low || middle >= high) break;
    (radii.moment_above(dimension, middle) >= held ? low : high) = middle;
  }
  return high;
}

bool few_carry_volume(const SizeDistribution& radii, double count, int dimension) {
  const double share = std::pow(radii.moment(dimension), 2) / radii.moment(2 * dimension);
  // NaN comes from sizes that spread too widely.
  return !(share >= few_of_all) && !(share * count >= few_equal);
}

VolumeCarriers volume_carriers(const SizeDistribution& radii, int dimension) {
  if (radii.min() == radii.max()) return {1, radii.max()};
  const double half = radius_holding(radii, 0.5, dimension);
  return {radii.moment_above(0, half * (1 - one_size)), radius_holding(radii, 0.1, dimension)};
}

}  // namespace bernal

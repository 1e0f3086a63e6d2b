#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/density.hpp"

namespace bernal {
namespace {

/// Share of the basis above the default upper limit.
constexpr double share_above = 1e-3;

}  // namespace

std::unique_ptr<SizeDistribution> make_rosin_rammler(double r63, double n, double min, double max,
                                                     Basis basis) {
  require_positive("the radius below which 63 % of the volume lies", r63);
  require_positive("the exponent n", n);
  if (max == std::numeric_limits<double>::infinity()) {
    max = r63 * std::pow(-std::log(share_above), 1 / n);
    if (min >= max)
      throw Error(
          ErrorCode::bad_argument,
          fmt::format("no more than {} % of this Rosin-Rammler distribution lies above \"min\"; lower "
                      "it, or give \"max\" too",
                      100 * share_above));
  }
  require_interval(min, max);
  // Density n x^(n-1) e^(-x^n) with x = r / r63, by volume over r³; scaled to 1 at r63, or at the limit
  // nearest to it, so that it neither vanishes nor overflows.
  const double scale = std::clamp(r63, min, max);
  const double power_at_scale = std::pow(scale / r63, n);
  const bool by_volume = counts_volume(basis);
  const auto density = [=](double r) {
    const double s = r / scale, power = std::pow(s, n);
    return power / (by_volume ? s * cube(s) : s) * std::exp(power_at_scale * (1 - power));
  };
  std::vector<double> breaks = {min};
  if (r63 > min && r63 < max) breaks.push_back(r63);
  breaks.push_back(max);
  return make_from_density("rosin_rammler", density, breaks);
}

}  // namespace bernal

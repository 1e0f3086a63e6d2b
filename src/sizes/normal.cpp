#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/density.hpp"

namespace bernal {
namespace {

/// Deviations from the mean beyond which 2e-9 of a normal distribution lies: one sphere in five hundred
/// million.
constexpr double nothing_beyond = 6;

}  // namespace

std::unique_ptr<SizeDistribution> make_normal(double mean, double deviation, Basis basis, double min,
                                              double max) {
  require_positive("the mean radius", mean);
  require_positive("the standard deviation", deviation);
  if (min == 0) min = mean - nothing_beyond * deviation;
  if (max == std::numeric_limits<double>::infinity()) max = mean + nothing_beyond * deviation;
  if (min <= 0)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("{} standard deviations below its mean this normal distribution reaches zero; cut it "
                    "off with \"min\"",
                    nothing_beyond));
  require_interval(min, max);
  constexpr double seen = nothing_beyond + 2;
  if (min > mean + seen * deviation || max < mean - seen * deviation)
    throw Error(ErrorCode::bad_argument,
                fmt::format("no radius of this normal distribution lies in [{}, {}]", min, max));

  const double mode = std::clamp(mean, min, max);  // where the density is 1, so that nothing underflows
  const double z_mode = (mode - mean) / deviation;
  const bool by_volume = counts_volume(basis);
  const auto density = [=](double r) {
    const double z = (r - mean) / deviation;
    const double f = std::exp(0.5 * (z_mode - z) * (z_mode + z));
    return by_volume ? f / cube(r / mode) : f;
  };
  std::vector<double> breaks = {min};
  for (double z = -seen; z <= seen; ++z)
    if (const double r = mean + z * deviation; r > breaks.back() && r < max) breaks.push_back(r);
  breaks.push_back(max);
  return make_from_density("normal", density, breaks);
}

}  // namespace bernal

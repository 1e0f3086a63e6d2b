#include "bernal/sizes/radius_sequence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/size_cases.hpp"

namespace bernal {
namespace radius_sequence_test {

std::vector<double> first(const SizeDistribution& sizes, std::size_t n, Draw draw, std::uint64_t seed = 1) {
  RadiusSequence sequence(sizes, seed, draw);
  std::vector<double> radii(n);
  for (double& r : radii) r = sequence.next();
  return radii;
}

/// Largest difference between the share of radii up to r and the distribution's, over all r; times n.
double distance(const SizeDistribution& sizes, std::vector<double> radii) {
  std::ranges::sort(radii);
  const double n = static_cast<double>(radii.size());
  double largest = 0;
  for (auto it = radii.begin(); it != radii.end();) {
    const auto end = std::upper_bound(it, radii.end(), *it);
    largest = std::max(
        {largest, std::abs(static_cast<double>(end - radii.begin()) - n * sizes.cumulative(*it)),
         std::abs(static_cast<double>(it - radii.begin()) - n * sizes.cumulative(*it * (1 - 1e-14)))});
    it = end;
  }
  return largest;
}

TEST(RadiusSequence, AtRandomIsWhatTheStreamOfRadiiGives) {
  const auto sizes = make_lognormal(1, 0.3, Basis::number, 0, 1e9);
  Random random(7, stream(Stream::radii));
  for (const double r : first(*sizes, 100, Draw::random, 7)) EXPECT_EQ(r, sizes->sample(random));
}

TEST(RadiusSequence, IsAFunctionOfTheSeed) {
  const auto sizes = make_uniform(1, 2, Basis::number);
  for (const Draw draw : {Draw::random, Draw::quantiles}) {
    EXPECT_EQ(first(*sizes, 100, draw, 1), first(*sizes, 100, draw, 1));
    EXPECT_NE(first(*sizes, 100, draw, 1), first(*sizes, 100, draw, 2));
  }
}

// Of a sequence that steps by the golden ratio the star discrepancy is below 1/n + 0.4 ln(n)/n or so
// (Niederreiter 1992, theorem 3.3); the radii up to a limit come from one interval of u, or from one for each
// part of a mixture.
TEST(RadiusSequence, OfQuantilesIsEvenInEveryPrefix) {
  for (const auto& tested : testing::size_cases()) {
    const auto sizes = tested.make();
    for (const std::size_t n : {1u, 10u, 100u, 1000u, 20'000u}) {
      const double even = distance(*sizes, first(*sizes, n, Draw::quantiles));
      EXPECT_LT(even, 3 * (2 + std::log(static_cast<double>(n)))) << tested.name << " " << n;
    }
  }
}

TEST(RadiusSequence, OfQuantilesHasTheMeanVolumeOfTheDistribution) {
  // Koksma: off by at most the discrepancy times the range of r³.
  constexpr std::size_t n = 10'000;
  for (const auto& tested : testing::size_cases()) {
    const auto sizes = tested.make();
    if (!std::isfinite(sizes->max())) continue;
    double mean = 0;
    for (const double r : first(*sizes, n, Draw::quantiles)) mean += r * r * r / n;
    const double range = std::pow(sizes->max(), 3) - std::pow(sizes->min(), 3);
    EXPECT_NEAR(mean, sizes->moment(3), 3 * (2 + std::log(n)) / n * range + 1e-12 * mean) << tested.name;
  }
  const auto lognormal = make_lognormal(1, 0.3, Basis::number, 0, 1e9);
  double even = 0, random = 0;
  for (const double r : first(*lognormal, n, Draw::quantiles)) even += r * r * r / n;
  for (const double r : first(*lognormal, n, Draw::random)) random += r * r * r / n;
  EXPECT_NEAR(even / lognormal->moment(3), 1, 1e-3);
  EXPECT_GT(std::abs(random / lognormal->moment(3) - 1), 1e-3);  // about 1.1 / sqrt(n)
}

}  // namespace radius_sequence_test
}  // namespace bernal

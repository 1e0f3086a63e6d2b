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

/// How far the number of any class is off its share of a prefix, at most.
double farthest_off(const SizeDistribution& sizes, std::size_t n, std::uint64_t seed) {
  RadiusSequence sequence(sizes, seed, Draw::quantiles);
  const std::vector<double> atoms = sizes.atoms();
  std::vector<double> counts(atoms.size()), shares;
  for (const double r : atoms)
    shares.push_back(sizes.cumulative(r) - sizes.cumulative(std::nextafter(r, 0.0)));
  double farthest = 0;
  for (std::size_t drawn = 1; drawn <= n; ++drawn) {
    const auto found = std::ranges::lower_bound(atoms, sequence.next());
    ++counts[static_cast<std::size_t>(found - atoms.begin())];
    for (std::size_t k = 0; k < atoms.size(); ++k)
      farthest = std::max(farthest, std::abs(counts[k] - shares[k] * static_cast<double>(drawn)));
  }
  return farthest;
}

TEST(RadiusSequence, OfQuantilesHasEveryClassWithinOneOfItsShareInEveryPrefix) {
  const auto equal = [](std::size_t k) {
    std::vector<double> radii(k);
    for (std::size_t i = 0; i < k; ++i) radii[i] = 1 + static_cast<double>(i);
    return make_classes(radii, std::vector<double>(k, 1.0), Basis::number);
  };
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<double> five = first(*equal(5), 5, Draw::quantiles, seed);
    std::ranges::sort(five);
    EXPECT_EQ(five, (std::vector<double>{1, 2, 3, 4, 5})) << seed;
  }
  EXPECT_NE(first(*equal(5), 5, Draw::quantiles, 1), first(*equal(5), 5, Draw::quantiles, 2));
  for (const std::size_t k : {2u, 3u, 7u, 30u}) EXPECT_LT(farthest_off(*equal(k), 2000, 3), 1) << k;
  const std::vector<std::vector<double>> unequal = {
      {1, 1, 1, 2, 5}, {0.3, 0.7}, {97, 1, 1, 1}, {1, 2, 3, 4, 5, 6, 7}, {1e-6, 1}, {3, 1e-3, 2, 1e-2, 1, 1}};
  for (const std::vector<double>& shares : unequal) {
    std::vector<double> radii(shares.size());
    for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = 0.5 + static_cast<double>(i);
    for (const Basis basis : {Basis::number, Basis::volume})
      for (const std::uint64_t seed : {1, 2})
        EXPECT_LT(farthest_off(*make_classes(radii, shares, basis), 20'000, seed), 1) << shares.size();
  }
  std::vector<std::unique_ptr<SizeDistribution>> parts;
  parts.push_back(make_constant(2));
  parts.push_back(equal(3));
  EXPECT_LT(farthest_off(*make_mixture(std::move(parts), {1, 1}, Basis::number), 2000, 1), 1);
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

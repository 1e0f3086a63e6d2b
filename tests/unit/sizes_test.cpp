#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "support/size_cases.hpp"

namespace bernal {
namespace sizes_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_draw = 1 - 0x1p-53;  ///< of Random::uniform

class Sizes : public ::testing::TestWithParam<testing::SizeCase> {
 protected:
  std::unique_ptr<SizeDistribution> sizes = GetParam().make();

  std::vector<double> samples(int n) const {
    Random random(1, stream(Stream::test));
    std::vector<double> drawn(n);
    for (double& r : drawn) r = sizes->sample(random);
    return drawn;
  }
};

TEST_P(Sizes, QuantileInvertsCumulative) {
  // quantile(p) is the smallest radius with cumulative(radius) >= p, so just below it less than p lies. A
  // quantile is right to some roundoffs of its radius, a probability to as many times r f(r) <= 1e9 (narrow
  // case).
  const double slack = GetParam().name.ends_with("_narrow") ? 1e-6 : 1e-13;
  for (const double p :
       {1e-12, 1e-6, 0.001, 0.1, 0.2, 0.25, 0.5, 0.7, 0.75, 0.9, 0.999, 1 - 1e-6, 1 - 1e-12}) {
    const double r = sizes->quantile(p);
    EXPECT_GE(sizes->cumulative(r), p - slack) << "p " << p;
    EXPECT_LE(sizes->cumulative(r * (1 - 1e-14)), p + slack) << "p " << p;
  }
}

TEST_P(Sizes, QuantileIsMonotonicAndKeepsItsLimits) {
  EXPECT_EQ(sizes->quantile(0), sizes->min());
  EXPECT_EQ(sizes->quantile(1), sizes->max());
  double previous = sizes->min();
  for (int i = 1; i <= 1000; ++i) {
    const double r = sizes->quantile(i / 1000.0);
    EXPECT_GE(r, previous);
    previous = r;
  }
  EXPECT_EQ(sizes->cumulative(sizes->min() / 2), 0);
  EXPECT_EQ(sizes->cumulative(sizes->max()), 1);
}

TEST_P(Sizes, AtomsAreWhereTheCumulativeJumps) {
  double jumps = 0, previous = 0;
  for (const double atom : sizes->atoms()) {
    EXPECT_GT(atom, previous);
    previous = atom;
    const double jump = sizes->cumulative(atom) - sizes->cumulative(std::nextafter(atom, 0));
    EXPECT_GT(jump, 0) << atom;
    jumps += jump;
  }
  EXPECT_LE(jumps, 1 + 1e-13);
  if (sizes->min() == sizes->max() || GetParam().name.starts_with("classes")) {
    EXPECT_NEAR(jumps, 1, 1e-13);
  }
}

TEST_P(Sizes, EveryDrawIsPositiveAndFinite) {
  for (const double u : {0x1p-54, 0x1p-53, largest_draw}) {
    EXPECT_GT(sizes->quantile(u), 0) << u;
    EXPECT_TRUE(std::isfinite(sizes->quantile(u))) << u;
    EXPECT_GT(sizes->radius_at(u), 0) << u;
    EXPECT_TRUE(std::isfinite(sizes->radius_at(u))) << u;
  }
}

TEST_P(Sizes, MomentsMatchSamples) {
  const std::vector<double> drawn = samples(100'000);
  EXPECT_NEAR(sizes->moment(0), 1, 1e-14);
  for (const int k : {-2, -1, 1, 2, 3}) {
    double mean = 0;
    for (const double r : drawn) mean += std::pow(r, k) / drawn.size();
    const double expected = sizes->moment(k);
    const double variance = std::max(0.0, sizes->moment(2 * k) - expected * expected);
    const double rounding = 1e-10 * expected;  // of 1e5 additions
    EXPECT_NEAR(mean, expected, 4 * std::sqrt(variance / drawn.size()) + rounding) << "k " << k;
  }
}

TEST_P(Sizes, SamplesFollowCumulative) {
  // Kolmogorov and Smirnov: D sqrt(n) exceeds 1.95 with probability 0.001 (less with steps).
  std::vector<double> drawn = samples(100'000);
  std::ranges::sort(drawn);
  const double n = static_cast<double>(drawn.size());
  double largest = 0;
  for (auto it = drawn.begin(); it != drawn.end();) {
    const auto end = std::upper_bound(it, drawn.end(), *it);
    const double before = (it - drawn.begin()) / n, after = (end - drawn.begin()) / n;
    largest = std::max(largest, std::abs(after - sizes->cumulative(*it)));
    largest = std::max(largest, std::abs(before - sizes->cumulative(std::nextafter(*it, 0))));
    it = end;
  }
  EXPECT_LT(largest * std::sqrt(n), 1.95);
}

// The number distribution, weighed with r³ where the user spoke of volume, must be the law that was stated;
// by the midpoint rule over the number of spheres, which is off by at most one midpoint at the jump of each
// indicator.
TEST_P(Sizes, IsTheLawThatWasStated) {
  constexpr int n = 40'000;
  const bool volume = GetParam().basis == Basis::volume;
  std::vector<double> r(n), weight(n);
  double total = 0;
  for (int i = 0; i < n; ++i) {
    r[i] = sizes->quantile((i + 0.5) / n);
    total += weight[i] = volume ? std::pow(r[i], 3) : 1;
  }
  const double tolerance = 2 * weight.back() / total + 1e-6;
  for (const double p : {0.05, 0.3, 0.5, 0.8, 0.97}) {
    const double radius = sizes->quantile(p);
    double below = 0;
    for (int i = 0; i < n; ++i)
      if (r[i] <= radius) below += weight[i];
    EXPECT_NEAR(below / total, GetParam().stated(radius), tolerance) << "radius " << radius;
  }
}

// What lies above a radius, by the midpoint rule over the number of spheres; r^k is monotonic, so the rule is
// off by at most half a step of its whole range, and by another at the radius itself.
TEST_P(Sizes, MomentAboveIsWhatLiesAbove) {
  constexpr int n = 20'000;
  std::vector<double> r(n);
  for (int i = 0; i < n; ++i) r[i] = sizes->quantile((i + 0.5) / n);
  // A radius is right to a roundoff, a probability to r f(r) as many.
  const double slack = GetParam().name.ends_with("_narrow") ? 1e-6 : 2e-13;
  for (const double p : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const double radius = p > 0 ? sizes->quantile(p) : 0;
    EXPECT_NEAR(sizes->moment_above(0, radius), 1 - sizes->cumulative(radius), slack) << radius;
    if (!std::isfinite(sizes->max()) || sizes->min() == 0) continue;
    for (const int k : {-1, 1, 2, 3, 8}) {
      double sum = 0;
      for (const double each : r)
        if (each > radius) sum += std::pow(each, k) / n;
      const double low = std::pow(sizes->min(), k), high = std::pow(sizes->max(), k);
      EXPECT_NEAR(sizes->moment_above(k, radius), sum, 1.5 * std::max(low, high) / n) << radius << " k " << k;
    }
  }
  EXPECT_EQ(sizes->moment_above(2, sizes->max()), 0);
}

// Evenly spread numbers give evenly spread radii: the Kolmogorov distance is a few steps, not sqrt(n) of
// them.
TEST_P(Sizes, EvenNumbersGiveEvenRadii) {
  constexpr int n = 10'000;
  std::vector<double> r(n);
  for (int i = 0; i < n; ++i) r[i] = sizes->radius_at((i + 0.5) / n);
  std::ranges::sort(r);
  for (int i = 0; i < n; ++i) {
    ASSERT_GE(sizes->cumulative(r[i]) * n, i - 4.0);
    ASSERT_LE(sizes->cumulative(r[i] * (1 - 1e-14)) * n, i + 5.0);
  }
}

TEST_P(Sizes, MomentsLieBetweenThePowersOfTheLimits) {
  for (const int k : {-3, 1, 2, 3, 4, 6}) {
    const double low = std::pow(sizes->min(), k), high = std::pow(sizes->max(), k);
    EXPECT_GE(sizes->moment(k), std::min(low, high) * (1 - 1e-13)) << k;
    EXPECT_LE(sizes->moment(k), std::max(low, high) * (1 + 1e-13)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sizes, ::testing::ValuesIn(testing::size_cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace sizes_test
}  // namespace bernal

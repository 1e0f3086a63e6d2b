#include "bernal/measure/size_comparison.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bernal/core/random.hpp"

namespace bernal {
namespace size_comparison_test {

std::vector<double> drawn(const SizeDistribution& sizes, std::size_t n, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  std::vector<double> radii;
  while (radii.size() < n) radii.push_back(sizes.sample(random));
  return radii;
}

TEST(SizeComparison, TheStatisticIsTheLargestDistance) {
  // Uniform on [1, 2]: the empirical distribution of 1.1, 1.2, 1.9 steps to 2/3 at 1.2, where 0.2 is asked.
  const auto uniform = make_uniform(1, 2, Basis::number);
  const SizeComparison c = compare_sizes(std::vector{1.9, 1.1, 1.2}, *uniform, 3);
  EXPECT_NEAR(c.ks_statistic, 2.0 / 3 - 0.2, 1e-10);
  EXPECT_NEAR(c.mean_radius, 1.4, 1e-12);
  EXPECT_NEAR(c.asked_mean_radius, 1.5, 1e-12);
  EXPECT_NEAR(c.volume_ratio, (std::pow(1.1, 3) + std::pow(1.2, 3) + std::pow(1.9, 3)) / 3 / 3.75, 1e-12);
}

TEST(SizeComparison, PValuesOfIdealSamplesAreUniform) {
  // 400 of them against the uniform distribution, by the same test once more: above 1.63 / √400 in one case
  // of a hundred. And the published 5 % point of Kolmogorov's distribution, 1.3581.
  for (const bool lognormal : {false, true}) {
    const auto sizes =
        lognormal ? make_lognormal(1, 0.3, Basis::volume, 0, HUGE_VAL) : make_uniform(1, 2, Basis::volume);
    std::vector<double> p;
    for (std::uint64_t seed = 1; seed <= 400; ++seed)
      p.push_back(compare_sizes(drawn(*sizes, 300, seed), *sizes, 3).ks_p_value.value());
    std::ranges::sort(p);
    double distance = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      distance = std::max({distance, std::abs(p[i] - static_cast<double>(i) / 400),
                           std::abs(p[i] - static_cast<double>(i + 1) / 400)});
    EXPECT_LT(distance, 1.63 / 20);
  }
}

TEST(SizeComparison, KnowsThePublishedPointsOfKolmogorovsDistribution) {
  // n radii at the quantiles (i + shift) / n have the statistic max(shift, 1 - shift) / n; a million of them
  // make the finite-N correction small. Points of the limit: 0.8276 at 50 %, 1.2238 at 10 %, 1.3581 at 5
  // %, 1.6276 at 1 %.
  const auto uniform = make_uniform(1, 2, Basis::number);
  for (const auto& [lambda, above] :
       {std::pair{0.8276, 0.5}, {1.2238, 0.1}, {1.3581, 0.05}, {1.6276, 0.01}}) {
    constexpr int n = 100'000;
    std::vector<double> radii;
    for (int i = 0; i < n; ++i)
      radii.push_back(uniform->quantile(std::min(1.0, (i + 0.5) / n + lambda / std::sqrt(n))));
    const SizeComparison c = compare_sizes(radii, *uniform, 3);
    EXPECT_NEAR(c.ks_p_value.value(), above, 0.01 * above + 1e-3) << lambda;
  }
}

TEST(SizeComparison, NoticesTheWrongDistribution) {
  const auto asked = make_lognormal(1, 0.3, Basis::number, 0, HUGE_VAL);
  const auto other = make_lognormal(1, 0.27, Basis::number, 0, HUGE_VAL);
  EXPECT_LT(compare_sizes(drawn(*other, 10'000, 1), *asked, 3).ks_p_value.value(), 1e-3);
}

TEST(SizeComparison, OfOneSizeHasNoPValue) {
  const auto constant = make_constant(0.1);
  for (const std::size_t n : {1, 100}) {
    const SizeComparison c = compare_sizes(std::vector<double>(n, 0.1), *constant, 3);
    EXPECT_EQ(c.ks_statistic, 0);
    EXPECT_FALSE(c.ks_p_value);
    EXPECT_FALSE(c.chi_squared_p_value);
    ASSERT_EQ(c.classes.size(), 1u);
    EXPECT_EQ(c.classes[0].count, n);
    EXPECT_NEAR(c.volume_ratio, 1, 1e-12);
  }
}

TEST(SizeComparison, OfClassesCountsThem) {
  const auto asked = make_classes({1, 2, 4}, {5, 3, 2}, Basis::number);
  std::vector<double> radii(50, 1);
  radii.insert(radii.end(), 36, 2);
  radii.insert(radii.end(), 14, 4);
  const SizeComparison c = compare_sizes(radii, *asked, 2);
  EXPECT_NEAR(c.ks_statistic, 0.06, 1e-12);
  EXPECT_FALSE(c.ks_p_value);
  EXPECT_NEAR(c.chi_squared, 36.0 / 30 + 36.0 / 20, 1e-9);
  EXPECT_NEAR(c.chi_squared_p_value.value(), std::exp(-1.5), 1e-9);  // two degrees of freedom
  ASSERT_EQ(c.classes.size(), 3u);
  EXPECT_EQ(c.classes[1].count, 36u);
  EXPECT_NEAR(c.classes[1].asked_share, 0.3, 1e-12);
  // Too few to judge.
  EXPECT_FALSE(compare_sizes(std::vector<double>{1, 2, 4}, *asked, 2).chi_squared_p_value);
}

TEST(SizeComparison, QuantilesAreTheSmallestRadiiThatReachTheShare) {
  const auto uniform = make_uniform(1, 2, Basis::number);
  std::vector<double> radii;
  for (int i = 1; i <= 100; ++i) radii.push_back(1 + i / 100.0);
  const SizeComparison c = compare_sizes(radii, *uniform, 3);
  for (const auto& q : c.quantiles) {
    EXPECT_NEAR(q.asked, 1 + q.share, 1e-12);
    EXPECT_NEAR(q.realised, std::max(1.01, 1 + q.share), 1e-9);
  }
  EXPECT_EQ(compare_sizes(radii, *make_lognormal(1, 1, Basis::number, 0, HUGE_VAL), 3).quantiles.back().asked,
            HUGE_VAL);
}

/// The first n radii of the sequence that lie at or below `cut`, last first.
std::vector<double> first_of(RadiusSequence sequence, std::size_t n, double cut = HUGE_VAL) {
  std::vector<double> radii;
  while (radii.size() < n)
    if (const double r = sequence.next(); r <= cut) radii.push_back(r);
  std::ranges::reverse(radii);
  return radii;
}

TEST(DrawnComparison, OfTheSequenceLessItsTailIsZeroToTheBit) {
  const auto sizes = make_lognormal(1, 0.3, Basis::number, 0, HUGE_VAL);
  for (const Draw draw : {Draw::random, Draw::quantiles}) {
    const RadiusSequence sequence(*sizes, 7, draw);
    for (const std::size_t n : {1, 1000}) {
      const DrawnComparison same = compare_with_drawn(first_of(sequence, n), sequence, false).value();
      EXPECT_EQ(same.missing, 0u);
      EXPECT_EQ(same.largest_deviation, 0);
      EXPECT_EQ(same.above_largest, 0u);
    }
    // Another seed has other radii.
    EXPECT_GT(compare_with_drawn(first_of({*sizes, 8, draw}, 1000), sequence, false)->missing, 900u);
  }
}

TEST(DrawnComparison, ShowsOneSphereThatWasLeftOut) {
  const auto sizes = make_uniform(1, 2, Basis::number);
  const RadiusSequence sequence(*sizes, 1, Draw::random);
  std::vector<double> radii = first_of(sequence, 101);
  const auto largest = std::ranges::max_element(radii.begin() + 1, radii.end());
  const double left_out = *largest;
  radii.erase(largest);
  const DrawnComparison drawn = compare_with_drawn(radii, sequence, false).value();
  EXPECT_EQ(drawn.missing, 1u);
  EXPECT_GT(drawn.largest_deviation, 0);
  EXPECT_LE(drawn.largest_deviation, left_out - 1);
}

TEST(DrawnComparison, PassesOverDrawsThatAContainerRefused) {
  const auto sizes = make_lognormal(1, 0.5, Basis::number, 0, HUGE_VAL);
  const RadiusSequence sequence(*sizes, 1, Draw::random);
  const std::vector<double> radii = first_of(sequence, 1000, 2);
  const DrawnComparison drawn = compare_with_drawn(radii, sequence, true).value();
  EXPECT_EQ(drawn.missing, 0u);
  EXPECT_GT(drawn.above_largest, 50u);  // 8 % of all
  EXPECT_GT(compare_with_drawn(radii, sequence, false)->missing, 50u);
  // Nothing to compare with where the radii are of another order of magnitude.
  EXPECT_FALSE(compare_with_drawn(std::vector<double>(10, 1e-3), sequence, true));
}

}  // namespace size_comparison_test
}  // namespace bernal

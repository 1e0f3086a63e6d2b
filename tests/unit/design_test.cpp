#include "bernal/predict/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace design_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

SearchOptions with_rods(int rods) {
  SearchOptions options;
  options.rods = rods;
  return options;
}

Optimum densest(const std::vector<double>& radii, int rods = 4000) {
  return maximise_packing_fraction(radii, with_rods(rods));
}

/// The packing fraction of classes with these shares of the volume, any of them zero.
double phi_of(const std::vector<double>& radii, const std::vector<double>& shares, int rods) {
  std::vector<double> of, amounts;
  for (std::size_t k = 0; k < radii.size(); ++k)
    if (shares[k] > 0) {
      of.push_back(radii[k]);
      amounts.push_back(shares[k]);
    }
  return predict_packing_fraction(*make_classes(of, amounts, Basis::volume), rods).phi;
}

void expect_whole(const Optimum& found, const std::vector<double>& radii, int rods) {
  ASSERT_EQ(found.shares.size(), radii.size());
  EXPECT_NEAR(std::accumulate(found.shares.begin(), found.shares.end(), 0.0), 1, 1e-12);
  EXPECT_GE(std::ranges::min(found.shares), 0);
  EXPECT_NEAR(phi_of(radii, found.shares, rods), found.prediction.phi, 1e-12);
  EXPECT_EQ(found.prediction.rods, rods);
  EXPECT_GE(found.agreeing, 1);
  EXPECT_LE(found.agreeing, found.starts);
  EXPECT_GE(found.spread, 0);
}

TEST(Maximise, TwoSizesAgreeWithEveryCompositionTried) {
  for (const double ratio : {1.4, 2.0, 3.0, 5.0, 10.0, 30.0}) {
    SCOPED_TRACE(ratio);
    const Optimum found = densest({1, ratio});
    expect_whole(found, {1, ratio}, 4000);
    double best = 0;
    for (int k = 1; k < 2000; ++k)
      best = std::max(best, phi_of({1, ratio}, {k / 2000.0, 1 - k / 2000.0}, 4000));
    EXPECT_GT(found.prediction.phi, best - 1e-7);
    // |dphi/dw| is below 3 beside the maximum, where the curve is steepest: half a step is below 8e-4.
    EXPECT_LT(found.prediction.phi, best + 8e-4);
  }
}

TEST(Maximise, ThreeSizesAgreeWithEveryCompositionTried) {
  constexpr int rods = 1000, steps = 100;
  for (const std::vector<double>& radii : {std::vector<double>{1, 2, 4}, {1, 3, 9}, {1, 5, 25}, {3, 4, 12}}) {
    SCOPED_TRACE(radii[1] / radii[0]);
    const Optimum found = densest(radii, rods);
    expect_whole(found, radii, rods);
    double best = 0;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        best = std::max(
            best, phi_of(radii, {1.0 * i / steps, 1.0 * j / steps, 1.0 * (steps - i - j) / steps}, rods));
    EXPECT_GT(found.prediction.phi, best - 1e-6);
  }
}

TEST(Maximise, TwoSizesAsTabulated) {
  // Rods 4000, four digits: no tabulated composition is denser, and the nearest are less dense by what a step
  // of the table costs.
  const struct {
    double ratio, share, phi, share_of_best;
  } table[] = {{1.4, .3, .6527, .39},
               {2, .3, .6819, .286},
               {3, .25, .7290, .221},
               {5, .2, .7873, .208},
               {10, .25, .8267, .240}};
  for (const auto& row : table) {
    SCOPED_TRACE(row.ratio);
    const Optimum found = densest({1, row.ratio});
    EXPECT_GT(found.prediction.phi, row.phi - 0.5e-4);
    EXPECT_LT(found.prediction.phi, row.phi + 1.5e-3);
    EXPECT_NEAR(found.shares[0], row.share_of_best, 3e-3);
    EXPECT_EQ(found.agreeing, found.starts);
  }
}

TEST(Maximise, InfiniteRatioStaysAtTheLimitOfTheModel) {
  // 0.8595 in the rod model, where 1 - (1 - phi)² = 0.8729 is exact. At ratio 100 nearly there; too few rods
  // for the large spheres must not look like density.
  const Optimum far = densest({1, 100}, 16000);
  EXPECT_NEAR(far.prediction.phi, 0.857, 0.001);
  EXPECT_NEAR(far.shares[0], 0.2628, 0.01);
  EXPECT_LT(densest({1, 1000}, 16000).prediction.phi, 0.8605);
  EXPECT_THROW(densest({1, 1001}, 16000), Error);
}

TEST(Maximise, ScaleAndOrderDoNotMatter) {
  const Optimum some = densest({1, 3, 9});
  const Optimum scaled = densest({1e-6, 3e-6, 9e-6});
  const Optimum turned = densest({9, 1, 3});
  EXPECT_NEAR(scaled.prediction.phi, some.prediction.phi, 1e-6);
  EXPECT_EQ(turned.prediction.phi, some.prediction.phi);
  EXPECT_EQ(turned.shares, (std::vector<double>{some.shares[2], some.shares[0], some.shares[1]}));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(scaled.shares[k], some.shares[k], 2e-3);
}

TEST(Maximise, ASizeMoreNeverHurtsAndASizeTwiceGainsNothing) {
  const double two = densest({1, 5}).prediction.phi;
  EXPECT_GT(densest({1, 5, 25}).prediction.phi, two + 0.05);
  const Optimum twice = densest({1, 5, 5});
  EXPECT_NEAR(twice.prediction.phi, two, 1e-6);
  EXPECT_NEAR(twice.shares[0], 0.208, 3e-3);
  EXPECT_NEAR(densest({2, 2}).prediction.phi, 0.6434855, 1e-5);
  // Between 1 and 4 a size of 2 only gets in the way: it is left out.
  const Optimum left_out = densest({1, 2, 4});
  EXPECT_LT(left_out.shares[1], 1e-4);
  EXPECT_NEAR(left_out.prediction.phi, densest({1, 4}).prediction.phi, 1e-6);
}

TEST(Maximise, BeginsWhereItIsTold) {
  const Optimum whole = densest({1, 3, 9});
  SearchOptions options = with_rods(4000);
  options.from = {17, 9, 74};
  const Optimum near = maximise_packing_fraction(std::vector<double>{1, 3, 9}, options);
  EXPECT_EQ(near.starts, 1);
  EXPECT_NEAR(near.prediction.phi, whole.prediction.phi, 1e-6);
  EXPECT_LT(near.evaluations, whole.evaluations / 4);
  options.from = {1, 1};
  EXPECT_THROW(maximise_packing_fraction(std::vector<double>{1, 3, 9}, options), Error);
  options.from = {1, 1, -1};
  EXPECT_THROW(maximise_packing_fraction(std::vector<double>{1, 3, 9}, options), Error);
}

TEST(Maximise, LognormalPopulations) {
  // Two populations of one width are densest where two classes are, more or less, and denser than either.
  const MixtureOf mixture = [](std::span<const double> shares) {
    std::vector<std::unique_ptr<SizeDistribution>> of;
    std::vector<double> amounts;
    for (std::size_t k = 0; k < 2; ++k)
      if (shares[k] > 0) {
        of.push_back(make_lognormal(k == 0 ? 1 : 6, 0.3, Basis::volume, 0, infinity));
        amounts.push_back(shares[k]);
      }
    return make_mixture(std::move(of), std::move(amounts), Basis::volume);
  };
  const Optimum found = maximise_packing_fraction(mixture, 2, with_rods(1000));
  double best = 0;
  for (int k = 0; k <= 200; ++k)
    best =
        std::max(best, predict_packing_fraction(*mixture(std::vector{k / 200.0, 1 - k / 200.0}), 1000).phi);
  EXPECT_GT(found.prediction.phi, best - 1e-7);
  EXPECT_LT(found.prediction.phi, best + 1e-4);
}

TEST(Maximise, IsDeterministicAndStopsWhenAsked) {
  const Optimum once = densest({1, 4, 16}), again = densest({1, 4, 16});
  EXPECT_EQ(once.shares, again.shares);
  EXPECT_EQ(once.evaluations, again.evaluations);

  SearchOptions options = with_rods(4000);
  int asked = 0, told = 0;
  options.monitor.cancelled = [&] { return ++asked > 200; };
  options.monitor.on_progress = [&](const Progress& p) {
    ++told;
    EXPECT_GE(p.fraction, 0);
    EXPECT_LE(p.fraction, 1);
  };
  const Optimum cut = maximise_packing_fraction(std::vector<double>{1, 4, 16}, options);
  EXPECT_TRUE(cut.cancelled);
  EXPECT_FALSE(once.cancelled);
  EXPECT_GE(told, 1);
  EXPECT_LT(cut.evaluations, once.evaluations);
  EXPECT_GT(cut.prediction.phi, 0.75);
}

TEST(Maximise, RefusesWhatIsNoQuestion) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& radii : {std::vector<double>{},
                                           {1},
                                           {1, 2, 3, 4, 5, 6, 7},
                                           {1, 0},
                                           {1, -2},
                                           {1, nan},
                                           {1, infinity},
                                           {1, 1e-90}})
    EXPECT_THROW(densest(radii), Error) << radii.size();
  EXPECT_THROW(densest({1, 2}, 1), Error);
  const MixtureOf wrong = [](std::span<const double>) -> std::unique_ptr<SizeDistribution> {
    throw Error(ErrorCode::bad_argument, "no such mixture");
  };
  EXPECT_THROW(maximise_packing_fraction(wrong, 2), Error);
}

std::unique_ptr<SizeDistribution> lognormal(double sigma) {
  return make_lognormal(1, sigma, Basis::volume, 0, infinity);
}

TEST(Match, FindsTheWidthOfLognormalSizes) {
  // Farr 2013, table 1, read backwards; the slope there is above 0.1, the digits 1e-7.
  EXPECT_NEAR(match_packing_fraction(lognormal, 1e-3, 3, 0.7072591).parameter, 0.5, 2e-6);
  EXPECT_NEAR(match_packing_fraction(lognormal, 1e-3, 3, 0.8013511).parameter, 1.0, 2e-6);
  for (const double target : {0.6435, 0.65, 0.7, 0.75, 0.9}) {
    const Match match = match_packing_fraction(lognormal, 1e-3, 3, target, 4000);
    ASSERT_TRUE(match.found) << target;
    EXPECT_NEAR(match.prediction.phi, target, 1e-7);
    EXPECT_NEAR(predict_packing_fraction(*lognormal(match.parameter), 4000).phi, target, 1e-7);
  }
}

TEST(Match, TakesTheFirstOfTwo) {
  // Two sizes of one ratio pack equally well with fewer small ones than at best and with more.
  const FamilyOf small_share = [](double w) { return make_classes({1, 5}, {w, 1 - w}, Basis::volume); };
  const Match fewer = match_packing_fraction(small_share, 0.01, 0.99, 0.75, 4000);
  const Match more = match_packing_fraction(small_share, 0.99, 0.01, 0.75, 4000);
  ASSERT_TRUE(fewer.found && more.found);
  EXPECT_LT(fewer.parameter, 0.2083);
  EXPECT_GT(more.parameter, 0.2083);
  EXPECT_NEAR(fewer.prediction.phi, more.prediction.phi, 2e-7);
}

TEST(Match, FindsWhatOnlyTheTopOfAHumpReaches) {
  const FamilyOf small_share = [](double w) { return make_classes({1, 5}, {w, 1 - w}, Basis::volume); };
  // The maximum is 0.7877872; steps of 0.03 beside it reach 0.786.
  const Match match = match_packing_fraction(small_share, 0.01, 0.99, 0.7877, 4000);
  ASSERT_TRUE(match.found);
  EXPECT_NEAR(match.parameter, 0.2083, 5e-3);
  const Match beyond = match_packing_fraction(small_share, 0.01, 0.99, 0.7879, 4000);
  EXPECT_FALSE(beyond.found);
  EXPECT_NEAR(beyond.most, 0.7877872, 1e-6);
  EXPECT_NEAR(beyond.at_most, 0.2083, 1e-3);
}

TEST(Match, SaysWhatTheFamilyReaches) {
  const Match loose = match_packing_fraction(lognormal, 1e-3, 1, 0.6, 4000);
  EXPECT_FALSE(loose.found);
  EXPECT_NEAR(loose.least, 0.6434855, 1e-5);
  EXPECT_NEAR(loose.most, predict_packing_fraction(*lognormal(1), 4000).phi, 1e-9);
  EXPECT_EQ(loose.at_most, 1);
  // A family that jumps over the target has no member there.
  const FamilyOf jump = [](double x) { return x < 0.5 ? make_constant(1) : lognormal(0.5); };
  EXPECT_FALSE(match_packing_fraction(jump, 0, 1, 0.68, 1000).found);
}

TEST(Match, RefusesWhatIsNoPackingFraction) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double target : {0.0, 1.0, -0.5, 1.5, nan, infinity})
    EXPECT_THROW(match_packing_fraction(lognormal, 0.1, 1, target), Error) << target;
  EXPECT_THROW(match_packing_fraction(lognormal, 1, 1, 0.7), Error);
  EXPECT_THROW(match_packing_fraction(lognormal, 0.1, infinity, 0.7), Error);
  EXPECT_THROW(match_packing_fraction(lognormal, 0.1, 1, 0.7, 1), Error);
}

TEST(DensestSizes, TwoAreTheEndsAndMoreGainLessAndLess) {
  const double two = densest({1, 10}).prediction.phi;
  double last = 0;
  for (int count = 2; count <= 4; ++count) {
    const DensestSizes found = densest_sizes(1, 10, count, with_rods(4000));
    ASSERT_EQ(found.radii.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(found.radii.front(), 1);
    EXPECT_EQ(found.radii.back(), 10);
    EXPECT_TRUE(std::ranges::is_sorted(found.radii));
    expect_whole(found.optimum, found.radii, 4000);
    if (count == 2) {
      EXPECT_NEAR(found.optimum.prediction.phi, two, 1e-5);
    }
    EXPECT_GT(found.optimum.prediction.phi, last - 1e-5);
    last = found.optimum.prediction.phi;
  }
  // Every position of a third size on a grid, each at its best composition.
  double best = 0;
  for (int k = 1; k < 20; ++k)
    best = std::max(best, densest({1, std::pow(10, k / 20.0), 10}, 1000).prediction.phi);
  EXPECT_GT(densest_sizes(1, 10, 3, with_rods(1000)).optimum.prediction.phi, best - 1e-5);
}

TEST(DensestDensity, GathersIntoPeaksAsBinsNarrow) {
  const DensestDensity found = densest_density(2, 6, 8, with_rods(4000));
  ASSERT_EQ(found.levels.size(), 3u);
  ASSERT_EQ(found.radii.size(), 9u);
  EXPECT_NEAR(found.radii.front(), 2, 1e-12);
  EXPECT_NEAR(found.radii.back(), 6, 1e-12);
  EXPECT_LT(found.levels[0].phi, found.levels[1].phi);
  EXPECT_LT(found.levels[1].phi, found.levels[2].phi);
  std::vector<double> passing = {0};
  for (const double share : found.optimum.shares) passing.push_back(passing.back() + share);
  EXPECT_NEAR(passing.back(), 1, 1e-9);
  EXPECT_NEAR(predict_packing_fraction(*make_sieve(found.radii, passing), 4000).phi,
              found.optimum.prediction.phi, 1e-12);
  // At ratio 3: the outermost bins only, and less dense than the two sizes that they surround.
  for (std::size_t k = 1; k < 7; ++k) EXPECT_LT(found.optimum.shares[k], 1e-3);
  EXPECT_LT(found.optimum.prediction.phi, densest({1, 3}).prediction.phi);
  EXPECT_GT(found.optimum.prediction.phi, found.power_law_phi + 0.03);
}

TEST(DensestDensity, TwoBinsAgreeWithEveryDensityTried) {
  const DensestDensity found = densest_density(1, 4, 2, with_rods(1000));
  double best = 0;
  for (int k = 0; k <= 100; ++k)
    best = std::max(best, predict_packing_fraction(*make_sieve({1, 2, 4}, {0, k / 100.0, 1}), 1000).phi);
  // The search has 128 classes in place of the bins.
  EXPECT_NEAR(found.optimum.prediction.phi, best, 1e-4);
  EXPECT_GT(found.optimum.prediction.phi, found.power_law_phi - 1e-4);
}

TEST(DensestDensity, RefusesWhatIsNoQuestion) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [min, max] : {std::pair(0.0, 1.0), {1, 1}, {2, 1}, {nan, 1}, {1, infinity}, {1, 300}}) {
    EXPECT_THROW(densest_density(min, max, 2, with_rods(4000)), Error) << min << ' ' << max;
    EXPECT_THROW(densest_sizes(min, max, 2, with_rods(4000)), Error) << min << ' ' << max;
  }
  for (const int bins : {-2, 0, 1, 3, 128}) EXPECT_THROW(densest_density(1, 2, bins), Error) << bins;
  for (const int count : {-1, 1, 7}) EXPECT_THROW(densest_sizes(1, 2, count), Error) << count;
}

}  // namespace design_test
}  // namespace bernal

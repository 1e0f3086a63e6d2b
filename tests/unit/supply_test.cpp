#include "work/supply.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "bernal/core/error.hpp"

namespace bernal {
namespace supply_test {

Target count_of(std::int64_t n) {
  Target target;
  target.count = n;
  return target;
}
Target fraction_of(double phi) {
  Target target;
  target.packing_fraction = phi;
  return target;
}
Target fill() {
  Target target;
  target.fill = true;
  return target;
}

/// The first n radii that the seed draws, in units of `scale`.
std::vector<double> drawn(const SizeDistribution& sizes, std::size_t n, std::uint64_t seed,
                          double scale = 1) {
  Random random(seed, stream(Stream::radii));
  std::vector<double> radii;
  while (radii.size() < n) radii.push_back(sizes.sample(random) / scale);
  return radii;
}

std::vector<double> radii_of(const Supply& supply) {
  std::vector<double> radii;
  for (std::uint32_t tag = 0; tag < supply.wanted(); ++tag) radii.push_back(supply.radius(tag));
  return radii;
}

double volume_of(const std::vector<double>& radii) {
  double sum = 0;
  for (const double r : radii) sum += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return sum;
}

const std::unique_ptr<SizeDistribution> uniform = make_uniform(0.01, 0.02, Basis::number);

TEST(Supply, OfACountIsThatManyDrawnRadii) {
  const Supply supply({.radii = *uniform, .seed = 7}, 1, count_of(500));
  EXPECT_EQ(radii_of(supply), drawn(*uniform, 500, 7));
  const std::vector<double> radii = radii_of(supply);
  EXPECT_EQ(supply.smallest(), std::ranges::min(radii));
  EXPECT_EQ(supply.largest(), std::ranges::max(radii));
}

TEST(Supply, SpeaksThePackersLengths) {
  Supply supply({.radii = *uniform, .seed = 7}, 1, count_of(50));
  supply.divide_by(0.25);
  EXPECT_EQ(radii_of(supply), drawn(*uniform, 50, 7, 0.25));
}

TEST(Supply, OfAPackingFractionIsTheShortestSequenceThatHasIt) {
  const double volume = 3, scale = 2;
  Supply supply({.radii = *uniform, .seed = 7}, scale * scale * scale * volume, fraction_of(0.01));
  supply.divide_by(scale);
  std::vector<double> radii = radii_of(supply);
  EXPECT_EQ(radii, drawn(*uniform, radii.size(), 7, scale));
  EXPECT_GE(volume_of(radii), 0.01 * volume);
  radii.pop_back();
  EXPECT_LT(volume_of(radii), 0.01 * volume);
}

TEST(Supply, OfAFillIsMoreThanAnyPackingHolds) {
  const Supply supply({.radii = *uniform, .seed = 7}, 0.1, fill());
  const std::vector<double> radii = radii_of(supply);
  EXPECT_EQ(radii, drawn(*uniform, radii.size(), 7));
  EXPECT_GT(volume_of(radii), 0.9 * 0.1);
  EXPECT_LT(volume_of(radii), 1.1 * 0.1);
}

TEST(Supply, DrawsOtherRadiiForAnotherSeed) {
  const Supply one({.radii = *uniform, .seed = 1}, 1, count_of(10)),
      other({.radii = *uniform, .seed = 2}, 1, count_of(10));
  EXPECT_NE(radii_of(one), radii_of(other));
}

TEST(Supply, DrawsByQuantilesWhereToldTo) {
  Supply supply({.radii = *uniform, .seed = 7, .draw = Draw::quantiles}, 1, count_of(50));
  supply.divide_by(0.25);
  RadiusSequence sequence(*uniform, 7, Draw::quantiles);
  for (const double r : radii_of(supply)) EXPECT_EQ(r, sequence.next() / 0.25);
}

TEST(Supply, DrawsAgainWhatIsAboveTheCutAndCountsIt) {
  const double cut = 0.018;
  const Supply supply({.radii = *uniform, .seed = 7, .cut = cut}, 1, count_of(500));
  std::vector<double> expected;
  std::size_t above = 0;
  for (const double r : drawn(*uniform, 2000, 7)) {
    if (expected.size() == 500) break;
    if (r > cut) {
      ++above;
    } else {
      expected.push_back(r);
    }
  }
  EXPECT_EQ(radii_of(supply), expected);
  EXPECT_EQ(supply.cut_off(), above);
  EXPECT_NEAR(static_cast<double>(above), 125, 60);  // a fifth of 625 draws; 60 is six standard deviations
}

TEST(Supply, RefusesMoreSpheresThanHaveIds) {
  const auto tiny = make_constant(1e-5);
  try {
    const Supply supply({.radii = *tiny}, 1, fill());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
  }
}

TEST(Supply, EqualSpheresComeOneAfterTheOther) {
  const auto equal = make_constant(0.01);
  Supply supply({.radii = *equal}, 1, count_of(3));
  for (std::uint32_t tag = 0; tag < 3; ++tag) {
    EXPECT_FALSE(supply.exhausted());
    EXPECT_EQ(supply.window(), std::vector<std::uint32_t>{tag});
    EXPECT_EQ(supply.first_missing(), tag);
    supply.take(0);
  }
  EXPECT_TRUE(supply.exhausted());
  EXPECT_EQ(supply.first_missing(), 3u);
  EXPECT_EQ(supply.passed_over(), 0u);
}

/// What was taken and what was not, told by the caller's own book.
TEST(Supply, OffersAnAscendingWindowOfWhatIsMissing) {
  constexpr std::size_t n = 2000;
  Supply supply({.radii = *uniform, .seed = 7}, 1, count_of(n));
  const std::size_t width = supply.window().size();
  EXPECT_GT(width, 1u);
  EXPECT_LT(width, n / 20);
  Random random(1, stream(Stream::test));
  std::vector<char> taken(n, 0);
  for (std::size_t count = 0; count < n; ++count) {
    ASSERT_FALSE(supply.exhausted());
    const std::vector<std::uint32_t>& window = supply.window();
    EXPECT_EQ(window.size(), std::min(width, n - count));
    EXPECT_TRUE(std::ranges::is_sorted(window));
    for (const std::uint32_t tag : window) EXPECT_FALSE(taken[tag]);
    const auto missing = static_cast<std::size_t>(std::ranges::find(taken, 0) - taken.begin());
    EXPECT_EQ(supply.first_missing(), missing);

    std::size_t last = n;
    while (last > 0 && !taken[last - 1]) --last;
    const auto passed = static_cast<std::size_t>(
        std::ranges::count(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(last), 0));
    EXPECT_EQ(supply.passed_over(), passed);
    EXPECT_LT(supply.passed_over(), width + (count == 0));

    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(window.size()));
    taken[window[k]] = 1;
    supply.take(k);
    if (HasFailure()) return;
  }
  EXPECT_TRUE(supply.exhausted());
  EXPECT_EQ(supply.first_missing(), n);
}

TEST(Supply, WhatWasTakenFirstNeverComesAgain) {
  constexpr std::size_t n = 500;
  Supply supply({.radii = *uniform, .seed = 7}, 1, count_of(n));
  const std::vector<std::uint32_t> first{0, 3, 4, 250, n - 1};
  supply.take_first(first);
  EXPECT_EQ(supply.passed_over(), 0u);
  EXPECT_FALSE(supply.trimming_is_cheap());
  std::vector<std::uint32_t> tags = first;
  while (!supply.exhausted()) {
    tags.push_back(supply.window().front());
    supply.take(0);
  }
  std::ranges::sort(tags);
  EXPECT_EQ(tags.size(), n);
  EXPECT_EQ(std::ranges::adjacent_find(tags), tags.end());
}

TEST(Supply, TrimmingIsCheapWhereFewStandBeyondTheFirstMissing) {
  Supply supply({.radii = *uniform, .seed = 7}, 1, count_of(2000));
  for (int k = 0; k < 1000; ++k) supply.take(0);
  EXPECT_TRUE(supply.trimming_is_cheap());
  supply.take(1);  // one of 1,001
  EXPECT_EQ(supply.passed_over(), 1u);
  EXPECT_TRUE(supply.trimming_is_cheap());
  for (int k = 0; k < 500; ++k) supply.take(1);  // a third of all would have to go
  EXPECT_EQ(supply.passed_over(), 1u);
  EXPECT_FALSE(supply.trimming_is_cheap());
}

}  // namespace supply_test
}  // namespace bernal

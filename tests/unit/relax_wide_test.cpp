#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "plan/stages.hpp"
#include "soft/relax_wide.hpp"
#include "soft/soft_packing.hpp"
#include "support/plans.hpp"
#include "support/starts.hpp"

namespace bernal {
namespace relax_wide_test {

Plan plan_with(const std::string& sizes, int count, const std::string& stage = "", int seed = 1) {
  return testing::plan_of(
      fmt::format("seed = {}\n[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\ndiameter = {}\n"
                  "draw = \"quantiles\"\n[[stage]]\ndo = \"relax\"\n{}\n",
                  seed, count, sizes, stage));
}

std::string two_sizes(double ratio, double small) {
  return fmt::format(
      "{{ distribution = \"classes\", values = [1, {}], shares = [{}, {}], basis = \"volume\" }}", ratio,
      small, 1 - small);
}

TEST(WideSizes, AreThoseBeyondLognormalOnesOfOneHalf) {
  const auto is_wide = [](const std::string& sizes) {
    const Plan plan = plan_with(sizes, 100);
    return is_for_wide_sizes(fill_task_of(plan), Relax{});
  };
  EXPECT_FALSE(is_wide("1.0"));
  EXPECT_FALSE(is_wide("{ distribution = \"lognormal\", median = 1.0, sigma = 0.5 }"));
  EXPECT_TRUE(is_wide("{ distribution = \"lognormal\", median = 1.0, sigma = 0.6 }"));
  EXPECT_FALSE(is_wide(two_sizes(2, 0.3)));
  EXPECT_TRUE(is_wide(two_sizes(5, 0.2)));
  EXPECT_TRUE(is_wide("{ distribution = \"fuller\", min = 0.1, max = 1, exponent = 0.5 }"));
}

/// Every image of every pair, brute force.
double largest_overlap(const Spheres<3>& spheres, const Vector<3>& edges) {
  double largest = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < spheres.size(); ++j)
      for (int image = 0; image < 125; ++image) {
        if (i == j && image == 62) continue;
        const Vector<3> shift(image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2);
        const Vector<3> away = spheres.center(i) - spheres.center(j) + edges.cwiseProduct(shift);
        largest = std::max(largest, 1 - away.norm() / (spheres.r[i] + spheres.r[j]));
      }
  return largest;
}

/// In a box that grows by what still overlaps, until nothing does, for so many cycles at most; still narrow
/// then.
void expect_parted(Spheres<3> spheres, const Vector<3>& edges, int cycles) {
  SoftPacking packing(spheres, edges, soft_kernels().front(), true);
  double met = 1;
  for (int cycle = 0; cycle < cycles && met > 1e-5; ++cycle) {
    for (int k = 0; k < 20; ++k) packing.sweep(5);
    met = packing.sweep_and_measure(5);
    packing.grow(1 + met / 30);
  }
  Vector<3> grown;
  packing.write_to(spheres, grown);
  EXPECT_LE(met, 1e-5);
  EXPECT_LT(largest_overlap(spheres, grown), 3e-5);  // what one sweep moves, and single precision
  EXPECT_LT(grown.minCoeff(), 4);
}

TEST(SeveralImages, AreMetInBoxesNarrowerThanTwoSpheres) {
  Random random(3, stream(Stream::test));
  Spheres<3> spheres;
  const Vector<3> edges(2.3, 2.1, 2.6);
  for (int i = 0; i < 40; ++i)
    spheres.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), edges}), i < 2 ? 1.0 : 0.1);
  // The two large ones, nearest across the middle, meet each other on the far side, too.
  spheres.set_center(0, {0.1, 0.1, 0.1});
  spheres.set_center(1, {1.2, 1.1, 1.3});
  expect_parted(spheres, edges, 400);
}

/// Narrow along one axis or two, so that nearly every pair has a second image that is near.
TEST(SeveralImages, AreMetInWideAndThinBoxes) {
  for (const Vector<3>& edges : {Vector<3>(14, 15, 2.05), Vector<3>(2.2, 60, 2.1)}) {
    Random random(5, stream(Stream::test));
    Spheres<3> spheres;
    for (int i = 0; i < 60; ++i)
      spheres.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), edges}), i % 3 == 0 ? 1.0 : 0.5);
    expect_parted(spheres, edges, 600);
  }
}

TEST(WideSizes, ArePackedDenselyAndStrictlyAlikeForAnyNumberOfThreads) {
  const Plan plan = plan_with(two_sizes(5, 0.2), 2000);
  const auto run_in = [&](int threads) { return run(plan, {.seed = {}, .threads = threads, .monitor = {}}); };
  const Packing packing = run_in(1);
  EXPECT_EQ(packing.outcome, Outcome::converged);
  testing::starts::expect_certified(packing);
  // From random places, all together, these end at 0.74 to 0.76.
  EXPECT_GT(packing.packing_fraction(), 0.765);
  EXPECT_LT(packing.packing_fraction(), plan.expected_packing_fraction + 0.01);
  EXPECT_EQ(hash_of(packing.spheres), hash_of(run_in(3).spheres));
  for (const Effect& effect : packing.effects)
    if (effect.name == "neighbour lists") {
      EXPECT_LT(effect.calls, 1500u) << "5,400 where the box does not grow by the mean";
    }
}

/// The monitor is asked after each sweep of all.
TEST(WideSizes, TellHowFarTheyAreInProportionToTheSweeps) {
  const Plan plan = plan_with(two_sizes(5, 0.2), 1000);
  double sweeps = 0, all_before = 0, told = 0;
  std::vector<std::array<double, 2>> course;  // sweeps of all spheres, share of the work
  Monitor monitor;
  monitor.cancelled = [&] {
    ++sweeps;
    return false;
  };
  monitor.on_progress = [&](const Progress& progress) {
    EXPECT_GE(progress.fraction, told) << "goes back";
    told = progress.fraction;
    if (told <= share_of_placing)
      all_before = sweeps;
    else
      course.push_back({sweeps - all_before, (told - share_of_placing) / (1 - share_of_placing)});
  };
  run(plan, {.seed = {}, .threads = 1, .monitor = monitor});
  ASSERT_GT(course.size(), 20u);
  // The first sweeps take longest, as they need most lists: the share is ahead of the sweeps then.
  for (const auto& [over, share] : course) EXPECT_NEAR(share, over / course.back()[0], 0.3);
}

TEST(WideSizes, ArePackedInBoxesThatHoldAFewOfTheLargest) {
  for (const double small : {0.3, 0.5, 0.7}) {
    SCOPED_TRACE(small);
    const Packing packing = run(plan_with(two_sizes(12, small), 1500));
    const bool has_large = std::ranges::max(packing.spheres.r) > 2 * std::ranges::min(packing.spheres.r);
    EXPECT_EQ(has_large, small < 0.6) << "0.4 are asked for at last, and none is drawn";
    EXPECT_EQ(packing.outcome, has_large ? Outcome::converged : Outcome::loose) << packing.reason;
    testing::starts::expect_certified(packing);
    EXPECT_GT(packing.packing_fraction(), 0.64);
  }
}

TEST(WideSizes, EndWithValidSpheresWhenCancelled) {
  const Plan plan = plan_with(two_sizes(8, 0.25), 1500);
  for (const int polls : {0, 50, 1500}) {
    SCOPED_TRACE(polls);
    const Packing packing = testing::starts::stopped_after(plan, polls);
    EXPECT_EQ(packing.outcome, Outcome::cancelled);
    EXPECT_EQ(packing.spheres.size(), 1500u);
    testing::starts::expect_certified(packing);
  }
}

}  // namespace relax_wide_test
}  // namespace bernal

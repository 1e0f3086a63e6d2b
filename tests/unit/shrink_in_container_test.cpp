#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "support/plans.hpp"
#include "support/starts.hpp"

namespace bernal {
namespace shrink_in_container_test {

Plan plan_with(const std::string& container, const std::string& spheres, int seed = 1) {
  return testing::plan_of(
      fmt::format("seed = {}\n[container]\n{}\n[spheres]\n{}\n", seed, container, spheres));
}

const std::string cylinder = "kind = \"cylinder\"\nradius = 10\nheight = 20\n";
const std::string one_to_six =
    "diameter = { distribution = \"classes\", values = [1, 6], shares = [0.25, 0.75], basis = \"volume\" }\n";

TEST(WideSizesBetweenWalls, ArePackedAsDenselyAsIsExpected) {
  for (const int seed : {1, 2}) {
    const Plan plan = plan_with("kind = \"periodic\"\nwalls = [2]\n", "count = 3000\n" + one_to_six, seed);
    const Packing packing = run(plan);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    testing::starts::expect_certified(packing);
    EXPECT_GT(packing.packing_fraction(), plan.expected_packing_fraction - 0.01);
  }
}

/// Where all start at random places, and what is stuck is put into holes, these end at 0.634 to 0.654.
TEST(WideSizesInAContainer, ArePackedFromTheLargestOn) {
  const Plan plan = plan_with(cylinder, "fill = true\n" + one_to_six);
  const auto run_in = [&](int threads) { return run(plan, {.seed = {}, .threads = threads, .monitor = {}}); };
  const Packing packing = run_in(1);
  testing::starts::expect_certified(packing);
  EXPECT_GT(packing.packing_fraction(), 0.655);
  EXPECT_EQ(hash_of(packing.spheres), hash_of(run_in(3).spheres));
}

/// Of many that are not wide, too, and in less sweeps than pushing in more and more, which takes 30,000.
TEST(AsManyAsFit, AreFoundByShrinking) {
  const Plan plan = plan_with(cylinder, "fill = true\nradius = 0.35\n");
  double told = 0;
  Monitor monitor;
  monitor.on_progress = [&](const Progress& progress) { told = std::max(told, progress.fraction); };
  const Packing packing = run(plan, {.seed = {}, .threads = 2, .monitor = monitor});
  testing::starts::expect_certified(packing);
  EXPECT_GT(packing.packing_fraction(), plan.expected_packing_fraction + 0.01);
  EXPECT_LE(told, 1);
  for (const Effect& effect : packing.effects)
    if (effect.name == "relaxation") {
      EXPECT_LT(effect.calls, 25000u);
    }
}

/// A given count is what is placed, and no more.
TEST(WideSizesInAContainer, AreAsManyAsAreAskedFor) {
  const Packing packing = run(plan_with(cylinder, "count = 1900\n" + one_to_six));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(packing.spheres.size(), 1900u);
  testing::starts::expect_certified(packing);
}

TEST(WideSizesInAContainer, EndWithValidSpheresWhenCancelled) {
  const Plan plan = plan_with(cylinder, "fill = true\n" + one_to_six);
  for (const int polls : {0, 200, 4000}) {
    SCOPED_TRACE(polls);
    const Packing packing = testing::starts::stopped_after(plan, polls);
    EXPECT_EQ(packing.outcome, Outcome::cancelled);
    testing::starts::expect_certified(packing);
  }
}

}  // namespace shrink_in_container_test
}  // namespace bernal

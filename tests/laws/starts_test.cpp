#include <gtest/gtest.h>

#include "support/scenes_under_test.hpp"

namespace bernal {
namespace starts_test {

using testing::expect_certified;
using testing::run_with;

class EveryPackingOfTheTests : public ::testing::TestWithParam<testing::SceneUnderTest> {};

INSTANTIATE_TEST_SUITE_P(, EveryPackingOfTheTests, ::testing::ValuesIn(testing::own_scenes()),
                         [](const auto& tested) { return tested.param.name; });

/// What a packing is, it stays or becomes denser, where the same stages begin from it. No gap between walls
/// or spheres that they leave is too narrow for them.
TEST_P(EveryPackingOfTheTests, IsAStartForTheSameStages) {
  Plan plan = GetParam().plan();
  const Packing packing = run_with(plan);
  plan.start = {.spheres = packing.spheres};
  if (plan.scene.is_periodic()) plan.start.edges = bounds_of<dynamic>(packing.domain).size();
  const Packing from_it = run_with(plan);
  expect_certified(from_it);
  EXPECT_EQ(from_it.outcome, Outcome::converged) << from_it.reason;
  EXPECT_GT(from_it.packing_fraction(), 0.97 * packing.packing_fraction());
  ASSERT_FALSE(from_it.spheres.empty());
  EXPECT_EQ(from_it.spheres.r.front(), packing.spheres.r.front());
}

}  // namespace starts_test
}  // namespace bernal

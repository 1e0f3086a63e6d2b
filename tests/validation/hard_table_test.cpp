#include <gtest/gtest.h>

#include "hard/table/hard_case.hpp"

namespace bernal {
namespace hard_table_test {

class HardCaseAtEveryLevel : public ::testing::TestWithParam<hard::Case> {};

INSTANTIATE_TEST_SUITE_P(, HardCaseAtEveryLevel, ::testing::ValuesIn(hard::all_cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(HardCaseAtEveryLevel, EndsAsItMust) {
  const hard::Case c = hard::with_offered_line(GetParam());
  for (const WallArithmetic walls : hard::levels_of(c))
    EXPECT_EQ(hard::objection(c, hard::end_of(c, walls)), "") << name_of(walls);
}

}  // namespace hard_table_test
}  // namespace bernal

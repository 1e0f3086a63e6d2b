#include <gtest/gtest.h>

#include "hard/table/hard_case.hpp"

namespace bernal {
namespace hard_table_test {

class HardCaseAtEveryLevel : public ::testing::TestWithParam<hard::Case> {};

INSTANTIATE_TEST_SUITE_P(, HardCaseAtEveryLevel, ::testing::ValuesIn(hard::all_cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(HardCaseAtEveryLevel, EndsAsItMust) {
  for (const WallArithmetic walls : hard::levels_of(GetParam()))
    EXPECT_EQ(hard::objection(GetParam(), hard::end_of(GetParam(), walls)), "") << name_of(walls);
}

}  // namespace hard_table_test
}  // namespace bernal

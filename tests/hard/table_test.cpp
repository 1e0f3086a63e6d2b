#include <gtest/gtest.h>

#include <set>

#include "hard/table/hard_case.hpp"

// Every row of the hard suite ends as it must: packed and certified, by us in exact arithmetic and by a
// checker that knows nothing but doubles; or refused with the right reason. Here at one level of arithmetic for
// walls, another from row to row; at all of them in tests/validation, and where the page is written.
namespace bernal {
namespace table_test {

class HardCase : public ::testing::TestWithParam<hard::Case> {};

INSTANTIATE_TEST_SUITE_P(, HardCase, ::testing::ValuesIn(hard::all_cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(HardCase, EndsAsItMust) {
  const hard::Case c = hard::with_offered_line(GetParam());
  const std::vector<WallArithmetic> levels = hard::levels_of(c);
  const WallArithmetic walls = levels[c.name.size() % levels.size()];
  EXPECT_EQ(hard::objection(c, hard::end_of(c, walls)), "") << name_of(walls);
}

TEST(HardTable, NamesEveryCaseOnceAndSaysWhyItIsHard) {
  std::set<std::string> names;
  for (const hard::Case& c : hard::all_cases()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_FALSE(c.why.empty()) << c.name;
  }
  EXPECT_GE(names.size(), 200u);
}

}  // namespace table_test
}  // namespace bernal

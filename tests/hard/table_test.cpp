#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "hard/table/hard_case.hpp"

// Every row of the hard suite ends as it must: packed and certified, by us in exact arithmetic and by a
// checker that knows nothing but doubles; or refused with the right reason. Here at one level of arithmetic
// for walls, another from row to row, and without those that take long; all at all of them in
// tests/validation, and where the page is written.
namespace bernal {
namespace table_test {

/// Those that take longer than five seconds, like others here do: only in tests/validation.
const std::set<std::string> lengthy = {
    "HolesFlipsAndTears",          "SkinOfASheet", "CubesThatShareAFaceMended",
    "CubesThatShareAnEdgeWrapped", "BonesMended",  "SharpWedge"};

std::vector<hard::Case> quick_cases() {
  std::vector<hard::Case> cases = hard::all_cases();
  std::erase_if(cases, [](const hard::Case& c) { return lengthy.contains(c.name); });
  return cases;
}

class HardCase : public ::testing::TestWithParam<hard::Case> {};

INSTANTIATE_TEST_SUITE_P(, HardCase, ::testing::ValuesIn(quick_cases()),
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
  EXPECT_TRUE(std::ranges::includes(names, lengthy));
}

}  // namespace table_test
}  // namespace bernal

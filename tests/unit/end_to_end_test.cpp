#include "near/end_to_end.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace bernal {
namespace end_to_end_test {

TEST(EndToEnd, PutsListsWhereTheyBegin) {
  const std::vector<std::vector<int>> blocks = {{1, 2, 3}, {}, {4, 5}};
  std::vector<std::size_t> first = {0, 1, 2, 0, 2};  // lists of one, two, none and two
  std::vector<int> all = {7, 7};
  put_end_to_end(blocks, first, all);
  EXPECT_EQ(first, (std::vector<std::size_t>{0, 1, 3, 3, 5}));
  EXPECT_EQ(all, (std::vector<int>{1, 2, 3, 4, 5}));
}

// 32 bits count 4.3e9 entries, the neighbours of 90 million spheres between walls.
TEST(EndToEnd, CountsMoreThanThirtyTwoBits) {
  std::vector<std::size_t> first = {0, 3'000'000'000, 3'000'000'000, 1};
  begin_end_to_end(first);
  EXPECT_EQ(first.back(), std::uint64_t{6'000'000'001});
}

}  // namespace end_to_end_test
}  // namespace bernal

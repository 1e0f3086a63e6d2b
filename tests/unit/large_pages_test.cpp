#include "core/large_pages.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <utility>
#include <vector>

#include "soft/row_arena.hpp"

namespace bernal {
namespace large_pages_test {

constexpr std::size_t page = std::size_t{2} << 20;

TEST(LargePages, AreWholeAndAligned) {
  for (const std::size_t bytes : {std::size_t{1}, page, page + 1, 3 * page - 5}) {
    const LargePages pages(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pages.begin()) % page, 0u);
    EXPECT_EQ(pages.bytes() % page, 0u);
    EXPECT_GE(pages.bytes(), bytes);
    EXPECT_LT(pages.bytes(), bytes + page);
    std::memset(pages.begin(), 1, pages.bytes());
  }
}

TEST(LargePages, HaveOneOwner) {
  LargePages first(page);
  void* const begin = first.begin();
  const LargePages second = std::move(first);
  EXPECT_EQ(second.begin(), begin);
  EXPECT_EQ(first.begin(), nullptr);
}

TEST(LargePages, SayWhereThereIsNoMemory) { EXPECT_THROW(LargePages(std::size_t{1} << 60), std::bad_alloc); }

/// Short ones and long ones, through all their growth.
TEST(LargePageVectors, AreVectorsThatAreAlignedWhereTheyAreLong) {
  LargePageVector<std::uint64_t> items;
  for (std::uint64_t k = 0; k < 700'000; ++k) {
    items.push_back(k);
    if (items.size() * sizeof(items[0]) < page) continue;
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(items.data()) % page, 0u);
  }
  for (std::uint64_t k = 0; k < items.size(); ++k) ASSERT_EQ(items[k], k);
  LargePageVector<std::uint64_t> others = std::move(items);
  others.resize(3);
  others.shrink_to_fit();
  EXPECT_EQ(others, (LargePageVector<std::uint64_t>{0, 1, 2}));
  struct alignas(64) Line {
    char bytes[64];
  };
  const LargePageVector<Line> lines(3);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(lines.data()) % 64, 0u);
}

// Short arrays and one that is longer than a piece, twice over: the second time in the same memory.
TEST(RowArena, KeepsWhatItIsGivenUntilItIsCleared) {
  RowArena<std::uint32_t> arena;
  const std::uint32_t* first = nullptr;
  for (int round = 0; round < 2; ++round) {
    std::vector<const std::uint32_t*> kept;
    const auto array = [&](std::uint32_t k) {
      return std::vector<std::uint32_t>(k == 70 ? 3'000'000 : 50'000 + k, k + 1000 * (round + 1));
    };
    for (std::uint32_t k = 0; k < 100; ++k) kept.push_back(arena.keep(array(k)));
    for (std::uint32_t k = 0; k < 100; ++k) {
      const std::vector<std::uint32_t> expected = array(k);
      ASSERT_EQ(std::memcmp(kept[k], expected.data(), expected.size() * sizeof(expected[0])), 0) << k;
    }
    if (round == 1) {
      EXPECT_EQ(kept.front(), first);
    }
    first = kept.front();
    arena.clear();
  }
}

}  // namespace large_pages_test
}  // namespace bernal

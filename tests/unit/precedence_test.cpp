#include "core/precedence.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <stdexcept>

#include "bernal/core/random.hpp"

namespace bernal {
namespace precedence_test {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Pairs that lead from smaller numbers to larger ones.
Pairs random_pairs(std::uint32_t pieces, std::size_t count, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Pairs pairs;
  while (pairs.size() < count) {
    const auto a = static_cast<std::uint32_t>(random.uniform() * pieces);
    const auto b = static_cast<std::uint32_t>(random.uniform() * pieces);
    if (a != b) pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  return pairs;
}

TEST(Precedence, KnowsWhoWaitsForWhom) {
  const Precedence order(4, {{0, 2}, {1, 2}, {2, 3}, {0, 3}});
  EXPECT_EQ(order.size(), 4u);
  EXPECT_EQ(order.waits_for(0), 0u);
  EXPECT_EQ(order.waits_for(2), 2u);
  EXPECT_EQ(order.waits_for(3), 2u);
  ASSERT_EQ(order.waiting(0).size(), 2u);
  EXPECT_EQ(order.waiting(0)[0], 2u);
  EXPECT_EQ(order.waiting(0)[1], 3u);
  EXPECT_TRUE(order.waiting(3).empty());
  EXPECT_EQ(Precedence().size(), 0u);
}

TEST(Precedence, LetsEveryPieceBeginAfterThoseThatItWaitsFor) {
  for (const std::size_t threads : {1, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const std::uint32_t pieces = 200;
      const Pairs pairs = random_pairs(pieces, 50 * seed, seed);
      const Precedence order(pieces, pairs);
      std::atomic<int> clock = 0;
      std::vector<int> began(pieces, 0), ended(pieces, 0);
      parallel_by_precedence(order, [&](std::size_t k) {
        EXPECT_EQ(began[k], 0) << "called twice";
        began[k] = ++clock;
        ended[k] = ++clock;
      });
      EXPECT_EQ(clock, 2 * static_cast<int>(pieces)) << "not all were called";
      for (const auto& [earlier, later] : pairs) EXPECT_LT(ended[earlier], began[later]);
    }
  }
}

TEST(Precedence, PassesOnWhatAPieceThrows) {
  const Precedence order(100, random_pairs(100, 300, 1));
  EXPECT_THROW(parallel_by_precedence(order,
                                      [&](std::size_t k) {
                                        if (k == 50) throw std::runtime_error("50");
                                      }),
               std::runtime_error);
}

TEST(Precedence, HasNothingToDoWhereThereIsNothing) {
  parallel_by_precedence(Precedence(), [](std::size_t) { FAIL(); });
}

}  // namespace precedence_test
}  // namespace bernal

// The table of arithmetic on what takes no time: pairs and the analytic containers.
#include "bench/pricing/arithmetic.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bernal {
namespace arithmetic_bench_test {

using pricing::PricedContainer;
using pricing::PricedRow;

constexpr std::size_t plain = 0, filtered = 1, exact = 2;

void expect_sound(const PricedRow& row, std::uint64_t asked) {
  const std::string what = row.decision + ", " + row.container;
  EXPECT_EQ(row.level[filtered]->differ, 0u) << what;
  // All but where boxes of a mesh decide, and where extended precision knows that a profile is not met.
  const bool by_profile = row.container == "cone" || row.container == "tube" || row.container == "hopper";
  EXPECT_GT(row.level[exact]->exact_share, by_profile ? 0.3 : 0.9) << what;
  EXPECT_GT(row.level[filtered]->exact_share, 0.1) << what << ": a quarter are ties";
  EXPECT_LT(row.level[filtered]->exact_share, 0.9) << what;
  for (const auto& level : row.level) {
    if (!level) continue;
    EXPECT_GE(level->decisions, asked) << what;
    EXPECT_GT(level->nanoseconds, 0) << what;
    if (level->worst_error && level->bound) {
      EXPECT_LE(*level->worst_error, *level->bound) << what;
    }
  }
}

TEST(PricedArithmetic, FilteredIsExactAndErrorsAreBelowTheirBounds) {
  constexpr std::uint64_t asked = 400;
  expect_sound(pricing::price_pairs(asked, {}), asked);
  std::uint64_t judged_wrongly = 0;
  for (const PricedContainer& container : pricing::containers_to_price(100)) {
    for (const auto& price : {pricing::price_places, pricing::price_distances, pricing::price_ways}) {
      const PricedRow row = price(container, asked, {});
      expect_sound(row, asked);
      judged_wrongly += row.level[plain]->differ;
    }
    EXPECT_EQ(pricing::price_certificate(container, asked, {}).level[filtered]->differ, 0u) << container.name;
  }
  EXPECT_GT(judged_wrongly, 100u) << "near ties doubles err";
}

// What is said to touch does, to the last bit: one double more and it does not fit.
TEST(PricedArithmetic, TiesAreTies) {
  for (const PricedContainer& container : pricing::containers_to_price(1000)) {
    Random random(1, stream(Stream::test));
    for (int k = 0; k < 20; ++k) {
      const pricing::Query ball = pricing::query_of_place(container, pricing::Population::tie, random);
      EXPECT_TRUE(container.exact().contains(ball.c, ball.r)) << container.name;
      EXPECT_FALSE(container.exact().contains(ball.c, std::nextafter(ball.r, 9.0))) << container.name;
      const pricing::Query centre = pricing::query_of_centre(container, pricing::Population::tie, random);
      EXPECT_TRUE(container.exact().contains(centre.c, 0)) << container.name;
      EXPECT_FALSE(container.exact().contains(centre.c, 1e-300)) << container.name;
    }
  }
}

}  // namespace arithmetic_bench_test
}  // namespace bernal

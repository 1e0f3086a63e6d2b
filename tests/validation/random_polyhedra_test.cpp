#include <gtest/gtest.h>

#include "hard/table/random_polyhedra.hpp"

namespace bernal {
namespace random_polyhedra_test {

// 500 seeds, 25 a test: four families of 125.
constexpr std::uint64_t seeds = 125, in_one_test = 25;

class RandomPolyhedronOf500 : public ::testing::TestWithParam<std::tuple<std::size_t, std::uint64_t>> {};

INSTANTIATE_TEST_SUITE_P(, RandomPolyhedronOf500,
                         ::testing::Combine(::testing::Range<std::size_t>(0, 4),
                                            ::testing::Range<std::uint64_t>(0, seeds, in_one_test)),
                         [](const auto& tested) {
                           return hard::families_of_polyhedra()[std::get<0>(tested.param)].name +
                                  std::to_string(std::get<1>(tested.param));
                         });

TEST_P(RandomPolyhedronOf500, IsPackedAndCertified) {
  const auto [family, first] = GetParam();
  for (std::uint64_t seed = first; seed < first + in_one_test; ++seed) {
    const hard::Case c = hard::case_of(hard::families_of_polyhedra()[family], seed);
    const auto walls = static_cast<WallArithmetic>(seed / 5 % 3);
    EXPECT_EQ(hard::objection(c, hard::end_of(c, walls)), "") << c.name << ", " << name_of(walls);
  }
}

}  // namespace random_polyhedra_test
}  // namespace bernal

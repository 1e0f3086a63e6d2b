#include <gtest/gtest.h>

#include "hard/table/random_polyhedra.hpp"

namespace bernal {
namespace random_polyhedra_test {

// 100 of the 500 seeds that tests/validation packs, five a test: four families of 25.
constexpr std::uint64_t seeds = 25, in_one_test = 5;

class RandomPolyhedron : public ::testing::TestWithParam<std::tuple<std::size_t, std::uint64_t>> {};

INSTANTIATE_TEST_SUITE_P(, RandomPolyhedron,
                         ::testing::Combine(::testing::Range<std::size_t>(0, 4),
                                            ::testing::Range<std::uint64_t>(0, seeds, in_one_test)),
                         [](const auto& tested) {
                           return hard::families_of_polyhedra()[std::get<0>(tested.param)].name +
                                  std::to_string(std::get<1>(tested.param));
                         });

TEST_P(RandomPolyhedron, IsPackedAndCertified) {
  const auto [family, first] = GetParam();
  EXPECT_EQ(hard::objections(hard::families_of_polyhedra()[family], first, in_one_test), "");
}

}  // namespace random_polyhedra_test
}  // namespace bernal

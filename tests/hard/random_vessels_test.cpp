#include <gtest/gtest.h>

#include "hard/table/random_vessels.hpp"

namespace bernal {
namespace random_vessels_test {

// 60 of the 500 seeds that tests/validation settles.
class RandomVessels : public ::testing::TestWithParam<std::uint64_t> {};

INSTANTIATE_TEST_SUITE_P(, RandomVessels, ::testing::Range<std::uint64_t>(0, 60, 20));

TEST_P(RandomVessels, HoldBedsThatRest) { EXPECT_EQ(hard::objections_to_beds(GetParam(), 20), ""); }

}  // namespace random_vessels_test
}  // namespace bernal

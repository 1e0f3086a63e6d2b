#include <gtest/gtest.h>

#include "hard/table/random_vessels.hpp"

namespace bernal {
namespace random_vessels_test {

class RandomVessels : public ::testing::TestWithParam<std::uint64_t> {};

INSTANTIATE_TEST_SUITE_P(, RandomVessels, ::testing::Range<std::uint64_t>(0, 500, 50));

TEST_P(RandomVessels, HoldBedsThatRest) { EXPECT_EQ(hard::objections_to_beds(GetParam(), 50), ""); }

}  // namespace random_vessels_test
}  // namespace bernal

#include <gtest/gtest.h>

#include "hard/table/random_polyhedra.hpp"

namespace bernal {
namespace random_polyhedra_test {

class FamilyOfPolyhedra : public ::testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(, FamilyOfPolyhedra, ::testing::Range<std::size_t>(0, 4),
                         [](const auto& tested) { return hard::families_of_polyhedra()[tested.param].name; });

// 500 seeds, four families of 125.
TEST_P(FamilyOfPolyhedra, IsPackedAndCertified) {
  EXPECT_EQ(hard::objections(hard::families_of_polyhedra()[GetParam()], 0, 125), "");
}

}  // namespace random_polyhedra_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

// What relaxation with the defaults reaches where sizes are wide, and how far that is from the rod model.
// Where fifty spheres carry the volume, a packing of so few scatters by 0.01 with the seed: seeds 1 to 4 of
// the sizes 1 to 20 give 0.8222, 0.8074, 0.8115 and 0.8010 for an expected 0.804.
namespace bernal {
namespace wide_sizes_test {

struct Case {
  const char* name;
  const char* diameter;
  int count;
  double least;
  double above = 0.01;  ///< the rod model, at most
};

class WideSizesInBoxes : public ::testing::TestWithParam<Case> {};

TEST_P(WideSizesInBoxes, ReachThePackingFraction) {
  const Plan plan = testing::plan_of(
      fmt::format("seed = 1\n[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\ndiameter = {}\n"
                  "draw = \"quantiles\"\n[[stage]]\ndo = \"relax\"\n",
                  GetParam().count, GetParam().diameter));
  const Packing packing = run(plan, {.seed = {}, .threads = 1, .monitor = {}});
  ASSERT_EQ(packing.outcome, Outcome::converged);
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  RecordProperty("packing_fraction", fmt::format("{:.4f}", packing.packing_fraction()));
  RecordProperty("expected", fmt::format("{:.4f}", plan.expected_packing_fraction));
  RecordProperty("seconds", fmt::format("{:.1f}", packing.seconds));
  EXPECT_GE(packing.packing_fraction(), GetParam().least);
  EXPECT_LE(packing.packing_fraction(), plan.expected_packing_fraction + GetParam().above);
}

#define BERNAL_CLASSES(values, shares) \
  "{ distribution = \"classes\", values = [" values "], shares = [" shares "], basis = \"volume\" }"
INSTANTIATE_TEST_SUITE_P(
    Sizes, WideSizesInBoxes,
    ::testing::Values(
        Case{"OneToFive", BERNAL_CLASSES("1, 5", "20, 80"), 10000, 0.778},
        Case{"OneToTen", BERNAL_CLASSES("1, 10", "25, 75"), 30000, 0.82},
        Case{"OneToTwenty", BERNAL_CLASSES("1, 20", "20, 80"), 100000, 0.795, 0.03},
        Case{"OneToThreeToNine", BERNAL_CLASSES("1, 3, 9", "0.163685, 0.098777, 0.737539"), 10000, 0.82},
        Case{"FullerToTen", "{ distribution = \"fuller\", min = 0.1, max = 1, exponent = 0.5 }", 10000,
             0.748},
        Case{"FullerToHundred", "{ distribution = \"fuller\", min = 0.01, max = 1, exponent = 0.5 }", 10000,
             0.84},
        Case{"LognormalOne", "{ distribution = \"lognormal\", median = 1, sigma = 1 }", 10000, 0.775}),
    [](const auto& tested) { return std::string(tested.param.name); });
#undef BERNAL_CLASSES

}  // namespace wide_sizes_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "bernal/measure/rest.hpp"
#include "bernal/run/run.hpp"
#include "support/plans.hpp"

// High beds, of which the energy above the floor says little: every sphere rests, however high.
namespace bernal {
namespace beds_validation_test {

const std::string settled =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n[[stage]]\ndo = \"shake\"\n";

void expect_settled(const Packing& packing) {
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(measure_rest(packing.spheres, packing.domain, {0, 0, -1}).unsettled, 0u);
}

TEST(HighBeds, ColumnsOfFourDiameters) {
  for (const int height : {160, 640}) {
    const Packing packing = run(testing::plan_of(
        fmt::format("[container]\nkind = \"cylinder\"\nradius = 2.0\nheight = {}\n[spheres]\nfill = true\n"
                    "diameter = 1.0\n",
                    height) +
        settled + "[[stage]]\ndo = \"refill\"\n"));
    expect_settled(packing);
    std::printf("%d diameters: packing fraction %.4f\n", height, packing.packing_fraction());
    EXPECT_GT(packing.packing_fraction(), 0.52);
  }
}

TEST(HighBeds, LowInATallCylinder) {
  const Packing packing = run(testing::plan_of(
      "unit = \"mm\"\n[container]\nkind = \"cylinder\"\nradius = 15\nheight = 150\n[spheres]\n"
      "count = 2500\ndiameter = 2.0\n" +
      settled));
  expect_settled(packing);
  double top = 0;
  for (const double z : packing.spheres.x[2]) top = std::max(top, z);
  EXPECT_LT(top, 30);
}

}  // namespace beds_validation_test
}  // namespace bernal

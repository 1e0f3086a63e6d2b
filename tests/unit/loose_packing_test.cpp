#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/measured.hpp"
#include "support/plans.hpp"

// The recipe for loose packings: relaxation that starts at the packing fraction which is asked for.
namespace bernal {
namespace loose_packing_test {

Packing loose(double phi0, int count, int seed, const std::string& method) {
  const Packing packing =
      run(testing::plan_of(
              fmt::format("seed = {}\n[container]\nkind = \"periodic\"\n[spheres]\ncount = {}\nradius "
                          "= 1.0\n[[stage]]\ndo = \"relax\"\nphi0 = {}\nmethod = \"{}\"\n",
                          seed, count, phi0, method)),
          {.seed = {}, .threads = 1, .monitor = {}});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  return packing;
}

// The overlaps that are left when all others are gone are below stop = 2e-4, in the last growth of the box
// three times that in its volume.
TEST(LoosePacking, HasThePackingFractionThatItStartsAt) {
  double last_coordination = 0;
  for (const double phi0 : {0.56, 0.57, 0.58, 0.59, 0.60}) {
    double coordination = 0;
    for (const int seed : {1, 2, 3}) {
      SCOPED_TRACE(::testing::Message() << phi0 << ", seed " << seed);
      const Packing packing = loose(phi0, 1000, seed, "fast");
      EXPECT_LE(packing.packing_fraction(), phi0 * (1 + 1e-12));
      EXPECT_GT(packing.packing_fraction(), phi0 - 0.001);
      EXPECT_NEAR(packing.expected_packing_fraction, phi0, 1e-9);
      coordination += measure_contacts(packing, 0.002).coordination / 3;
    }
    EXPECT_GT(coordination, last_coordination) << phi0;
    last_coordination = coordination;
  }
  EXPECT_GT(last_coordination, 4.8);
  EXPECT_LT(last_coordination, 5.8);  // 6 of jammed ones
}

TEST(LoosePacking, IsHeldByNothing) {
  const Packing packing = loose(0.56, 1000, 4, "fast");
  EXPECT_EQ(measure_contacts(packing, 0.002).rattlers, packing.spheres.size());
}

// The box grows by a thirtieth of the largest overlap however few there are, in 0.56 to 0.60 by up to 0.006.
TEST(LoosePacking, OfThePublishedLoopIsALittleLooser) {
  for (const double phi0 : {0.565, 0.60}) {
    const double phi = loose(phi0, 300, 1, "reference").packing_fraction();
    EXPECT_LE(phi, phi0);
    EXPECT_GT(phi, phi0 - 0.015);
  }
}

}  // namespace loose_packing_test
}  // namespace bernal

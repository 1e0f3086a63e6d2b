#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

// Scenes at the edge of what can be packed: all end by themselves, and what they leave is certified, whether
// spheres are relaxed or compressed.
namespace bernal {
namespace packings_test {

using testing::plan_of;

const std::string relaxed;  // the protocol of a scene that names none
const std::string compressed =
    "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n"
    "[[stage]]\ndo = \"shake\"\n[[stage]]\ndo = \"refill\"\n";

Packing certified(const Plan& plan) {
  RunOptions options;
  options.threads = 1;
  Packing packing = run(plan, options);
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  EXPECT_TRUE(packing.outcome == Outcome::converged || packing.outcome == Outcome::full) << packing.reason;
  return packing;
}

TEST(HardPacking, OfOneSphereThatJustFits) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    // Its centre has a room of 1e-18 of the container.
    for (const char* container :
         {"kind = \"sphere\"\nradius = 1.0\n", "kind = \"box\"\nsize = [2.0, 2.0, 2.0]\n",
          "kind = \"cylinder\"\nradius = 1.0\nheight = 2.0\n"}) {
      const Packing packing = certified(plan_of(std::string(std::string("[container]\n") + container +
                                                            "[spheres]\ncount = 1\nradius = 0.999999\n") +
                                                protocol));
      EXPECT_EQ(packing.spheres.size(), 1u);
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    }
  }
}

TEST(HardPacking, OfOneSphereFallsToTheGround) {
  const Packing packing = certified(plan_of(
      std::string(
          "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n[spheres]\ncount = 1\nradius = 0.1\n") +
      compressed));
  ASSERT_EQ(packing.spheres.size(), 1u);
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_NEAR(packing.spheres.center(0)[2], 0.1, 1e-6);
}

TEST(HardPacking, OfAPipeThatIsNarrowerThanTwoSpheres) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing =
        certified(plan_of(std::string("[container]\nkind = \"cylinder\"\nradius = 0.75\nheight = 20.0\n"
                                      "[spheres]\nfill = true\nradius = 0.5\n") +
                          protocol));
    // Two touching spheres that zigzag between the walls: their centres are 0.5 apart across the pipe, so
    // 0.866 along it.
    EXPECT_LE(packing.spheres.size(), 1 + static_cast<std::size_t>(19 / (0.5 * std::numbers::sqrt3)));
    EXPECT_GE(packing.spheres.size(), 10u);
  }
}

TEST(HardPacking, OfAPipeThatIsOneSphereWide) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing =
        certified(plan_of(std::string("[container]\nkind = \"cylinder\"\nradius = 0.51\nheight = 20.0\n"
                                      "[spheres]\nfill = true\nradius = 0.5\n") +
                          protocol));
    EXPECT_LE(packing.spheres.size(), 20u);
  }
}

TEST(HardPacking, OfASlabOneSphereThick) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing =
        certified(plan_of(std::string("[container]\nkind = \"box\"\nsize = [10.0, 10.0, 1.001]\n"
                                      "[spheres]\nfill = true\nradius = 0.5\n") +
                          protocol));
    EXPECT_GE(packing.spheres.size(), 40u);
    EXPECT_LE(packing.spheres.size(), 120u);
  }
}

TEST(HardPacking, OfRadiiThatDifferFiftyfold) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(plan_of(
        std::string("[container]\nkind = \"box\"\nsize = [400.0, 400.0, 400.0]\n[spheres]\ncount = 1500\n"
                    "radius = { distribution = \"classes\", values = [1.0, 50.0], shares = [99, 1] }\n") +
        protocol));
    EXPECT_EQ(packing.spheres.size(), 1500u);
    EXPECT_GE(std::ranges::count(packing.spheres.r, 50.0), 3);
    EXPECT_GE(std::ranges::count(packing.spheres.r, 1.0), 1400);
  }
}

TEST(HardPacking, OfANeedle) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(plan_of(
        std::string(
            "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 30.0]\n[spheres]\nfill = true\nradius = 0.2\n") +
        protocol));
    EXPECT_GT(packing.packing_fraction(), 0.35);
  }
}

TEST(HardPacking, OfANeedleThatLiesDown) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(plan_of(
        std::string(
            "[container]\nkind = \"box\"\nsize = [40.0, 1.0, 1.0]\n[spheres]\nfill = true\nradius = 0.2\n") +
        protocol));
    EXPECT_GT(packing.packing_fraction(), 0.35);
  }
}

// Growth that is stopped short leaves a box that is larger than asked; whoever has no place in the one that
// was stays out.
TEST(HardPacking, OfABedInABoxThatHasBecomeTooLarge) {
  const Packing packing = certified(plan_of(
      "[container]\nkind = \"periodic\"\nsize = [2.0, 2.0, 2.0]\nwalls = [2]\n[spheres]\nradius = 0.2\n"
      "[[stage]]\ndo = \"grow\"\n[[stage]]\ndo = \"insert\"\n"));
  EXPECT_GT(packing.packing_fraction(), 0.25);
}

TEST(HardPacking, OfAFewTinySpheres) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(plan_of(
        std::string("[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 1.0\n[spheres]\ncount = "
                    "300\nradius = 1e-4\n") +
        protocol));
    EXPECT_EQ(packing.spheres.size(), 300u);
    if (protocol == compressed) {
      // They fall ten thousand radii, and hardly any comes to lie on another.
      EXPECT_LT(*std::ranges::max_element(packing.spheres.x[2]), 1e-3);
    }
  }
}

TEST(HardPacking, OfDust) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(plan_of(
        std::string(
            "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n[spheres]\ncount = 300\nradius = 1e-6\n") +
        protocol));
    EXPECT_EQ(packing.spheres.size(), 300u);
  }
}

TEST(HardPacking, OfAHeavyTail) {
  for (const std::string& protocol : {relaxed, compressed}) {
    SCOPED_TRACE(protocol);
    const Packing packing = certified(
        plan_of(std::string("[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n[spheres]\ncount = 1000\n"
                            "radius = { distribution = \"lognormal\", median = 0.02, sigma = 1.0 }\n") +
                protocol));
    EXPECT_GT(packing.spheres.size(), 100u);  // of which a few fill most of the box
  }
}

}  // namespace packings_test
}  // namespace bernal

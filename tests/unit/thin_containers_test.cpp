#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/run/run.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "bernal/verify/certificate.hpp"
#include "plan/estimate.hpp"
#include "plan/few_large.hpp"
#include "support/plans.hpp"

// Where walls are near everywhere, how many spheres fit is a guess, and both the plan and the result say so.
namespace bernal {
namespace thin_containers_test {

Plan plan_in(const std::string& container, const std::string& spheres = "") {
  return testing::plan_of("[container]\n" + container + "[spheres]\ndiameter = 1.0\n" + spheres);
}
const std::string tin = "kind = \"cylinder\"\nradius = 1.5\nheight = 1.05\n";
const std::string wide = "kind = \"cylinder\"\nradius = 5.0\nheight = 9.0\n";

TEST(ThinContainers, HaveAnExpectationThatGivesOrTakesSome) {
  const Plan thin = plan_in(tin), roomy = plan_in(wide);
  ASSERT_TRUE(give_or_take(thin));
  EXPECT_GE(std::round(thin.expected_count) + static_cast<double>(*give_or_take(thin)), 7);  // around one
  EXPECT_NE(thin.caution.find("give or take 2"), std::string::npos) << thin.caution;
  EXPECT_NE(thin.caution.find("found by trial"), std::string::npos) << thin.caution;
  const Plan many = plan_in("kind = \"cylinder\"\nradius = 15\nheight = 1.05\n");
  EXPECT_NE(many.caution.find("fill = true"), std::string::npos) << many.caution;
  EXPECT_FALSE(give_or_take(roomy));
  EXPECT_EQ(roomy.caution, "");
}

TEST(ThinContainers, SayNothingOfWhatIsAsked) {
  for (const char* asked : {"count = 5\n", "packing_fraction = 0.3\n", "fill = true\n"}) {
    EXPECT_FALSE(give_or_take(plan_in(tin, asked))) << asked;
    EXPECT_EQ(plan_in(tin, asked).caution, "") << asked;
  }
}

/// A block of 10 x 10 x 10 with a fin 20 long and 1 thick, a sixth of the whole. Spheres of diameter d that
/// are wider than the fin leave along each edge of the block (1 - pi/4) (d/2)² beside.
TEST(ThinContainers, SayWhatIsTooNarrowForTheSpheres) {
  const auto hints = [](double diameter) {
    return testing::plan_of(
               "unit = \"mm\"\n[container]\nkind = \"extruded\"\nheight = 10\npolygon = [[0, 0], [10, 0], "
               "[10, "
               "4.5], [30, 4.5], [30, 5.5], [10, 5.5], [10, 10], [0, 10]]\n[spheres]\ndiameter = " +
               std::to_string(diameter))
        .hints;
  };
  for (const double d : {1.2, 2.0}) {
    const double narrow = 200 + 12 * (1 - std::numbers::pi / 4) * d * d / 4 * 10;
    ASSERT_EQ(hints(d).size(), 1U) << d;
    EXPECT_NEAR(std::stod(hints(d)[0].substr(std::string("about ").size())), 100 * narrow / 1200, 1.5)
        << hints(d)[0];
    EXPECT_NE(hints(d)[0].find("% of the container is too narrow for even the smallest spheres"),
              std::string::npos);
  }
  EXPECT_TRUE(hints(0.8).empty());
}

TEST(ThinContainers, AreFilledByTrialWhereFewFit) {
  const Packing expected = run(plan_in(tin));
  EXPECT_EQ(expected.outcome, Outcome::converged);
  EXPECT_EQ(expected.spheres.size(), 7U);
  EXPECT_NE(expected.reason.find("of 8 no arrangement was found"), std::string::npos) << expected.reason;
  EXPECT_EQ(expected.reason.find("fill = true"), std::string::npos) << expected.reason;
  const Packing filled = run(plan_in(tin, "fill = true\n"));
  EXPECT_EQ(filled.spheres.size(), expected.spheres.size());
  EXPECT_EQ(filled.reason.find("fill = true"), std::string::npos) << filled.reason;
  const Packing roomy = run(plan_in(wide));
  EXPECT_EQ(roomy.reason.find("give or take"), std::string::npos) << roomy.reason;
}

/// Tins of exactly one diameter, into which 11 and 19 discs of that size fit.
TEST(ThinContainers, AreFilledWhereEverySphereTouchesBothEnds) {
  for (const auto& [radius, least] : {std::pair("2.0", 11), std::pair("2.5", 19)}) {
    const Packing packing = run(
        plan_in(fmt::format("kind = \"cylinder\"\nradius = {}\nheight = 1.0\n", radius), "fill = true\n"));
    EXPECT_GE(packing.spheres.size(), least) << packing.reason;
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified) << radius;
  }
}

/// A sphere as thick as the tube has places whose distance from the axis is a double in four directions only.
TEST(ThinContainers, ATubeAsThickAsItsSpheresHoldsSome) {
  for (const char* axis : {"", "axis = [0.0, 2.0, 0.0]\nbase = [5.0, 0.0, -3.0]\n"}) {
    const Packing packing = run(
        plan_in(fmt::format("kind = \"tube\"\nradius = 2.5\ninner_radius = 1.5\nheight = 4.0\n{}", axis)));
    EXPECT_GE(packing.spheres.size(), 4u) << packing.reason;
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified) << packing.reason;
  }
}

/// One sphere of the three that were expected.
TEST(ThinContainers, AreNotFilledByFarFewerThanExpected) {
  EXPECT_EQ(run(plan_in("kind = \"sphere\"\nradius = 1.0\n")).spheres.size(), 2U);  // touching
  const Packing packing = run(plan_in("kind = \"sphere\"\nradius = 0.999\n"));
  EXPECT_NE(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_NE(packing.reason.find("expected"), std::string::npos) << packing.reason;
}

/// By hand, of a ball: x = A d / V = 3 d / R.
TEST(ThinContainers, HaveAnErrorThatGrowsWithTheWalls) {
  const auto radii = make_constant(0.5);
  const auto error = [&](double r) { return error_between_walls(Sphere{Vector<3>::Zero(), r}, *radii); };
  EXPECT_EQ(error(3.0), 0);
  EXPECT_EQ(error(30.0), 0);
  EXPECT_NEAR(error(1.5), 0.12, 1e-12);
  EXPECT_NEAR(error(1.0), 0.12 * std::pow(2.0, 1.5), 1e-12);
  EXPECT_EQ(error_between_walls(periodic_box(Vector<3>::Constant(1.1)), *radii), 0);
}

}  // namespace thin_containers_test
}  // namespace bernal

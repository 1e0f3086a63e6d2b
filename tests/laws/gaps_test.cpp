#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/sizes/radius_sequence.hpp"
#include "support/gap_oracle.hpp"
#include "support/scenes_under_test.hpp"

// Whatever fills whatever: it keeps the gaps that the scene asks for, and makes use of the room that they
// leave.
namespace bernal {
namespace gaps_test {

using testing::plan_of;

struct Case {
  std::string name;
  std::string container;  ///< the scene's, or that of `domain`
  std::string spheres, stages;
  double gap;
  std::optional<Domain> domain = {};

  friend void PrintTo(const Case& tested, std::ostream* out) { *out << tested.name; }
};

std::string stage(const std::string& name, const std::string& more = "") {
  return fmt::format("[[stage]]\ndo = \"{}\"\n{}\n", name, more);
}

std::vector<Case> cases() {
  const std::string box = "[container]\nkind = \"box\"\nsize = [1.0, 1.1, 0.9]\ncorner = [0.3, -2, 7]\n";
  const std::string oblique =
      "[container]\nkind = \"cylinder\"\nradius = 0.6\nheight = 1.3\naxis = [1.0, 2.0, 3.0]\n"
      "base = [30.0, -20.0, 50.0]\n";
  const std::string ball = "[container]\nkind = \"sphere\"\nradius = 0.6\ncenter = [1, 2, 3]\n";
  const std::string column =
      "[container]\nkind = \"cylinder\"\nradius = 0.5\nheight = 1.0\nperiodic = true\n";
  const std::string tube =
      "[container]\nkind = \"tube\"\nradius = 0.7\ninner_radius = 0.25\nheight = 1.0\nbase = [1, 2, 3]\n";
  const std::string vessel =
      "[container]\nkind = \"revolved\"\nprofile = [[0.2, 0], [0.2, 0.3], [0.7, 0.8], [0.7, 1.4]]\n"
      "axis = [1.0, 2.0, 3.0]\n";
  const std::string periodic = "[container]\nkind = \"periodic\"\n";
  const std::string between = periodic + "size = [1.0, 1.2, 0.9]\nwalls = [1]\n";
  const std::string square = "[container]\nkind = \"box\"\nsize = [10, 7]\n";
  const std::string wide = "radius = { distribution = \"uniform\", min = 0.06, max = 0.09 }\n";
  const std::string equal = "radius = 0.07\n";
  const std::string settled = stage("insert") + stage("compress", "direction = [0.5, -0.5, 0]") +
                              stage("shake", "direction = [0.5, -0.5, 0]\nrounds = 2") +
                              stage("refill", "direction = [0.5, -0.5, 0]");
  const std::string flat = stage("insert") + stage("compress", "direction = [0, -1]") +
                           stage("shake", "direction = [0, -1]\nrounds = 2") +
                           stage("refill", "direction = [0, -1]");
  const std::string relaxed = stage("relax"), grown = stage("grow", "rate = 0.1\npressure = 1e4");
  const auto fly = [](const std::string& method) { return stage("fly", "method = \"" + method + "\""); };
  return {
      {"SettledInABox", box, "fill = true\n" + wide, settled, 0.02},
      {"RelaxedInABox", box, wide, relaxed, 0.02},
      {"PolishedInABox", box, "radius = 0.1\n", stage("relax", "polish = 1e-10"), 0.02},
      {"GrownInABox", box, "packing_fraction = 0.3\n" + wide, grown, 0.02},
      {"SettledInAnObliqueCylinder", oblique, "fill = true\n" + equal, settled, 0.02},
      {"RelaxedInAnObliqueCylinder", oblique, wide, relaxed, 0.03},
      {"SettledInASphere", ball, "fill = true\n" + wide, settled, 0.02},
      {"GrownInASphere", ball, equal, grown, 0.02},
      {"SettledInATube", tube, "fill = true\n" + equal, settled, 0.02},
      {"RelaxedInATube", tube, wide, relaxed, 0.02},
      {"PolishedInATube", tube, "radius = 0.1\n", stage("relax", "polish = 1e-10"), 0.02},
      {"SettledInAVessel", vessel, "fill = true\n" + wide, settled, 0.02},
      {"RelaxedInAVessel", vessel, equal, relaxed, 0.03},
      {"RelaxedInAColumn", column, equal, relaxed, 0.02},
      {"SettledInAColumn", column, "fill = true\nradius = 0.06\n", settled, 0.015},
      {"GrownInAColumn", column, equal, grown, 0.02},
      {"RelaxedWithoutWalls", periodic, "count = 100\n" + wide, relaxed, 0.02},
      {"RelaxedByTheBook", periodic, "count = 60\n" + wide,
       stage("relax", "method = \"reference\"\nalpha = 3"), 0.02},
      {"RelaxedToAPackingFraction", periodic, "count = 100\npacking_fraction = 0.35\n" + wide, relaxed, 0.02},
      {"PolishedWithoutWalls", periodic, "count = 60\n" + wide, stage("relax", "polish = 1e-10"), 0.02},
      {"GrownWithoutWalls", periodic, "count = 60\n" + wide, grown, 0.02},
      {"RelaxedThenGrown", periodic, "count = 60\n" + wide, relaxed + grown, 0.02},
      {"RelaxedInTheUnitBox", periodic + "edge = 1.0\n", "packing_fraction = 0.35\n" + wide, relaxed, 0.02},
      {"SizesOneToTen", periodic,
       "count = 150\nradius = { distribution = \"uniform\", min = 0.1, max = 1.0, "
       "basis = \"volume\" }\n",
       relaxed, 0.05},
      {"RelaxedBetweenTwoWalls", between, "packing_fraction = 0.3\n" + wide, relaxed, 0.02},
      {"RelaxedBetweenWallsThatFollow", periodic + "walls = [1]\n", "count = 80\n" + wide, relaxed, 0.02},
      {"GrownBetweenTwoWalls", between, "packing_fraction = 0.3\n" + wide, grown, 0.02},
      {"FlownBetweenTwoWalls", between, "packing_fraction = 0.2\n" + wide, fly("flight"), 0.02},
      {"FlownByThePatent", periodic + "edge = 1.0\n", "packing_fraction = 0.2\n" + equal, fly("patent"),
       0.02},
      {"FilledByClasses", periodic + "edge = 1.0\n",
       "packing_fraction = 0.3\nradius = { distribution = \"classes\", values = [0.03, 0.12], shares = [4, "
       "1] "
       "}\n",
       fly("classes"), 0.01},
      {"FilledByRelaxation", periodic + "edge = 1.0\n", "packing_fraction = 0.35\n" + wide, fly("relaxation"),
       0.02},
      {"FiveDimensions", periodic + "dimension = 5\nedge = 1.0\n", "packing_fraction = 0.05\nradius = 0.2\n",
       fly("relaxation"), 0.03},
      {"PlaneWithoutWalls", periodic + "dimension = 2\n", "count = 100\n" + wide, relaxed, 0.02},
      {"SettledInARectangle", square, "fill = true\nradius = 0.3\n", flat, 0.1},
      {"SettledInAPolygonWithAHole", square, "fill = true\nradius = 0.3\n", flat, 0.1, test::with_hole()},
      {"SettledInAnLShape", box, "fill = true\nradius = 0.1\n", settled, 0.03, test::l_shape_mesh()},
      {"RelaxedInAnLShape", box, "count = 60\nradius = 0.1\n", relaxed, 0.03, test::l_shape_mesh()},
      {"PolishedInAnLShape", box, "count = 60\nradius = 0.1\n", stage("relax", "polish = 1e-8"), 0.03,
       test::l_shape_mesh()},
      {"RelaxedInAFineMesh", box, "count = 100\nradius = 0.1\n", relaxed, 0.03,
       test::divided(test::l_shape_mesh(), 4)},
      {"GrownInAPrism", box, "packing_fraction = 0.25\nradius = 0.12\n", grown, 0.04,
       test::prism_mesh(8, 1, 2)},
  };
}

struct Gaps {
  double gap, wall_gap;
};

class EveryGap : public ::testing::TestWithParam<Case> {
 protected:
  static Plan plan(const Gaps& gaps) {
    const Case& of = GetParam();
    const std::string toml = fmt::format("{}[spheres]\n{}gap = {}\nwall_gap = {}\n{}", of.container,
                                         of.spheres, gaps.gap, gaps.wall_gap, of.stages);
    return of.domain ? plan_of(toml, *of.domain) : plan_of(toml);
  }
  static bool walls() {
    const Plan of = plan({GetParam().gap, 0});
    return has_walls(of.domain);
  }
  /// Nearer to the wall than half the gap, as far as that, farther, and farther from that alone.
  static std::vector<Gaps> all() {
    const double gap = GetParam().gap;
    if (!walls()) return {{gap, 0}};
    return {{gap, 0}, {gap, 0.2 * gap}, {gap, 0.5 * gap}, {gap, 1.5 * gap}, {0, gap}};
  }
};

INSTANTIATE_TEST_SUITE_P(, EveryGap, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(EveryGap, IsKept) {
  for (const Gaps& gaps : all()) {
    SCOPED_TRACE(fmt::format("gap {}, wall gap {}", gaps.gap, gaps.wall_gap));
    const Plan made = plan(gaps);
    const Packing packing = testing::run_with(made);
    ASSERT_GT(packing.spheres.size(), 20u) << packing.reason;
    const double size = bounds_of<dynamic>(packing.domain).size().norm();
    // The rounding of the test's own formulas, and of coordinates of 50.
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * (size + 50);
    const double least = testing::least_gap(packing.spheres, packing.domain);
    EXPECT_GE(least, gaps.gap - rounding);
    const double from_walls = testing::least_wall_gap(packing.spheres, packing.domain);
    EXPECT_GE(from_walls, gaps.wall_gap - rounding);

    const CertifyOptions options{.gap = gaps.gap, .wall_gap = gaps.wall_gap};
    const Certificate certificate = certify(packing.spheres, packing.domain, options);
    EXPECT_TRUE(certificate.certified) << certificate.statement;
    if (certificate.least_distance) {
      EXPECT_NEAR(*certificate.least_distance, least, rounding);
    }
    if (certificate.least_wall_distance) {
      EXPECT_NEAR(*certificate.least_wall_distance, from_walls, rounding);
    }
    EXPECT_NEAR(packing.packing_fraction(),
                packing.volume > 0 ? packing_fraction(packing.spheres, packing.domain) : 0, 1e-12);

    // As drawn, in their order, but for those that found no place: without the gap around them. What
    // polishing enlarges in a container is that by one factor.
    RadiusSequence sequence(*made.radii, packing.seed, *made.scene.draw);
    std::size_t passed_over = 0;
    for (const double r : packing.spheres.r) {
      const auto is_drawn = [&](double drawn) {
        return packing.size_scale == 1 ? drawn == r : std::abs(packing.size_scale * drawn - r) < 1e-14 * r;
      };
      while (!is_drawn(sequence.next())) ASSERT_LT(++passed_over, packing.spheres.size());
    }
  }
}

// A packing with gaps is as dense as one without, of spheres with half the gap around them, as far as random
// ones are: nobody would call spheres far apart a packing.
TEST_P(EveryGap, IsNotMuchLargerThanAskedFor) {
  const Gaps gaps{GetParam().gap, 0.2 * GetParam().gap * walls()};
  const Packing packing = testing::run_with(plan(gaps));
  if (packing.packing_fraction() < 0.4) return;  // what is so loose need not touch
  EXPECT_LT(testing::least_gap(packing.spheres, packing.domain), 1.01 * gaps.gap);
  if (walls()) {
    EXPECT_LT(testing::least_wall_gap(packing.spheres, packing.domain), gaps.wall_gap + 0.2 * gaps.gap);
  }
}

}  // namespace gaps_test
}  // namespace bernal

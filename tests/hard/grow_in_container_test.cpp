#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "bernal/run/run.hpp"
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"
#include "support/refusals.hpp"

// Growth in containers where there is hardly room, very little to hold on to, or too much asked for: what is
// there is certified by rational arithmetic, and what is not is said.
namespace bernal {
namespace grow_in_container_test {

using testing::error_of;
using testing::plan_of;

const std::string grow = "\n[[stage]]\ndo = \"grow\"\n";
const std::string cube = "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";

std::string spheres(const std::string& lines) { return "[spheres]\n" + lines; }

Packing certified(const Plan& plan, Monitor monitor = {}) {
  RunOptions options;
  options.threads = 1;
  options.monitor = std::move(monitor);
  Packing packing = run(plan, options);
  const Certificate certificate = certify(packing.spheres, packing.domain, {.arithmetic = Arithmetic::exact});
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  return packing;
}

TEST(GrowthBetweenWalls, FillsAContainerWithOneSphere) {
  const std::string one = spheres("count = 1\nradius = 0.49999999") + grow + "pressure = 1e10";
  for (const std::string& container :
       {cube,
        std::string("[container]\nkind = \"cylinder\"\nradius = 0.5\nheight = 1.0\naxis = [1.0, 2.0, 3.0]\n"),
        std::string("[container]\nkind = \"sphere\"\nradius = 0.5\ncenter = [5.0, 0.0, 0.0]\n")}) {
    SCOPED_TRACE(container);
    const Packing packing = certified(plan_of(container + one));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_EQ(packing.spheres.size(), 1u);
  }
  EXPECT_EQ(certified(plan_of(cube + one, test::box_mesh({0, 0, 0}, {1, 1, 1}))).spheres.size(), 1u);
}

/// No room for rounding: it never grows to its size, but has its place.
TEST(GrowthBetweenWalls, PlacesWhatTouchesAllWallsExactly) {
  const Packing packing = certified(plan_of(cube + spheres("count = 1\nradius = 0.5") + grow));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(packing.spheres.size(), 1u);
}

/// 2,000 sides and two fans of needles pack as the round wall does.
TEST(GrowthBetweenWalls, PacksAFanOfNeedlesAsACylinder) {
  const std::string round = "[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 2.0\n" +
                            spheres("fill = true\nradius = 0.12") + grow + "rate = 0.05\npressure = 1e4";
  const Packing needles = certified(plan_of(round, test::prism_mesh(2000, 1, 2)));
  const Packing smooth = certified(plan_of(round));
  EXPECT_GT(needles.packing_fraction(), 0.55);
  EXPECT_NEAR(needles.packing_fraction(), smooth.packing_fraction(), 0.015);  // six of 500 spheres
}

/// Spheres that can hardly pass each other, in two dimensions and in one.
TEST(GrowthBetweenWalls, PacksSlabsAndTubesThinnerThanTwoDiameters) {
  const std::string quick = grow + "rate = 0.05\npressure = 1e4";
  const Packing slab = certified(plan_of("[container]\nkind = \"box\"\nsize = [20.0, 20.0, 1.3]\n" +
                                         spheres("fill = true\nradius = 0.5") + quick));
  EXPECT_GT(slab.spheres.size(), 250u);
  const Packing tube = certified(plan_of("[container]\nkind = \"cylinder\"\nradius = 0.55\nheight = 40.0\n" +
                                         spheres("fill = true\nradius = 0.5") + quick));
  EXPECT_GE(tube.spheres.size(), 39u);  // 40 in a row, and a little more as they zigzag
}

TEST(GrowthBetweenWalls, SaysWhatAnImpossibleTargetReaches) {
  const Packing packing =
      certified(plan_of(cube + spheres("count = 600\nradius = 0.07") + grow + "rate = 0.05"));
  EXPECT_EQ(packing.outcome, Outcome::full) << packing.reason;
  EXPECT_GT(packing.packing_fraction(), 0.55);
  EXPECT_NE(packing.reason.find("of 600 spheres"), std::string::npos) << packing.reason;
}

TEST(GrowthBetweenWalls, TakesTheDrawnSequenceLessItsTail) {
  for (const char* target : {"fill = true\n", ""}) {
    const Plan plan =
        plan_of(cube +
                spheres(std::string(target) +
                        "radius = { distribution = \"lognormal\", median = 0.04, sigma = 0.5 }") +
                grow + "rate = 0.05\npressure = 1e4");
    const Packing packing = certified(plan);
    ASSERT_GT(packing.spheres.size(), 300u);
    RadiusSequence sequence(*plan.radii, packing.seed, *plan.scene.draw);
    for (const double r : packing.spheres.r) ASSERT_EQ(r, sequence.next());
  }
}

TEST(GrowthBetweenWalls, GoesOnFromWhatIsThere) {
  const std::string insert = "\n[[stage]]\ndo = \"insert\"\n";
  const std::string target = spheres("packing_fraction = 0.55\nradius = 0.06") + insert;
  const Packing packing = certified(plan_of(cube + target + grow));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  // Nothing is left to do.
  const Packing again = certified(plan_of(cube + target + grow + grow));
  EXPECT_EQ(again.spheres, packing.spheres);
}

/// Spheres that start as specks find places.
TEST(GrowthBetweenWalls, StartsAsThinAsItIsTold) {
  const Packing packing =
      certified(plan_of(cube + spheres("count = 50\nradius = 0.1") + grow + "phi_init = 1e-7"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
}

TEST(GrowthBetweenWalls, SurvivesSurfacesFasterThanTheSpheres) {
  const Packing packing =
      certified(plan_of(cube + spheres("fill = true\nradius = 0.06") + grow + "delta = 100"));
  EXPECT_GT(packing.packing_fraction(), 0.05);  // they have no time to make room
}

/// A handful of spheres can jam within a period that was made for a fluid; pressures scatter that much.
TEST(GrowthBetweenWalls, ComesToAnEndWithAHandfulOfSpheres) {
  for (int seed = 1; seed <= 10; ++seed) {
    const Packing packing = certified(plan_of(
        fmt::format("seed = {}\n[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 1.0\n", seed) +
        spheres("packing_fraction = 0.5\nradius = 0.3") + grow + "rate = 0.3\npressure = 1e3"));
    EXPECT_GT(packing.spheres.size(), 3u);
  }
}

TEST(GrowthBetweenWalls, TakesAContainerFarFromTheOrigin) {
  const Packing packing = certified(
      plan_of("[container]\nkind = \"cylinder\"\nradius = 2.0\nheight = 5.0\naxis = [1.0, 2.0, 3.0]\n"
              "base = [30000.0, -20000.0, 50000.0]\n" +
              spheres("packing_fraction = 0.55\nradius = 0.3") + grow));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
}

TEST(GrowthBetweenWalls, KeepsWhatWasThereWhereItDoesWorse) {
  int asked = 0;
  const std::string target =
      spheres("packing_fraction = 0.6\nradius = 0.06") + "\n[[stage]]\ndo = \"insert\"\n";
  const std::size_t inserted = run(plan_of(cube + target)).spheres.size();
  const Packing packing =
      certified(plan_of(cube + target + grow),
                {.on_progress = {}, .cancelled = [&] { return ++asked > static_cast<int>(inserted) + 200; }});
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_GE(packing.spheres.size(), inserted);
}

/// Boxes that end at walls along some axes or all of them: as thin as a sphere, jammed, in two to four
/// dimensions.
TEST(GrowthBetweenWalls, KnowsTheWallsOfPeriodicBoxes) {
  const auto box = [](const std::string& size, const std::string& lines, const std::string& more = "") {
    return plan_of(
        fmt::format("[container]\nkind = \"periodic\"\n{}\n[spheres]\n{}\n[[stage]]\ndo = \"grow\"\n{}", size,
                    lines, more));
  };
  const Packing slab = certified(box("size = [10.0, 10.0, 1.001]\nwalls = [2]", "count = 70\nradius = 0.5"));
  EXPECT_EQ(slab.outcome, Outcome::converged) << slab.reason;
  const Packing disc_pack = certified(
      box("dimension = 2\nsize = [10.0, 10.0]\nwalls = [0, 1]", "count = 85\nradius = 0.5", "rate = 0.001"));
  EXPECT_EQ(disc_pack.outcome, Outcome::converged) << disc_pack.reason;
  const Packing four = certified(box("dimension = 4\nsize = [4.0, 4.0, 4.0, 4.0]\nwalls = [3]",
                                     "packing_fraction = 0.3\nradius = 0.5", "rate = 0.1"));
  EXPECT_EQ(four.outcome, Outcome::converged) << four.reason;
  const Packing jammed = certified(box("size = [4.0, 5.0, 4.0]\nwalls = [0, 2]",
                                       "packing_fraction = 0.7\nradius = 0.5", "rate = 0.1\npressure = 1e8"));
  EXPECT_EQ(jammed.outcome, Outcome::full);
  EXPECT_GT(jammed.packing_fraction(), 0.45);
}

/// Edges that stand into the container, chambers that no sphere leaves, walls as thin as a hundredth of it.
TEST(GrowthBetweenWalls, PacksWhatIsNotConvex) {
  const std::string asked = spheres("packing_fraction = 0.45\nradius = 0.1") + grow;
  for (const Mesh& mesh :
       {test::l_shape_mesh(), test::torus_mesh(1, 0.4, 24, 12), test::baffle_mesh(0.3, 1),
        test::two_cubes_mesh(0.05), test::two_cubes_mesh(0.3),
        test::joined(test::icosphere_mesh(1, 3), test::inverted(test::icosphere_mesh(0.4, 2)))}) {
    const Packing packing = certified(plan_of(cube + asked, mesh));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GE(packing.packing_fraction(), 0.45);
  }
  const Packing jammed =
      certified(plan_of(cube + spheres("fill = true\nradius = 0.1") + grow + "rate = 0.05\npressure = 1e4",
                        test::l_shape_mesh(2)));
  EXPECT_GT(jammed.packing_fraction(), 0.5);
}

/// As wide as their chambers, spheres are never as large as they have to be in flight, and have their places.
TEST(GrowthBetweenWalls, PlacesWhatHardlyFitsBetweenWallsThatAreNotConvex) {
  const Packing packing = certified(plan_of(cube + spheres("count = 2\nradius = 0.4999999999") + grow,
                                            test::scaled(test::two_cubes_mesh(0.05), 0.5)));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(packing.spheres.size(), 2u);
}

TEST(GrowthBetweenWalls, PacksSolidsOfRevolution) {
  for (const std::string container : {"kind = \"cone\"\nradii = [3, 1]\nheight = 4\n",
                                      "kind = \"tube\"\nradius = 2\ninner_radius = 0.7\nheight = 3\n",
                                      "kind = \"revolved\"\nprofile = [[0, 0], [2, 0], [2, 1.5], [1, 2.2], "
                                      "[2, 3], [2, 4.5], [0, 4.5]]\n"}) {
    SCOPED_TRACE(container);
    const Packing packing = certified(
        plan_of("[container]\n" + container + spheres("packing_fraction = 0.45\nradius = 0.2") + grow));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GE(packing.packing_fraction(), 0.45);
  }
}

TEST(GrowthBetweenWalls, RefusesWhatItCannotDo) {
  const auto in_mesh = [](const Mesh& mesh, const std::string& lines, const std::string& more = "") {
    try {
      run(plan_of(cube + spheres(lines) + grow + more, mesh));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // A triangle of edge √3 has an inscribed circle of radius 1/2.
  EXPECT_NE(in_mesh(test::prism_mesh(3, 1, 2), "count = 10\nradius = 0.51").find("does not fit"),
            std::string::npos);
  EXPECT_EQ(in_mesh(test::prism_mesh(3, 1, 2), "count = 2\nradius = 0.49"), "");
  EXPECT_EQ(in_mesh(test::prism_mesh(3, 1, 2), "count = 2\nradius = 0.49", "pressure = 10"), "");
}

}  // namespace grow_in_container_test
}  // namespace bernal

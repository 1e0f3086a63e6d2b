#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "support/measured.hpp"
#include "support/nearest_images.hpp"
#include "support/plans.hpp"
#include "support/refusals.hpp"

// Growth where there are few spheres, narrow boxes, spheres that touch from the start, extreme sizes or
// extreme speeds: it ends by itself, radii are the drawn ones to the bit, and nothing overlaps by rational
// arithmetic.
namespace bernal {
namespace grow_test {

using testing::error_of;
using testing::plan_of;

std::string scene(const std::string& box, const std::string& spheres, const std::string& stage = "",
                  const std::string& before = "") {
  return fmt::format("[container]\nkind = \"periodic\"\n{}\n[spheres]\n{}\n{}[[stage]]\ndo = \"grow\"\n{}\n",
                     box, spheres, before, stage);
}

Packing grown(const std::string& toml, Monitor monitor = {}) {
  RunOptions options;
  options.threads = 1;
  options.monitor = std::move(monitor);
  Packing packing = run(plan_of(toml), options);
  with_dimension(packing.spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    const Vector<D> edges = std::get<Box>(packing.domain).size;
    EXPECT_TRUE(oracle::centers_in_box<D>(packing.spheres.in<D>(), edges));
    EXPECT_EQ(oracle::overlapping_pairs<D>(packing.spheres.in<D>(), edges), 0u);
  });
  return packing;
}

TEST(Growth, JamsInEveryDimensionThatItKnows) {
  // Of small packings of equal spheres, which are looser than large ones; in two dimensions they are crystals
  // with faults.
  const double least[] = {0.80, 0.625, 0.44, 0.28, 0.16};
  const int count[] = {150, 300, 400, 500, 1200};
  for (int dimension = 2; dimension <= 6; ++dimension) {
    SCOPED_TRACE(dimension);
    const Packing packing = grown(scene(fmt::format("dimension = {}", dimension),
                                        fmt::format("count = {}\nradius = 1.0", count[dimension - 2]),
                                        "rate = 0.02\npressure = 1e4"));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), least[dimension - 2]);
  }
}

/// What fast growth locks at its pressure, at 0.58, slower growth goes on to pack.
TEST(Growth, JamsHoweverFastItBegan) {
  for (const double delta : {1.0, 4.0}) {
    const Packing packing = grown(scene("", "count = 300\nradius = 1.0", fmt::format("delta = {}", delta)));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.62) << delta;
  }
}

TEST(Growth, KeepsTheDrawnRadiiToTheBit) {
  const std::string spheres =
      "count = 300\nradius = { distribution = \"lognormal\", median = 0.7, sigma = 0.4 }";
  const Packing grown_spheres = grown(scene("", spheres, "rate = 0.1\npressure = 1e3"));
  const Packing relaxed = run(plan_of("[container]\nkind = \"periodic\"\n[spheres]\n" + spheres +
                                      "\n[[stage]]\ndo = \"relax\"\nalpha = 0.5\n"));
  EXPECT_EQ(grown_spheres.spheres.r, relaxed.spheres.r);
}

TEST(Growth, EndsAtThePackingFractionThatIsAskedFor) {
  const Packing packing =
      grown(scene("scalable = true", "count = 400\npacking_fraction = 0.6\nradius = 1.0"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_NEAR(packing.packing_fraction(), 0.6, 1e-9);
}

TEST(Growth, SaysWhatAnImpossibleTargetNeeds) {
  const Packing packing =
      grown(scene("scalable = true", "count = 200\npacking_fraction = 0.7\nradius = 1.0", "rate = 0.1"));
  EXPECT_EQ(packing.outcome, Outcome::full);
  EXPECT_GT(packing.packing_fraction(), 0.6);
  EXPECT_NE(packing.reason.find("as large by volume"), std::string::npos) << packing.reason;
}

/// Below phi_init there is nothing to grow: random insertion is the packing.
TEST(Growth, PlacesThinlySpreadSpheresAtOnce) {
  const Packing packing = grown(scene("edge = 20.0", "count = 50\nradius = 1.0"));
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_EQ(std::get<Box>(packing.domain).size[0], 20.0);
}

TEST(Growth, CompressesWhatRelaxationLeaves) {
  const std::string relax = "[[stage]]\ndo = \"relax\"\nalpha = 2\n";
  const std::string spheres = "count = 500\nradius = 1.0";
  const Packing relaxed =
      run(plan_of("[container]\nkind = \"periodic\"\n[spheres]\n" + spheres + "\n" + relax));
  const Packing packing = grown(scene("", spheres, "pressure = 1e5", relax));
  EXPECT_GE(packing.packing_fraction(), relaxed.packing_fraction());
  EXPECT_LT(packing.packing_fraction(), relaxed.packing_fraction() + 0.01);
}

/// Hard spheres cannot start where others left them overlapping, as the scene allows: the box makes room.
TEST(Growth, StartsFromSpheresThatOverlap) {
  const Packing packing = grown("[accuracy]\noverlap = 1e-3\n" +
                                scene("", "count = 300\nradius = 0.5", "rate = 0.1\npressure = 1e4",
                                      "[[stage]]\ndo = \"relax\"\nalpha = 2\n"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_GT(packing.packing_fraction(), 0.6);
}

/// Jammed to the last digits: many gaps are zero, and some are negative by rounding.
TEST(Growth, StartsFromSpheresThatTouch) {
  const Packing packing = grown(scene("", "count = 216\nradius = 1.0", "pressure = 1e8",
                                      "[[stage]]\ndo = \"grow\"\nrate = 0.1\npressure = 1e12\n"));
  EXPECT_EQ(packing.outcome, Outcome::converged);
}

TEST(Growth, GoesOnWherePressureIsExtreme) {
  const Packing packing = grown(scene("", "count = 100\nradius = 1.0", "rate = 0.05\npressure = 1e13"));
  EXPECT_EQ(packing.outcome, Outcome::converged);
  EXPECT_GT(packing.packing_fraction(), 0.6);
}

TEST(Growth, SurvivesSurfacesFasterThanTheSpheres) {
  const Packing packing = grown(scene("", "count = 300\nradius = 1.0", "delta = 100\npressure = 1e6"));
  EXPECT_GT(packing.packing_fraction(), 0.2);  // they have no time to make room
}

TEST(Growth, TakesSizesThatDifferEightfold) {
  const Packing packing = grown(
      scene("",
            "count = 3000\nradius = { distribution = \"classes\", values = [8.0, 1.0], shares = [80, 20], "
            "basis = \"volume\" }\ndraw = \"quantiles\"",
            "rate = 0.1\npressure = 1e3"));
  EXPECT_EQ(packing.spheres.size(), 3000u);
  EXPECT_GT(packing.packing_fraction(), 0.6);
}

TEST(Growth, TakesBoxesOfUnequalEdges) {
  const Packing packing = grown(scene("size = [1.0, 2.0, 4.0]\nscalable = true", "count = 400\nradius = 1.0",
                                      "rate = 0.1\npressure = 1e3"));
  const Vector<dynamic>& edges = std::get<Box>(packing.domain).size;
  EXPECT_NEAR(edges[2] / edges[0], 4, 1e-12);
}

/// The rule of Maxwell: D (N - 1) + 1 contacts between those that bear force.
TEST(Growth, PolishedIsIsostatic) {
  const Packing packing = grown(scene("", "count = 200\nradius = 1.0", "pressure = 1e4\npolish = 1e-9"));
  const Contacts contacts = measure_contacts(packing, 1e-7);
  const double isostatic = 3 * (static_cast<double>(contacts.backbone) - 1) + 1;
  EXPECT_NEAR(static_cast<double>(contacts.backbone_pairs) / isostatic, 1, 0.005);
}

TEST(Growth, EndsWhenCancelled) {
  int asked = 0;
  const Packing packing = grown(scene("", "count = 1000\nradius = 1.0"),
                                {.on_progress = {}, .cancelled = [&] { return ++asked > 20; }});
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_EQ(packing.spheres.size(), 1000u);
}

TEST(Growth, RefusesWhatItCannotDo) {
  EXPECT_NE(error_of(scene("", "count = 3\nradius = 1.0")).find("more spheres"), std::string::npos);
  EXPECT_NE(error_of(scene("dimension = 7", "count = 300\nradius = 1.0")).find("2 to 6"), std::string::npos);
  EXPECT_NE(error_of(scene("", "count = 2000\nradius = 1.0", "phi_init = 0.45")).find("phi_init"),
            std::string::npos);
}

}  // namespace grow_test
}  // namespace bernal

// Spheres that are to be as large as so many fit, against optima that are known in closed form, and the law
// that the result runs again.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/refusals.hpp"

namespace bernal {
namespace largest_test {

const std::string cube = "kind = \"box\"\nsize = [1, 1, 1]\n", ball = "kind = \"sphere\"\nradius = 1\n";

std::string scene_in(const std::string& container, const std::string& spheres) {
  return "unit = \"mm\"\nseed = 3\n[container]\n" + container + "[spheres]\n" + spheres + "\n";
}

Packing packed(const std::string& toml, const RunOptions& options = {}) {
  return run(build(parse_scene(toml, "scene.toml")), options);
}

struct Known {
  std::string container;
  int count;
  double radius;
};

// In the unit ball 12 spheres at the corners of an icosahedron touch the ball and a 13th in its middle: r =
// 1/3, the best known (H. Pfoertner's table of densest packings in a sphere). In the unit cube the optima of
// Schaer (1966): 2 on a diagonal, 4 in a tetrahedron, 8 in a lattice, 9 with one in the middle of that; of 14
// the face-centred cube is the best known (Gensane 2004). In the periodic cube body- and face-centred.
TEST(Largest, AreAsLargeAsIsKnownButForTheGapsThatStagesLeave) {
  const double two = std::sqrt(2.0), three = std::sqrt(3.0);
  const Known all[] = {{ball, 1, 1},
                       {ball, 2, 0.5},
                       {ball, 13, 1.0 / 3},
                       {cube, 1, 0.5},
                       {cube, 2, three / (2 + 2 * three)},
                       {cube, 4, 1 / (2 + two)},
                       {cube, 8, 0.25},
                       {cube, 9, three / (4 + 2 * three)},
                       {cube, 14, 1 / (2 + 2 * two)},
                       {"kind = \"periodic\"\nedge = 1\n", 2, three / 4},
                       {"kind = \"periodic\"\nedge = 1\n", 4, two / 4}};
  for (const Known& known : all) {
    SCOPED_TRACE(known.container + std::to_string(known.count));
    const Packing packing = packed(
        scene_in(known.container, "count = " + std::to_string(known.count) + "\nradius = \"largest\""));
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    ASSERT_EQ(packing.spheres.size(), static_cast<std::size_t>(known.count));
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
    for (const double r : packing.spheres.r) EXPECT_EQ(r, packing.spheres.r.front());
    // 1e-4 of it is the gap that relaxation leaves.
    EXPECT_GE(packing.spheres.r.front(), (1 - 2e-4) * known.radius) << packing.reason;
    EXPECT_LE(packing.spheres.r.front(), (1 + 1e-9) * known.radius);
  }
}

TEST(Largest, ResultRunsAgainToTheBitAndSoDoesTheSearch) {
  for (const std::string sizes :
       {"diameter = \"largest\"",
        "diameter = { distribution = \"lognormal\", median = 3, sigma = 0.3 }\nscale = \"largest\""}) {
    const std::string toml = scene_in(cube, "count = 6\n" + sizes);
    const Packing packing = packed(toml, {.seed = {}, .threads = 1});
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.3);
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
    EXPECT_EQ(hash_of(packed(toml, {.seed = {}, .threads = 2}).spheres), hash_of(packing.spheres));
    const std::string result = scene_as_toml(packing.scene);
    EXPECT_EQ(result.find("largest"), std::string::npos) << result;
    EXPECT_EQ(hash_of(packed(result).spheres), hash_of(packing.spheres)) << result;
  }
}

TEST(Largest, ScaleMultipliesEverySize) {
  const std::string sizes =
      "count = 50\ndiameter = { distribution = \"classes\", values = [1, 2], shares = [1, 1] }\n";
  const std::string box = "kind = \"box\"\nsize = [20, 20, 20]\n";
  Spheres<dynamic> as_given = packed(scene_in(box, sizes)).spheres;
  Spheres<dynamic> twice = packed(scene_in(box, sizes + "scale = 2")).spheres;
  std::ranges::sort(as_given.r);
  std::ranges::sort(twice.r);
  for (std::size_t i = 0; i < twice.size(); ++i) EXPECT_EQ(twice.r[i], 2 * as_given.r[i]);
  const Scene scene = parse_scene(scene_in(box, sizes + "scale = 2"), "scene.toml");
  EXPECT_NE(scene_as_toml(scene).find("scale = 2"), std::string::npos);
}

TEST(Largest, StopsWithWhatItHas) {
  std::atomic<int> asked = 0;
  RunOptions options;
  options.monitor.cancelled = [&] { return ++asked > 2000; };
  const Packing packing = packed(scene_in(cube, "count = 200\nradius = \"largest\""), options);
  EXPECT_EQ(packing.outcome, Outcome::cancelled);
  EXPECT_TRUE(packing.reason.starts_with("stopped by the user")) << packing.reason;
  EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
}

TEST(Largest, NeedsACountAndABoxOfGivenSize) {
  const auto refused = [](const std::string& container, const std::string& spheres) {
    return testing::error_of(scene_in(container, spheres));
  };
  EXPECT_NE(refused(cube, "radius = \"largest\"").find("needs \"count\""), std::string::npos);
  EXPECT_NE(refused(cube, "diameter = 1\nscale = \"largest\"").find("needs \"count\""), std::string::npos);
  EXPECT_NE(refused("kind = \"periodic\"\n", "count = 9\nradius = \"largest\"").find("give it a \"size\""),
            std::string::npos);
  EXPECT_NE(refused(cube, "count = 9\nradius = \"largets\"").find("or \"largest\""), std::string::npos);
  EXPECT_NE(refused(cube, "count = 9\nradius = 1\nscale = 0").find("\"scale\""), std::string::npos);
}

}  // namespace largest_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "bernal/core/error.hpp"
#include "bernal/measure/rest.hpp"
#include "support/plain_check.hpp"
#include "support/plans.hpp"
#include "support/starts.hpp"

// Beds whose surface is asked for: a height, a level, a heap; poured onto what is there; to the brim.
namespace bernal {
namespace bed_surface_test {

const std::string cylinder = "[container]\nkind = \"cylinder\"\nradius = 6\nheight = 24\n";

/// Packed, certified by brute force, and at rest.
Packing at_rest(const std::string& scene) {
  Packing packing = run(testing::plan_of(scene));
  EXPECT_EQ(measure_rest(packing.spheres, packing.domain, {0, 0, -1}).unsettled, 0u) << scene;
  EXPECT_EQ(testing::plain_objection(packing.spheres, packing.domain, 0), "") << scene;
  return packing;
}

double highest(const Packing& packing) {
  double top = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    top = std::max(top, packing.spheres.x[2][i] + packing.spheres.r[i]);
  return top;
}

/// Of a bed with a level top that is as dense everywhere, by its centre of mass.
double level_of(const Packing& packing) {
  double sum = 0, volume = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const double own = std::pow(packing.spheres.r[i], 3);
    sum += own * packing.spheres.x[2][i];
    volume += own;
  }
  return 2 * sum / volume;
}

TEST(BedSurface, IsAsHighAsIsAskedAndNoSphereReachesHigher) {
  for (const char* sizes :
       {"diameter = 1.0\n", "diameter = { distribution = \"uniform\", min = 0.6, max = 1.4 }\n"})
    for (const auto& [key, height] : {std::pair("height = 10\n", 10.0), std::pair("height = 24\n", 24.0),
                                      std::pair("bed_layers = 4\n", 4.0), std::pair("height = 2.5\n", 2.5)}) {
      const Packing packing = at_rest(cylinder + "[spheres]\n" + key + sizes);
      EXPECT_EQ(packing.outcome, Outcome::converged) << key << packing.reason;
      EXPECT_LE(highest(packing), height * (1 + 1e-12)) << key << sizes;
      EXPECT_GT(level_of(packing), height - 0.3) << key << sizes;
    }
}

TEST(BedSurface, KeepsItsHeightWithGapsAndAlongAnotherAxis) {
  const Packing packing = run(testing::plan_of(
      "[container]\nkind = \"cylinder\"\nradius = 6\nheight = 24\naxis = [1, 0, 0]\nbase = [3, 0, 0]\n"
      "[spheres]\nheight = 10\ndiameter = 1.0\ngap = 0.05\nwall_gap = 0.4\n[[stage]]\ndo = \"settle\"\n"
      "direction = [1, 0, 0]\n"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_GE(std::ranges::min(packing.spheres.x[0]), 27 - 10 + 0.5);
  EXPECT_LE(std::ranges::min(packing.spheres.x[0]), 27 - 10 + 0.7);
  EXPECT_LE(std::ranges::max(packing.spheres.x[0]), 27 - 0.9 + 1e-9);
}

/// The tip's height and the slope in degrees, of a heap in a cylinder: a line through the topmost spheres of
/// square cells.
std::pair<double, double> tip_and_slope(const Packing& packing, double radius) {
  std::map<std::pair<int, int>, double> tops;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    double& top = tops[{static_cast<int>(std::floor(packing.spheres.x[0][i])),
                        static_cast<int>(std::floor(packing.spheres.x[1][i]))}];
    top = std::max(top, packing.spheres.x[2][i] + packing.spheres.r[i]);
  }
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [cell, top] : tops) {
    const double rho = std::hypot(cell.first + 0.5, cell.second + 0.5);
    if (rho < 1 || rho > radius - 1.5) continue;
    n += 1, x += rho, y += top, xx += rho * rho, xy += rho * top;
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return {(y - slope * x) / n, -std::atan(slope) * 180 / std::numbers::pi};
}

TEST(BedSurface, IsAHeapOfTheAngleThatIsAsked) {
  for (const double angle : {15.0, 25.0, 35.0}) {
    const Packing packing = at_rest(
        "[container]\nkind = \"cylinder\"\nradius = 12\nheight = 40\n[spheres]\nheight = 14\ntop = "
        "\"heap\"\nheap_angle = " +
        std::to_string(angle) + "\ndiameter = 1.0\n");
    const auto [tip, slope] = tip_and_slope(packing, 12);
    EXPECT_NEAR(slope, angle, 2.5);
    EXPECT_NEAR(tip, 14, 0.8);
    EXPECT_LE(highest(packing), 14);
  }
}

TEST(BedSurface, LiesAtTheBrimWhereMoreIsAskedForThanABedHolds) {
  const Packing full = at_rest(cylinder + "[spheres]\nbed = \"poured\"\ndiameter = 1.0\n");
  EXPECT_EQ(full.outcome, Outcome::converged) << full.reason;
  const Packing beyond = at_rest(cylinder + "[spheres]\nbed = \"poured\"\ncount = 5000\ndiameter = 1.0\n");
  EXPECT_EQ(beyond.outcome, Outcome::full) << beyond.reason;
  EXPECT_NEAR(static_cast<double>(beyond.spheres.size()), static_cast<double>(full.spheres.size()),
              0.01 * static_cast<double>(full.spheres.size()));
  EXPECT_NEAR(level_of(beyond), 24, 0.5);
}

class Poured : public testing::starts::StartFixture {};

/// What is poured onto a bed does not stir it; and it is as dense as others.
TEST_F(Poured, OntoABedDoesNotStirIt) {
  const Packing first = at_rest(cylinder + "[spheres]\ncount = 600\nbed = \"poured\"\ndiameter = 1.0\n");
  write("start.csv", first.spheres);
  for (const char* target : {"count = 1500\nbed = \"poured\"\n", "height = 15\n", "bed = \"poured\"\n"}) {
    const Packing second = at_rest(cylinder + "[spheres]\n" + target + "start = \"" +
                                   (folder / "start.csv").string() + "\"\ndiameter = 0.8\n");
    EXPECT_EQ(second.outcome, Outcome::converged) << second.reason;
    ASSERT_GT(second.spheres.size(), 1000u);
    for (std::size_t i = 0; i < first.spheres.size(); ++i)
      EXPECT_LT((second.spheres.center(i) - first.spheres.center(i)).norm(), 1e-6) << i;
    double above = 0;
    for (std::size_t i = first.spheres.size(); i < second.spheres.size(); ++i)
      above += std::pow(second.spheres.r[i], 3);
    const double solid = 4.0 / 3 * (600 * 0.125 + above) / (36 * level_of(second));
    EXPECT_NEAR(solid, 0.58, 0.02) << target;
  }
}

/// One sphere on the floor, and a pyramid: nobody waits for ever for what stands beside them.
TEST_F(Poured, AroundWhatStandsUnevenlyInAnyDensity) {
  Spheres<dynamic> one(3), pyramid(3);
  one.push_back(Vector<3>(3, 3, 0.5), 0.5);
  for (int layer = 0; layer < 4; ++layer)
    for (int i = 0; i < 4 - layer; ++i)
      for (int k = 0; k < 4 - layer; ++k)
        pyramid.push_back(
            Vector<3>(1.3 + 0.5 * layer + 1.001 * i, 1.3 + 0.5 * layer + 1.001 * k, 0.5 + 0.72 * layer), 0.5);
  for (const auto& [start, box] : {std::pair(one, "[6, 6, 8]"), std::pair(pyramid, "[7, 7, 9]")}) {
    write("start.csv", start);
    for (const char* density : {"porosity = 0.45\n", "bed = \"poured\"\n", "bed = \"loose\"\n"}) {
      const std::string scene = std::string("[container]\nkind = \"box\"\nsize = ") + box +
                                "\n[spheres]\nstart = \"start.csv\"\ndiameter = 1.0\nheight = 4\n" + density;
      const Packing packing = packed(scene);
      EXPECT_GT(packing.spheres.size(), 50u) << scene << packing.reason;
      EXPECT_EQ(testing::plain_objection(packing.spheres, packing.domain, 0), "") << scene;
      EXPECT_EQ(measure_rest(packing.spheres, packing.domain, {0, 0, -1}, {.friction = 45}).unsettled, 0u)
          << scene;
    }
  }
}

TEST(BedSurface, ThatCannotBeIsRefused) {
  const auto refusal = [](const std::string& spheres, const std::string& stages = "") {
    try {
      testing::plan_of(cylinder + "[spheres]\ndiameter = 1.0\n" + spheres + stages);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  for (const auto& [spheres, part] : {std::pair("height = 0.7\n", "has no room for the largest spheres"),
                                      std::pair("bed_layers = 30\n", "is higher than the container"),
                                      std::pair("count = 100\nheight = 10\n", "exclude each other"),
                                      std::pair("heap_angle = 20\nbed = \"poured\"\n", "say top = \"heap\""),
                                      std::pair("top = \"heap\"\nheap_angle = 80\n", "heap_angle"),
                                      std::pair("top = \"heap\"\n", "a heap needs"),
                                      std::pair("fill = true\nporosity = 0.4\n", "exclude each other"),
                                      std::pair("gap = 0.1\nbed = \"loose\"\n", "spheres which touch"),
                                      std::pair("bed = \"loose\"\nporosity = 0.4\n", "exclude each other")})
    EXPECT_NE(refusal(spheres).find(part), std::string::npos) << spheres << refusal(spheres);
  EXPECT_NE(refusal("height = 10\n", "[[stage]]\ndo = \"relax\"\n").find("no stage makes one"),
            std::string::npos);
}

}  // namespace bed_surface_test
}  // namespace bernal

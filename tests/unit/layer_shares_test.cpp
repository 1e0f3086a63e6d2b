// What layers take up of spheres that are not packed yet.
#include "bernal/plan/layer_shares.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace layer_shares_test {

std::vector<LayerShare> shares_of(const std::string& spheres) {
  return layer_shares(parse_scene(testing::with_spheres(spheres), "s.toml"));
}

TEST(LayerShares, OfEqualSpheresAreThoseOfOne) {
  const auto all = shares_of(
      "radius = 0.5\nlayers = [{ name = \"kernel\", radius = 0.25, material = \"UO2\" }, { name = "
      "\"buffer\", "
      "thickness = 0.1 }, { name = \"shell\", material = \"UO2\" }]");
  ASSERT_EQ(all.size(), 3u);
  EXPECT_NEAR(all[0].share, 0.125, 1e-14);
  EXPECT_NEAR(all[1].share, std::pow(0.7, 3) - 0.125, 1e-14);
  EXPECT_NEAR(all[2].share, 1 - std::pow(0.7, 3), 1e-14);
  EXPECT_EQ(all[1].material, "buffer");
  const auto materials = by_material(all);
  ASSERT_EQ(materials.size(), 2u);
  EXPECT_NEAR(materials[0].share, 0.125 + 1 - std::pow(0.7, 3), 1e-14);
}

// <(r - t)³> by the moments of the lognormal.
TEST(LayerShares, OfLognormalSpheresAreInClosedForm) {
  const double sigma = 0.3, t = 0.05;
  const auto moment = [&](int k) { return std::exp(0.5 * k * k * sigma * sigma); };
  // Cut far below the surface of what is measured, so that no sphere is too small.
  const auto all = shares_of(
      "radius = { distribution = \"lognormal\", median = 1.0, sigma = 0.3, basis = \"number\", min = 0.15 }\n"
      "layers = [{ name = \"core\" }, { name = \"shell\", thickness = 0.05 }]");
  const double core = (moment(3) - 3 * t * moment(2) + 3 * t * t * moment(1) - t * t * t) / moment(3);
  EXPECT_NEAR(all[0].share, core, 2e-6);
  EXPECT_NEAR(all[0].share + all[1].share, 1, 1e-12);
}

// <(r - t)³> by the moments of the normal: t³ has 3 m s² + m³, t² m² + s².
TEST(LayerShares, OfDrawnThicknessesAreMeans) {
  const double m = 0.1, s = 0.02;
  const auto all = shares_of(
      "radius = 1.0\nlayers = [{ name = \"core\" }, { name = \"shell\", thickness = { distribution = "
      "\"normal\", mean = 0.1, sd = 0.02, min = 1e-6, max = 0.3 } }]");
  EXPECT_NEAR(all[0].share, 1 - 3 * m + 3 * (m * m + s * s) - (m * m * m + 3 * m * s * s), 5e-6);
}

TEST(LayerShares, OfClassesCountByTheirVolume) {
  const auto all = shares_of(
      "radius = { distribution = \"classes\", values = [0.5, 1.0], shares = [8, 1], basis = \"number\", "
      "names = "
      "[\"fuel\", \"dummy\"], layers = [[{ name = \"kernel\", radius = 0.25 }, { name = \"coat\" }], []] }");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].sphere_class, "fuel");
  EXPECT_NEAR(all[0].share, 0.5 / 8, 1e-14);
  EXPECT_NEAR(all[1].share, 0.5 * 7 / 8, 1e-14);
}

TEST(LayerShares, AreNoneWithoutLayersAndRefusedWhereTheyDoNotFit) {
  EXPECT_TRUE(shares_of("radius = 1").empty());
  EXPECT_THROW(shares_of("radius = { distribution = \"lognormal\", median = 1.0, sigma = 0.5 }\n"
                         "layers = [{ name = \"core\" }, { name = \"shell\", thickness = 0.9 }]"),
               Error);
}

}  // namespace layer_shares_test
}  // namespace bernal

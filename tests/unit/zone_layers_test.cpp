// Layers of spheres in zones: each zone's are held against its own sizes, before any of them is packed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/result/layers_table.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace zone_layers_test {

constexpr const char* box = "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10, 10, 30]\n";

/// The zones, the second of which has layers.
Scene two_zones(const std::string& places, const std::string& radius, const std::string& more = {}) {
  const std::string second = places == "x" ? "[\"x > 5\"]" : "[\"z > 5\", \"z < 12\"]";
  return parse_scene(box + std::string("[[zone]]\nname = \"plain\"\nplace = [\"") + places +
                         " < 5\"]\nradius = 0.4\n" + (places == "x" ? "count = 100\n" : "") +
                         "[[zone]]\nname = \"coated\"\nplace = " + second + "\nradius = " + radius + "\n" +
                         (places == "x" ? "count = 100\n" : "") +
                         "layers = [{ name = \"core\" }, { name = \"coat\", thickness = 0.3 }]\n" + more,
                     "zones.toml");
}

TEST(ZoneLayers, ThatDoNotFitAreRefusedBeforeTheFirstZone) {
  const Plan plan = build(
      two_zones("x", "{ distribution = \"lognormal\", median = 0.5, sigma = 0.4, basis = \"number\" }"));
  bool began = false;
  RunOptions options;
  options.monitor.on_progress = [&](const Progress&) { began = true; };
  try {
    run(plan, options);
    ADD_FAILURE() << "spheres of less than 0.3 mm were given a coat of 0.3 mm";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_NE(
        std::string(error.what()).find("zones.toml:15: the \"layers\" do not fit into spheres of radius 0."),
        std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(began) << "a zone was packed for nothing";
}

// Layers of a bed begin from the spheres below, which are of other sizes.
TEST(ZoneLayers, OfOneZoneAreNotThoseOfTheSpheresBelow) {
  const Packing packing = run(build(two_zones("z", "1.0", "[[stage]]\ndo = \"settle\"\n")));
  const SphereLayers layers = layers_of(packing);
  std::size_t coated = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    EXPECT_EQ(layers.of(i).size(), packing.classes[i] == 1 ? 2u : 0u);
    if (packing.classes[i] == 0) continue;
    EXPECT_DOUBLE_EQ(layers.of(i)[0], 0.7);
    ++coated;
  }
  EXPECT_GT(coated, 20u);
  EXPECT_EQ(layer_amounts(packing).layers.at(0).spheres, coated);
  const testing::Folder out;
  write_packing(packing, out.path());
  EXPECT_EQ(layers_table_of(packing, out.path()).value().fault, "");
}

// Shares end alike in spheres of any size, those of classes too.
TEST(ZoneLayers, SharesOfClassesMayBeOfTheLargestSpheres) {
  const auto scene_of = [](const std::string& end) {
    return parse_scene(
        box +
            std::string("[spheres]\ncount = 4\nscale = \"largest\"\nradius = { distribution = "
                        "\"classes\", values = [1.0, 2.0], shares = [1, 1], basis = \"number\", names = "
                        "[\"a\", \"b\"], layers = [[], [{ name = \"core\" }, { name = \"coat\", ") +
            end + " }]] }\n",
        "largest.toml");
  };
  const Packing packing = run(build(scene_of("share = 0.2")));
  const SphereLayers layers = layers_of(packing);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    ASSERT_EQ(layers.of(i).size(), packing.classes[i] == 1 ? 2u : 0u);
    if (packing.classes[i] == 1) {
      EXPECT_NEAR(layers.of(i)[0] / packing.spheres.r[i], std::cbrt(0.8), 1e-14);
    }
  }
  EXPECT_GT(packing.scene.scale, 1);
  EXPECT_THROW(scene_of("thickness = 0.2"), Error);
}

}  // namespace zone_layers_test
}  // namespace bernal

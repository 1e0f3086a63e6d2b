// What spheres weigh that others fill: the same as all spheres and what is between them, each by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <regex>

#include "bernal/plan/layer_shares.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/scene/layer_amounts.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "report/class_amounts.hpp"
#include "support/nests.hpp"

namespace bernal {
namespace nest_amounts_test {

using testing::Nested;

double ball(double r) { return 4.0 / 3 * std::numbers::pi * r * r * r; }

constexpr const char* particles = R"(unit = "mm"
[spheres]
packing_fraction = 0.1
radius = 1.5
layers = [
  { name = "kernel", material = "UO2", material_density = 10400 },
  { name = "coating", thickness = 0.4, material = "graphite", material_density = 1900 },
]
[[stage]]
do = "insert"
)";

/// Ten pebbles whose fuel is of 2.5 cm, of matrix and particles, in a shell.
std::string pebbles(const std::string& density) {
  return "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\ncount = 10\nradius = "
         "3\n"
         "inside = { scene = \"inner.toml\", templates = 3 }\n"
         "layers = [{ name = \"fuel\", radius = 2.5, material = \"matrix\"" +
         density +
         " }, { name = \"shell\", material = \"graphite\", material_density = 1730 }]\n"
         "[[stage]]\ndo = \"insert\"\n";
}

/// In m³.
struct Volumes {
  double kernels = 0, coatings = 0, matrix = 0, shells = 0;
};
Volumes volumes_of(const Packing& packing) {
  Volumes all;
  const PackingsInside& inside = packing.inside.at(0);
  for (const std::uint32_t t : inside.which) {
    double spheres = 0;
    for (const double r : inside.templates[t]->spheres.r) {
      all.kernels += 1e-9 * ball(r - 0.4);
      all.coatings += 1e-9 * (ball(r) - ball(r - 0.4));
      spheres += 1e-9 * ball(r);
    }
    all.matrix += 1e-6 * ball(2.5) - spheres;
    all.shells += 1e-6 * (ball(3) - ball(2.5));
  }
  return all;
}

TEST(NestAmounts, AFilledLayerWeighsWhatIsInIt) {
  Nested scenes("{ scene = \"inner.toml\" }", particles);
  scenes.folder.write("outer.toml", pebbles(", material_density = 1700"));
  const Plan plan = build(read_scene(scenes.folder / "outer.toml"));
  const Packing packing = run(plan);
  const Volumes volumes = volumes_of(packing);
  const double inner = 10400 * volumes.kernels + 1900 * volumes.coatings;
  const double fuel = 1700 * volumes.matrix + inner, all = fuel + 1730 * volumes.shells;
  const LayerAmounts amounts = layer_amounts(packing);
  ASSERT_EQ(amounts.layers.size(), 2u);
  EXPECT_NEAR(*amounts.layers[0].mass / fuel, 1, 1e-12);
  EXPECT_NEAR(amounts.layers[0].volume, 10 * ball(2.5), 1e-9);  // as large as the layer is
  EXPECT_NEAR(*amounts.layers[1].mass / (1730 * volumes.shells), 1, 1e-12);
  std::map<std::string, MaterialAmount> of;
  for (const MaterialAmount& material : amounts.materials) of[material.name] = material;
  ASSERT_EQ(of.size(), 3u);
  EXPECT_NEAR(1e-6 * of["UO2"].volume / volumes.kernels, 1, 1e-12);
  EXPECT_NEAR(1e-6 * of["matrix"].volume / volumes.matrix, 1, 1e-12);
  EXPECT_NEAR(*of["matrix"].mass / (1700 * volumes.matrix), 1, 1e-12);
  EXPECT_NEAR(1e-6 * of["graphite"].volume / (volumes.coatings + volumes.shells), 1, 1e-12);
  EXPECT_NEAR(*of["graphite"].mass / (1900 * volumes.coatings + 1730 * volumes.shells), 1, 1e-12);
  EXPECT_NEAR(*mass_of(packing, packing.packing_fraction()) / all, 1, 1e-12);
  EXPECT_NEAR(*class_amounts(packing).at(0).mass / all, 1, 1e-12);
  // Before the run, to what a sphere more or less in a ball weighs; explain says it.
  EXPECT_NEAR(*expected_mass(plan) / all, 1, 0.01);
  std::smatch said;
  const std::string words = explain(plan);
  ASSERT_TRUE(std::regex_search(words, said, std::regex("for themselves, and ([0-9.]+) kg")));
  EXPECT_NEAR(std::stod(said[1]) / *expected_mass(plan), 1, 1e-3);
}

TEST(NestAmounts, WhatIsNotKnownIsNotMadeUp) {
  Nested scenes("{ scene = \"inner.toml\" }", particles);
  scenes.folder.write("outer.toml", pebbles(""));
  const Plan plan = build(read_scene(scenes.folder / "outer.toml"));
  const Packing packing = run(plan);
  const LayerAmounts amounts = layer_amounts(packing);
  EXPECT_FALSE(amounts.layers[0].mass);
  EXPECT_TRUE(amounts.layers[1].mass);
  EXPECT_FALSE(mass_of(packing, packing.packing_fraction()));
  EXPECT_FALSE(expected_mass(plan));
  for (const MaterialAmount& of : amounts.materials) EXPECT_EQ(of.mass.has_value(), of.name != "matrix");
}

TEST(NestAmounts, ASphereWithoutLayersIsItsMaterialAroundTheOthers) {
  Nested scenes("{ scene = \"inner.toml\" }", particles);
  const auto outer = [&](const std::string& amount) {
    scenes.folder.write(
        "outer.toml",
        "unit = \"cm\"\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\nradius = 2.5\n" +
            amount +
            "\nmaterial = \"matrix\"\nmaterial_density = 1700\ninside = { scene = \"inner.toml\" }\n"
            "[[stage]]\ndo = \"insert\"\n");
    return build(read_scene(scenes.folder / "outer.toml"));
  };
  const Plan plan = outer("count = 4");
  const Packing packing = run(plan);
  const Volumes volumes = volumes_of(packing);
  const double all = 10400 * volumes.kernels + 1900 * volumes.coatings + 1700 * volumes.matrix;
  EXPECT_NEAR(*mass_of(packing, packing.packing_fraction()) / all, 1, 1e-12);
  EXPECT_NEAR(*class_amounts(packing).at(0).mass / all, 1, 1e-12);
  EXPECT_TRUE(layer_amounts(packing).layers.empty());
  EXPECT_EQ(layer_amounts(packing).materials.size(), 3u);
  EXPECT_NEAR(*expected_mass(plan) / all, 1, 0.01);
  try {
    outer("mass = 0.5");
    ADD_FAILURE() << "spheres were counted as if they were solid";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("\"mass\" is of solid spheres"), std::string::npos)
        << error.what();
  }
}

/// As many spheres with layers as weigh that.
Scene of_mass(const std::string& radius, const std::string& coat_density, const std::string& more = {}) {
  return parse_scene(
      "unit = \"mm\"\nseed = 4\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\nmass = \"5 "
      "g\"\n" +
          more + "radius = " + radius +
          "\nlayers = [{ name = \"core\", material_density = 8000 }, { name = \"coat\", thickness = { "
          "distribution = \"normal\", mean = 0.1, sd = 0.02, max = 0.2 }" +
          coat_density + " }]\n[[stage]]\ndo = \"insert\"\n",
      "mass.toml");
}

// What is counted by its mass weighs that, to half of a sphere, drawn thicknesses and all.
TEST(LayerMass, IsThatOfTheLayers) {
  for (const char* radius :
       {"0.6", "{ distribution = \"lognormal\", median = 0.6, sigma = 0.2, basis = \"number\" }"})
    // What is said of whole spheres says nothing about layers that have densities.
    for (const char* more : {"", "material_density = 2500\n"}) {
      const Packing packing = run(build(of_mass(radius, ", material_density = 1500", more)));
      ASSERT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      const SphereLayers layers = layers_of(packing);
      double sum = 0, heaviest = 0;
      for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
        const double core = ball(layers.of(i)[0]), whole = ball(packing.spheres.r[i]);
        const double mass = 1e-9 * (8000 * core + 1500 * (whole - core));
        sum += mass;
        heaviest = std::max(heaviest, mass);
      }
      EXPECT_GT(packing.spheres.size(), 300u);
      EXPECT_NEAR(sum, 5e-3, 0.5 * heaviest) << radius;
      EXPECT_NEAR(*mass_of(packing, packing.packing_fraction()) / sum, 1, 1e-12);
      EXPECT_NEAR(*class_amounts(packing).at(0).mass / sum, 1, 1e-12);
    }
  EXPECT_NE(describe(build(of_mass("0.6", ", material_density = 1500"))).find("0.005 kg of their layers"),
            std::string::npos);
  try {
    of_mass("0.6", "");
    ADD_FAILURE() << "a coat without a density was weighed";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("needs the \"material_density\" of the spheres, in kg/m3, such as 2500 "
                        "for glass, or of each of their layers"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace nest_amounts_test
}  // namespace bernal

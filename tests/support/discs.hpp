#pragma once
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/polygons.hpp"

// Scenes of discs in containers of two dimensions, and what holds of every packing of them.
namespace bernal::test {

struct Container2 {
  std::string name, toml;
  Domain domain;
};

inline std::string toml_of(const Polygon& polygon) {
  Scene scene;
  scene.container = polygon;
  const std::string toml = scene_as_toml(scene);
  const std::size_t from = toml.find("[container]");
  return toml.substr(from, toml.find("\n[spheres]") - from);
}

inline std::vector<Container2> containers() {
  std::vector<Container2> all = {
      {"Box", "[container]\nkind = \"box\"\nsize = [12, 9]\ncorner = [-3, 5]\n", Box{{-3, 5}, {12, 9}}}};
  for (const auto& [name, polygon] :
       {std::pair("Triangle", triangle()), std::pair("LShape", clockwise(l_shape())),
        std::pair("Hole", with_hole()), std::pair("Needle", needle())})
    all.push_back({name, toml_of(polygon), polygon});
  return all;
}

inline std::string scene_in(const std::string& container, const std::string& spheres) {
  return "unit = \"mm\"\nseed = 5\n" + container + "[spheres]\n" + spheres + "\n";
}
inline const std::string equal = "fill = true\nradius = 0.2";
inline const std::string lognormal =
    "fill = true\ndiameter = { distribution = \"lognormal\", median = 0.3, sigma = 0.3, basis = \"number\" }";

inline Packing packed(const std::string& toml, int threads = 2) {
  RunOptions options;
  options.threads = threads;
  return run(build(parse_scene(toml, "test.toml")), options);
}

/// By plain doubles, every disc against every other one and against the walls.
inline void expect_free_of_overlap(const Packing& packing, const Domain& domain) {
  const Spheres<2> discs = packing.spheres.in<2>();
  for (std::size_t i = 0; i < discs.size(); ++i) {
    EXPECT_GE(static_cast<double>(precise_clearance_flat(domain, discs.center(i))), discs.r[i]) << i;
    for (std::size_t j = 0; j < i; ++j)
      ASSERT_GE((discs.center(i) - discs.center(j)).norm(), discs.r[i] + discs.r[j]) << i << " " << j;
  }
}

}  // namespace bernal::test

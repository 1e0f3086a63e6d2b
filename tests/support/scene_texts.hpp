#pragma once
#include <gtest/gtest.h>

#include <string>

#include "bernal/scene/read_scene.hpp"

// What the tests of reading and writing scenes share.
namespace bernal::testing {

/// A whole scene around the part that a test is about; that part stands from line 2 on.
inline std::string with_container(const std::string& body) {
  return "unit = \"mm\"\n[container]\n" + body + "\n[spheres]\nradius = 1\n";
}
inline std::string with_spheres(const std::string& body) {
  return "container = { kind = \"sphere\", radius = 9 }\n[spheres]\n" + body + "\n";
}
inline std::string with_stage(const std::string& body) {
  return with_spheres("radius = 1") + "[[stage]]\n" + body + "\n";
}

/// They hold the same values; where they stand does not count.
inline void expect_equal(const Spec& a, const Spec& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.parameters.size(), b.parameters.size());
  for (const auto& [key, parameter] : a.parameters) {
    ASSERT_TRUE(b.has(key)) << key;
    // A double that is whole is written as 1 and read back as 1.0.
    EXPECT_EQ(parameter.value, b.parameters.find(key)->second.value) << a.name << " " << key;
  }
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) expect_equal(a.parts[i], b.parts[i]);
}

inline void expect_equal(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.seed, b.seed);
  expect_equal(a.container, b.container);
  expect_equal(a.sizes, b.sizes);
  EXPECT_EQ(a.sizes_are_diameters, b.sizes_are_diameters);
  EXPECT_EQ(a.draw, b.draw);
  EXPECT_EQ(a.target.count, b.target.count);
  EXPECT_EQ(a.target.packing_fraction, b.target.packing_fraction);
  EXPECT_EQ(a.target.predicted, b.target.predicted);
  EXPECT_EQ(a.target.fill, b.target.fill);
  EXPECT_EQ(a.walls, b.walls);
  EXPECT_EQ(a.overlap, b.overlap);
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (std::size_t i = 0; i < a.stages.size(); ++i) expect_equal(a.stages[i], b.stages[i]);
}

}  // namespace bernal::testing

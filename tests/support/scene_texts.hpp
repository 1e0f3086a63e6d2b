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
inline void expect_equal(const Scene& a, const Scene& b) { EXPECT_EQ(scene_as_toml(a), scene_as_toml(b)); }

}  // namespace bernal::testing

#pragma once
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"

namespace bernal::testing {

inline constexpr const char* particles =
    "unit = \"mm\"\n[spheres]\npacking_fraction = 0.1\nradius = 1.5\n[[stage]]\ndo = \"insert\"\n";

/// Ten pebbles of 6 cm in a box, with what lies inside.
inline std::string pebbles(const std::string& inside) {
  return fmt::format(
      "unit = \"cm\"\nseed = 7\n[container]\nkind = \"box\"\nsize = [30, 30, 30]\n[spheres]\ncount = 10\n{}"
      "diameter = {{ distribution = \"classes\", values = [6.0], shares = [1], names = [\"pebble\"], layers "
      "= "
      "[[{{ name = \"fuel\", radius = 2.5 }}, {{ name = \"shell\" }}]] }}\n[[stage]]\ndo = \"insert\"\n",
      inside.empty() ? "" : "inside = " + inside + "\n");
}

/// A folder with both scenes.
struct Nested {
  explicit Nested(const std::string& inside =
                      "{ scene = \"inner.toml\", class = \"pebble\", layer = \"fuel\", "
                      "templates = 3 }",
                  const std::string& inner = particles) {
    folder.write("inner.toml", inner);
    folder.write("outer.toml", pebbles(inside));
  }
  Packing packed(int threads = 1) const {
    return run(build(read_scene(folder / "outer.toml")), {.threads = threads});
  }
  /// The line with which it is refused.
  std::string refusal() const {
    try {
      build(read_scene(folder / "outer.toml"));
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }
  Folder folder;
};

inline void expect_same(const Packing& a, const Packing& b) {
  EXPECT_EQ(a.spheres.x, b.spheres.x);
  EXPECT_EQ(a.spheres.r, b.spheres.r);
  ASSERT_EQ(a.inside.size(), b.inside.size());
  for (std::size_t k = 0; k < a.inside.size(); ++k) {
    EXPECT_EQ(a.inside[k].of_class, b.inside[k].of_class);
    EXPECT_EQ(a.inside[k].spheres, b.inside[k].spheres);
    EXPECT_EQ(a.inside[k].which, b.inside[k].which);
    EXPECT_EQ(a.inside[k].rotations, b.inside[k].rotations);
    ASSERT_EQ(a.inside[k].templates.size(), b.inside[k].templates.size());
    for (std::size_t t = 0; t < a.inside[k].templates.size(); ++t)
      expect_same(*a.inside[k].templates[t], *b.inside[k].templates[t]);
  }
}

}  // namespace bernal::testing

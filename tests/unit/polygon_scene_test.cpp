#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/folder.hpp"

// Polygons as scenes name them, in the text and in files beside it.
namespace bernal {
namespace polygon_scene_test {

using testing::Folder;

const std::string square = "vertices = [[0, 0], [10, 0], [10, 10], [0, 10]]\n";

std::string scene_with(const std::string& lines) {
  return "unit = \"mm\"\n[container]\nkind = \"polygon\"\n" + lines +
         "[spheres]\nfill = true\ndiameter = 1\n[[stage]]\ndo = \"insert\"\n";
}

Polygon polygon_of(const std::string& lines, const Folder& folder = {}) {
  return std::get<Polygon>(read_scene(folder.write("scene.toml", scene_with(lines))).container);
}

struct Refusal {
  std::string what;
  int line = 0;
};
Refusal refusal_of(const std::string& lines, const Folder& folder = {}) {
  try {
    polygon_of(lines, folder);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    return {error.what(), error.location().line};
  }
  return {};
}

TEST(PolygonScene, ErrorsPointToTheLinesThatAreMeant) {
  const auto expect = [](const std::string& lines, int line, const std::string& words) {
    const Refusal refusal = refusal_of(lines);
    EXPECT_EQ(refusal.line, line) << refusal.what;
    EXPECT_NE(refusal.what.find(words), std::string::npos) << refusal.what;
  };
  expect("vertices = [[0, 0], [4, 4], [4, 0], [0, 4]]\nholes = []\n", 4, "meet at about (2, 2)");
  expect(square + "holes = [[[1, 1], [2, 2], [2, 2]]]\n", 5, "hole 1 has 2 different corners");
  expect(square + "holes = [[[1, 1], [2, 2], [3, 3]]]\n", 5, "runs back along");
  expect(square + "holes = [[[5, 5], [12, 5.5], [5, 6]]]\n", 5, "meet at about");
  expect(square + "holes = [[[15, 5], [16, 5], [15, 6]]]\n", 5, "must lie inside the outline, but hole 1");
  expect(square + "holes = [[[-5, -5], [25, -5], [5, 55]]]\n", 5, "must lie inside the outline, but hole 1");
  expect(square + "holes = [[]]\n", 5, "not an array of 1 value");
  expect("vertices = [[0, 0], [nan, 0], [10, 10]]\n", 4, "whose coordinates are finite");
  expect(square + "holes = [[[1, 1], [2, 1], [inf, 2]]]\n", 5, "whose coordinates are finite");
}

TEST(PolygonScene, NoHolesAreNone) { EXPECT_EQ(polygon_of(square + "holes = []\n").loops.size(), 1u); }

/// However small: its area is far below the rounding of the outline's.
TEST(PolygonScene, AHoleIsInsideOrNotExactly) {
  const double last = std::nextafter(10.0, 0.0);
  const auto hole_at = [&](double x, double width) {
    return refusal_of(square +
                      fmt::format("holes = [[[{0}, 5], [{1}, 5], [{0}, {2}]]]\n", x, x + width, 5 + width))
        .what;
  };
  for (const double width : {1e-10, 1e-6, 1.0}) {
    EXPECT_NE(hole_at(15, width).find("must lie inside"), std::string::npos) << width;
    EXPECT_NE(hole_at(std::nextafter(10.0, 11.0), width).find("must lie inside"), std::string::npos) << width;
    EXPECT_EQ(hole_at(5, width), "") << width;
    EXPECT_EQ(hole_at(last - width, width), "") << width;
  }
}

TEST(PolygonScene, AFileSaysItsUnitAndTheOrderOfItsColumns) {
  const Folder folder;
  for (const char* text :
       {"0,0\n4,0\n4,2\n", "# unit: mm\nx,y\n0 0\n4 0\n4 2\n", "y,x\n0,0\n0,4\n2,4\n",
        "\xEF\xBB\xBF# Unit: cm\n0;0\n0.4;0\n0.4;0.2\n", "#unit : m\n0,0\n0.004,0\n0.004,0.002\n",
        "Y [cm], X [cm]\n0,0\n0,.4\n.2,.4\n", "x (cm) y (cm)\n0 0\n.4 0\n.4 .2\n"}) {
    folder.write("p.csv", text);
    const auto corners = polygon_of("file = \"p.csv\"\n", folder).loops.at(0);
    ASSERT_EQ(corners.size(), 3u) << text;
    EXPECT_NEAR((corners[1] - Vector<2>(4, 0)).norm(), 0, 1e-15) << text;
    EXPECT_NEAR((corners[2] - Vector<2>(4, 2)).norm(), 0, 1e-15) << text;
  }
  const auto expect = [&](const std::string& text, int line, const std::string& words) {
    folder.write("p.csv", text);
    const Refusal refusal = refusal_of("file = \"p.csv\"\n", folder);
    EXPECT_EQ(refusal.line, line) << refusal.what;
    EXPECT_NE(refusal.what.find(words), std::string::npos) << refusal.what;
  };
  expect("# unit: parsec\n0,0\n4,0\n4,2\n", 1, "unknown unit \"parsec\"; use one of");
  expect("x [px],y [px]\n0,0\n4,0\n4,2\n", 1, "unknown unit \"px\"");
  expect("# unit: m\nx [mm],y [mm]\n0,0\n4,0\n4,2\n", 2, "the unit is mm, and one before it says m");
  expect("x [m],y [mm]\n0,0\n4,0\n4,2\n", 1, "the unit is mm, and one before it says m");
  expect("0,0\n# unit: m\n4,0\n4,2\n", 2, "too late");
}

TEST(PolygonScene, AFileMayHaveManyCornersAndItsResultIsReadAgain) {
  const Folder folder;
  const auto circle = [&](int n) {
    std::string text;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * 3.141592653589793 * k / n;
      text += fmt::format("{},{}\n", 10 * std::cos(angle), 10 * std::sin(angle));
    }
    folder.write("p.csv", text);
  };
  circle(20'000);
  const Scene scene = read_scene(folder.write("scene.toml", scene_with("file = \"p.csv\"\n")));
  EXPECT_EQ(std::get<Polygon>(scene.container).loops.at(0).size(), 20'000u);
  const Scene again = read_scene(folder.write("again.toml", scene_as_toml(scene)));
  EXPECT_EQ(std::get<Polygon>(again.container).loops, std::get<Polygon>(scene.container).loops);
  circle(20'001);
  const Refusal refusal = refusal_of("file = \"p.csv\"\n", folder);
  EXPECT_EQ(refusal.line, 20'001);
  EXPECT_NE(refusal.what.find("more than 20000 points; leave out corners"), std::string::npos)
      << refusal.what;
}

}  // namespace polygon_scene_test
}  // namespace bernal

#include "domain/volume_below.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bernal/core/random.hpp"
#include "support/meshes.hpp"

// Volumes below a level in closed form, and by points.
namespace bernal {
namespace volume_below_test {

using std::numbers::pi;
const Vector<3> down(0, 0, -1);

TEST(VolumeBelow, OfUprightShapesIsExact) {
  const VolumeBelow box(Box{{1, 2, 3}, {2, 3, 4}}, down);
  EXPECT_EQ(box.lowest(), 3);
  EXPECT_EQ(box.highest(), 7);
  EXPECT_NEAR(box(4.5), 9, 1e-12);
  EXPECT_EQ(box(2), 0);
  EXPECT_NEAR(box(100), 24, 1e-12);
  const VolumeBelow cylinder(Cylinder{.base = {5, 5, 1}, .axis = {0, 0, 2}, .radius = 3, .height = 10}, down);
  EXPECT_NEAR(cylinder(3), 18 * pi, 1e-12);
  const VolumeBelow ball(Sphere{{0, 0, 2}, 2}, down);
  EXPECT_NEAR(ball(1), pi / 3 * (3 * 2 - 1), 1e-12);
  EXPECT_NEAR(ball(2), 16 * pi / 3, 1e-12);
  EXPECT_EQ(ball.highest(), 4);
}

TEST(VolumeBelow, OfLeaningShapesIsThatOfTheirCuts) {
  // Along the diagonal of a cube, the corner below is a pyramid; the middle holds a half.
  const Vector<3> diagonal = -Vector<3>::Ones().normalized();
  const VolumeBelow cube(Box{{0, 0, 0}, {1, 1, 1}}, diagonal);
  EXPECT_NEAR(cube(0.3 / std::sqrt(3.0)), 0.3 * 0.3 * 0.3 / 6, 1e-14);
  EXPECT_NEAR(cube(0.5 * std::sqrt(3.0)), 0.5, 1e-14);
  // A cylinder that lies on its side, to the accuracy of its prism.
  const VolumeBelow lying(Cylinder{.base = {0, 0, 0}, .axis = {1, 0, 0}, .radius = 2, .height = 5}, down);
  EXPECT_NEAR(lying(0), 10 * pi, 1e-9);
  const double segment = 4 * std::acos(0.5) - std::sqrt(3.0);
  EXPECT_NEAR(lying(-1), 5 * segment, 1e-4 * 5 * segment);
  EXPECT_NEAR(lying.lowest(), -2, 1e-4);
}

TEST(VolumeBelow, OfMeshesIsThatOfWhatTheyEnclose) {
  const Mesh box = test::box_mesh({1, 2, 3}, {2, 3, 4});
  const Vector<3> leaning = Vector<3>(0.3, -0.2, -1).normalized();
  const VolumeBelow mesh(box, leaning), exact(Box{{1, 2, 3}, {2, 3, 4}}, leaning);
  for (const double share : {0.0, 0.1, 0.35, 0.5, 0.8, 1.0}) {
    const double level = exact.lowest() + share * (exact.highest() - exact.lowest());
    EXPECT_NEAR(mesh(level), exact(level), 1e-12) << share;
  }
}

TEST(VolumeBelow, OfPolygonsIsAnAreaWithoutHoles) {
  // Lines that run either way: a square of edge 4, with a hole of edge 2 in it, and an island in that.
  const auto square = [](double from, double to) {
    return std::vector<Vector<2>>{{from, from}, {to, from}, {to, to}, {from, to}};
  };
  auto hole = square(1, 3), island = square(1.5, 2.5);
  const Vector<3> against_y(0, -1, 0);
  for (const bool turned : {false, true}) {
    if (turned) std::ranges::reverse(hole);
    const VolumeBelow area(Polygon{.loops = {square(0, 4), hole, island}}, against_y);
    EXPECT_NEAR(area(0.5), 2, 1e-13);
    EXPECT_NEAR(area(2), 8 - 2 + 0.5, 1e-13);
    EXPECT_NEAR(area(4), 16 - 4 + 1, 1e-13);
  }
  const VolumeBelow box(Box{{0, 0}, {3, 2}}, against_y);
  EXPECT_NEAR(box(0.5), 1.5, 1e-14);
  EXPECT_NEAR(box.highest(), 2, 1e-14);
}

}  // namespace volume_below_test
}  // namespace bernal

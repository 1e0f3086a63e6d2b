// Containers whose chambers are easily counted wrong: exact fits, thin walls, thin and curved parts.
#include "bernal/measure/chambers.hpp"

#include <gtest/gtest.h>

#include "support/measured.hpp"
#include "support/meshes.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace chambers_test {

using namespace test;

std::size_t count(const Domain& shape, double r, int cells = 128) {
  return chambers_for(shape, r, {.cells = cells, .points = 1000}).chambers.size();
}

TEST(HardChambers, BaffleWithAGap) {
  for (const double r : {0.05, 0.2, 0.4}) {
    EXPECT_EQ(count(baffle_mesh(2.04 * r, 2), r), 1u) << r;
    EXPECT_EQ(count(baffle_mesh(1.9 * r, 2), r), 2u) << r;
  }
}

TEST(HardChambers, SharpHoleInAThinWall) {
  // A wall 0.001 thick: the places on its two sides come nearest in the hole.
  for (const double r : {0.05, 0.2}) {
    const auto with_hole = [](double half) {
      return square_tube_mesh({{0, 1}, {2, 1}, {2, half}, {2.001, half}, {2.001, 1}, {4, 1}});
    };
    EXPECT_EQ(count(with_hole(1.02 * r), r), 1u) << r;
    EXPECT_EQ(count(with_hole(0.95 * r), r), 2u) << r;
  }
}

TEST(HardChambers, SmoothNeckOfAnHourglass) {
  const auto hourglass = [](double half) { return square_tube_mesh({{0, 1}, {2, half}, {4, 1}}); };
  for (const double r : {0.05, 0.2}) {
    EXPECT_EQ(count(hourglass(1.1 * r), r), 1u) << r;
    EXPECT_EQ(count(hourglass(0.9 * r), r), 2u) << r;
  }
}

TEST(HardChambers, BoxesThatShareNothing) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  for (const double x : {1.001, 2.002}) mesh = joined(mesh, box_mesh({x, 0, 0}, {1, 1, 1}));
  for (const double r : {0.02, 0.1, 0.49}) EXPECT_EQ(count(mesh, r), 3u) << r;
}

TEST(HardChambers, ObstacleThatIsPassedOrNot) {
  // A cube of edge 1 in the middle of a tube of edge 2: half a unit is left on all sides.
  const Mesh mesh = joined(box_mesh({0, 0, 0}, {5, 2, 2}), inverted(box_mesh({2, 0.5, 0.5}, {1, 1, 1})));
  EXPECT_EQ(count(mesh, 0.24), 1u);
  EXPECT_EQ(count(mesh, 0.26), 1u);  // along the edges of the tube there is more room
  EXPECT_EQ(count(mesh, 0.33), 2u);
  EXPECT_EQ(count(mesh, 0.99), 2u);  // a sphere at either end
  EXPECT_EQ(count(mesh, 1.01), 0u);
}

TEST(HardChambers, ShellBetweenTwoSpheres) {
  // Places that are a thin curved sheet: between 1.3 and 1.3 + 0.7 cos(10 degrees).
  const Mesh mesh = joined(icosphere_mesh(2, 3), inverted(icosphere_mesh(1.3, 3)));
  EXPECT_EQ(count(mesh, 0.33), 1u);
  EXPECT_EQ(count(mesh, 0.36), 0u);
}

TEST(HardChambers, TubesHardlyWiderThanASphere) {
  // The clearance on the axis of the helix is 0.35 cos(18 degrees) less what its straight pieces cut off.
  EXPECT_EQ(count(helix_mesh(400), 0.33), 1u);
  EXPECT_EQ(count(helix_mesh(400), 0.25), 1u);
  EXPECT_EQ(count(helix_mesh(400), 0.34), 0u);
  // A sphere of the width of the tube: places on a line, or on a sheet.
  EXPECT_EQ(count(box_mesh({0, 0, 0}, {10, 1, 1}), 0.5), 1u);
  EXPECT_EQ(count(box_mesh({0, 0, 0}, {7, 9, 1}), 0.5), 1u);
  EXPECT_EQ(count(box_mesh({0, 0, 0}, {1, 1, 1}), 0.5), 1u);
}

TEST(HardChambers, SpheresFindTheWayThatTheCellsMiss) {
  // A plate askew, a cell a hundred times as thick as what is between its walls and a sphere.
  const double r = 0.5;
  const Vector<3> turned = Vector<3>(1, 2, 2) / 3, across = Vector<3>(2, 1, -2) / 3,
                  up = turned.cross(across);
  Mesh mesh = box_mesh({0, 0, 0}, {60, 60, 1.01});
  for (Vector<3>& v : mesh.vertices) v = v[0] * turned + v[1] * across + v[2] * up;
  Spheres<3> spheres;
  for (int i = 0; i < 54; ++i)
    for (int j = 0; j < 54; ++j)
      spheres.push_back((1 + 1.05 * i) * turned + (1 + 1.05 * j) * across + 0.505 * up, r);
  Packing packing = testing::packing_of(spheres, Box{});
  packing.domain = mesh;
  packing.volume = volume_of(packing.domain);
  const Chambers found = chambers(packing, {.cells = 12, .points = 1000}).value();
  EXPECT_EQ(found.misplaced, 0u);
  ASSERT_EQ(found.chambers.size(), 1u);
  EXPECT_EQ(found.chambers[0].spheres, spheres.size());
  EXPECT_GT(found.chambers[0].share, 0.95);
  EXPECT_EQ(count(mesh, r, 12), 0u);
}

TEST(HardChambers, FarAwayAndInAnyUnit) {
  const Vector<3> away(3e6, -2e6, 1e6);
  for (const double unit : {1e-9, 1.0, 1e9}) {
    const Mesh wide = scaled(translated(two_cubes_mesh(0.22), away), unit);
    const Mesh narrow = scaled(translated(two_cubes_mesh(0.18), away), unit);
    EXPECT_EQ(count(wide, 0.2 * unit), 1u) << unit;
    EXPECT_EQ(count(narrow, 0.2 * unit), 2u) << unit;
  }
}

TEST(HardChambers, DoNotDependOnTheCells) {
  for (const int cells : {16, 40, 90, 128}) {
    EXPECT_EQ(count(two_cubes_mesh(0.33), 0.3, cells), 1u) << cells;
    EXPECT_EQ(count(two_cubes_mesh(0.27), 0.3, cells), 2u) << cells;
    EXPECT_EQ(count(torus_mesh(1, 0.4, 48, 24), 0.35, cells), 1u) << cells;
  }
}

}  // namespace chambers_test
}  // namespace bernal

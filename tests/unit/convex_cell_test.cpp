#include "measure/convex_cell.hpp"

#include <gtest/gtest.h>

#include "bernal/core/random.hpp"

namespace bernal {
namespace convex_cell_test {

constexpr std::array<ConvexCell::Label, 6> walls = {-1, -1, -1, -1, -1, -1};

ConvexCell unit_cube() {
  ConvexCell cell;
  cell.reset(Vector<3>::Constant(-0.5), Vector<3>::Constant(0.5), walls);
  return cell;
}

Vector<3> area_of(const ConvexCell& cell) {
  Vector<3> sum = Vector<3>::Zero();
  cell.for_each_loop([&](std::span<const std::uint32_t> loop) {
    for (std::size_t k = 0; k < loop.size(); ++k)
      sum += cell.corners()[loop[k]].cross(cell.corners()[loop[(k + 1) % loop.size()]]);
  });
  return sum;
}

TEST(ConvexCell, OfACubeIsACube) {
  const ConvexCell cell = unit_cube();
  EXPECT_EQ(cell.volume(), 1);
  EXPECT_EQ(cell.squared_reach(), 0.75);
  int loops = 0;
  cell.for_each_loop([&](std::span<const std::uint32_t> loop) {
    EXPECT_EQ(loop.size(), 4u);
    ++loops;
  });
  EXPECT_EQ(loops, 6);
  std::vector<ConvexCell::Plane> planes = cell.planes();
  ASSERT_EQ(planes.size(), 6u);
  for (const ConvexCell::Plane& plane : planes) EXPECT_EQ(plane.offset, 0.5);
}

TEST(ConvexCell, OfACubeWithoutItsCornersHasTheirFaces) {
  ConvexCell cell = unit_cube();
  ConvexCell::Label label = 0;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1}) EXPECT_TRUE(cell.cut({x, y, z}, 1.25, label++));
  EXPECT_EQ(cell.corners().size(), 24u);
  EXPECT_EQ(cell.faces(1e-6), 8u);
  EXPECT_NEAR(cell.volume(), 1 - 8 * 0.25 * 0.25 * 0.25 / 6, 1e-15);
  EXPECT_FALSE(cell.cut({1, 1, 1}, 1.25, label, 1e-12));
  EXPECT_TRUE(cell.cut({1, 0, 0}, -0.5, label));
  EXPECT_EQ(cell.volume(), 0);
  EXPECT_TRUE(cell.cut({1, 0, 0}, -0.6, label));
  EXPECT_TRUE(cell.empty());
  EXPECT_FALSE(cell.cut({1, 0, 0}, -0.7, label));
}

/// Planes through corners leave these to one side or the other as rounding has it, and corners that coincide
/// to both.
TEST(ConvexCell, HalvesFillItWhereverThePlaneGoes) {
  Random random(7, stream(Stream::test));
  const auto corner_of = [&](const ConvexCell& cell) {
    return cell
        .corners()[static_cast<std::size_t>(random.uniform() * static_cast<double>(cell.corners().size()))];
  };
  for (int trial = 0; trial < 400; ++trial) {
    ConvexCell cell = unit_cube();
    for (int cuts = 0; cuts < 25 && !cell.empty(); ++cuts) {
      const Vector<3> a = corner_of(cell), b = corner_of(cell), c = corner_of(cell);
      Vector<3> normal = cuts % 3 == 0 ? uniform_direction<3>(random) : Vector<3>((b - a).cross(c - a));
      if (normal.norm() < 1e-9) normal = Vector<3>::Unit(cuts % 3);
      const double offset = cuts % 3 == 1 ? 0.25 * normal.dot(a + b + c + a) : normal.dot(a);
      ConvexCell low = cell, high = cell;
      low.cut(normal, offset, cuts);
      high.cut(-normal, -offset, cuts);
      EXPECT_NEAR(low.volume() + high.volume(), cell.volume(), 1e-14) << trial << ' ' << cuts;
      EXPECT_LT(area_of(low).norm(), 1e-14);
      cell = low.volume() > high.volume() ? low : high;
    }
  }
}

}  // namespace convex_cell_test
}  // namespace bernal

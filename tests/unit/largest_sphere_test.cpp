#include "hard/convex_walls.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <numbers>
#include <vector>

#include "bernal/core/random.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace largest_sphere_test {

LargestSphere largest_in(const Domain& shape) {
  return largest_sphere_between(convex_walls(shape, 1e-9), bounds_of(shape));
}

/// The best of all spheres that touch four planes and cross none.
double largest_by_brute_force(const std::vector<Wall<3>>& planes) {
  double largest = -1e300;
  const std::size_t n = planes.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (std::size_t c = 0; c < b; ++c)
        for (std::size_t d = 0; d < c; ++d) {
          Eigen::Matrix4d rows;
          Vector<4> offsets;
          int row = 0;
          for (const std::size_t k : {a, b, c, d}) {
            rows.row(row) << planes[k].along.transpose(), 1;
            offsets[row++] = planes[k].extent;
          }
          const Eigen::FullPivLU<Eigen::Matrix4d> lu(rows);
          if (!lu.isInvertible()) continue;
          const Vector<4> x = lu.solve(offsets);
          double room = x[3];
          for (const Wall<3>& plane : planes) room = std::min(room, plane.clearance(x.head<3>()));
          if (room > x[3] - 1e-9) largest = std::max(largest, x[3]);
        }
  return largest;
}

TEST(LargestSphere, IsTheInscribedOne) {
  EXPECT_NEAR(largest_in(test::box_mesh({1, 2, 3}, {1, 2, 3})).radius, 0.5, 1e-12);
  // A triangle of edge √3 has an inscribed circle of radius 1/2.
  EXPECT_NEAR(largest_in(test::prism_mesh(3, 1, 2)).radius, 0.5, 1e-12);
  EXPECT_NEAR(largest_in(test::prism_mesh(3, 1, 0.4)).radius, 0.2, 1e-12);
  EXPECT_NEAR(largest_in(test::prism_mesh(2000, 1, 3)).radius, std::cos(std::numbers::pi / 2000), 1e-9);
  const LargestSphere far = largest_in(test::translated(test::icosphere_mesh(1, 2), {40, -50, 60}));
  EXPECT_LT((far.center - Vector<3>(40, -50, 60)).norm(), 0.02);
  EXPECT_GT(far.radius, 0.97);
  EXPECT_LT(far.radius, 1);
}

TEST(LargestSphere, IsAsLargeAsAnyThatTouchesFourPlanes) {
  Random random(3, stream(Stream::test));
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Wall<3>> planes = convex_walls(Box{{-1, -1, -1}, {2, 2, 2}}, 0);
    const Vector<3> about = 0.3 * uniform_direction<3>(random);
    for (int k = 0; k < 14; ++k) {
      const Vector<3> normal = uniform_direction<3>(random);
      // Every third trial some planes leave nothing between them.
      planes.push_back(
          {.along = normal, .extent = normal.dot(about) + random.uniform(trial % 3 ? 0.1 : -0.4, 0.6)});
    }
    const LargestSphere largest =
        largest_sphere_between(planes, {Vector<3>::Constant(-1), Vector<3>::Constant(1)});
    EXPECT_NEAR(largest.radius, largest_by_brute_force(planes), 1e-11) << trial;
    for (const Wall<3>& plane : planes) EXPECT_GE(plane.clearance(largest.center), largest.radius);
  }
}

/// Planes that come many times, or nearly so, as rounded facets do.
TEST(LargestSphere, DoesNotMindPlanesThatHardlyDiffer) {
  Random random(4, stream(Stream::test));
  std::vector<Wall<3>> planes;
  for (const Wall<3>& side : convex_walls(Box{{0, 0, 0}, {1, 1.5, 2}}, 0))
    for (int k = 0; k < 200; ++k) {
      const Vector<3> normal = (side.along + 1e-10 * uniform_direction<3>(random)).normalized();
      planes.push_back({.along = normal, .extent = side.extent + random.uniform(0, 1e-10)});
    }
  EXPECT_NEAR(largest_sphere_between(planes, {{0, 0, 0}, {1, 1.5, 2}}).radius, 0.5, 1e-9);
}

}  // namespace largest_sphere_test
}  // namespace bernal

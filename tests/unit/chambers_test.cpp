#include "bernal/measure/chambers.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "geometry/topology.hpp"
#include "support/measured.hpp"
#include "support/meshes.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace chambers_test {

using std::numbers::pi;
using testing::packing_of;

Packing packing_in(Spheres<3> spheres, const Domain& shape) {
  Packing packing = packing_of(std::move(spheres), Box{});
  packing.domain = shape;
  packing.volume = volume_of(packing.domain);
  return packing;
}

/// A convex body with all that is at most r from it (Steiner): volume V, area S, M the integral of its mean
/// curvature.
double grown(double V, double S, double M, double r) {
  return V + S * r + M * r * r + 4 * pi / 3 * r * r * r;
}

/// What spheres cover of a box.
double covered(const Vector<3>& size, double r) {
  const Vector<3> in = size - Vector<3>::Constant(2 * r);
  return grown(in.prod(), 2 * (in[0] * in[1] + in[1] * in[2] + in[2] * in[0]), pi * in.sum(), r);
}

/// Standard errors that a share may be off; and a slope of its own, for a place may lack a thousandth of r.
void expect_share(double share, double error, double expected) {
  EXPECT_NEAR(share, expected, 4 * error + 2e-3);
}

TEST(IsConvex, ForPrismsAndNotForWhatHasAnInnerEdgeOrTwoPieces) {
  EXPECT_TRUE(is_convex(test::prism_mesh(64, 1, 2)));
  EXPECT_TRUE(is_convex(test::two_cubes_mesh(1)));  // a neck as wide as the cubes: one bar
  EXPECT_FALSE(is_convex(test::two_cubes_mesh(0.5)));
  EXPECT_FALSE(is_convex(test::l_shape_mesh()));
  Mesh two = test::prism_mesh(5, 1, 2);
  const Mesh other = test::translated(test::prism_mesh(5, 1, 2), {3, 0, 0});
  const auto first = static_cast<std::uint32_t>(two.vertices.size());
  two.vertices.insert(two.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& [a, b, c] : other.triangles) two.triangles.push_back({first + a, first + b, first + c});
  EXPECT_FALSE(is_convex(two));
}

TEST(Chambers, OfABoxAreOneThatLacksItsEdges) {
  const Vector<3> size(3, 4, 5);
  for (const Domain& shape : {Domain(Box{{1, 2, 3}, size}), Domain(test::box_mesh({1, 2, 3}, size))}) {
    for (const double r : {0.2, 0.7, 1.4}) {
      const Chambers found = chambers_for(shape, r);
      ASSERT_EQ(found.chambers.size(), 1u) << r;
      const double expected = covered(size, r) / size.prod();
      expect_share(found.chambers[0].share, found.chambers[0].share_error, expected);
      expect_share(found.by_smallest.share, found.by_smallest.error, 1 - expected);
      EXPECT_NEAR(found.chambers[0].share + found.by_smallest.share, 1, 1e-12);
      EXPECT_LE(found.by_smallest.error, std::sqrt(0.25 / 7999));
    }
  }
}

TEST(Chambers, OfACylinderAndASphereAgreeWithSteiner) {
  // What spheres cover of a cylinder is a smaller cylinder and all that is at most r from it.
  const double R = 2, h = 3, r = 0.6, in = R - r, l = h - 2 * r;
  const Chambers cylinder = chambers_for(Cylinder{{1, 1, 1}, {1, 2, 3}, R, h}, r);
  ASSERT_EQ(cylinder.chambers.size(), 1u);
  const double volume = grown(pi * in * in * l, 2 * pi * in * in + 2 * pi * in * l, pi * l + pi * pi * in, r);
  expect_share(cylinder.chambers[0].share, cylinder.chambers[0].share_error, volume / (pi * R * R * h));

  const Chambers sphere = chambers_for(Sphere{{1, 2, 3}, 2}, 1.9);
  ASSERT_EQ(sphere.chambers.size(), 1u);
  EXPECT_EQ(sphere.chambers[0].share, 1);
  EXPECT_EQ(sphere.chambers[0].position, Vector<3>(1, 2, 3));
  EXPECT_NEAR(sphere.chambers[0].clearance, 2, 1e-12);
}

TEST(Chambers, OfAWedgeLackItsTip) {
  // A prism over the triangle (0, 0), (6, 0), (0, 1.5), the sharpest corner 14 degrees. What spheres cover is
  // a similar triangle, by whose height the prism is lower, and all that is at most r from it.
  const double a = 6, b = 1.5, c = std::hypot(a, b), height = 3, r = 0.3;
  const double area = a * b / 2, perimeter = a + b + c, inradius = 2 * area / perimeter;
  const double s = (inradius - r) / inradius, h = height - 2 * r;
  const double volume =
      grown(s * s * area * h, 2 * s * s * area + s * perimeter * h, pi * h + pi / 2 * s * perimeter, r);
  const Chambers found = chambers_for(test::extrude({{0, 0}, {a, 0}, {0, b}}, height, {{0, 1, 2}}), r);
  ASSERT_EQ(found.chambers.size(), 1u);
  expect_share(found.by_smallest.share, found.by_smallest.error, 1 - volume / (area * height));
}

TEST(Chambers, AreNoneWhereNothingFits) {
  const Vector<3> size(2, 2, 2);
  for (const Domain& shape : {Domain(Box{{0, 0, 0}, size}), Domain(test::box_mesh({0, 0, 0}, size))}) {
    EXPECT_EQ(chambers_for(shape, 0.999).chambers.size(), 1u);
    for (const double r : {1.01, 1.7, 100.0}) {
      const Chambers found = chambers_for(shape, r);
      EXPECT_TRUE(found.chambers.empty()) << r;
      EXPECT_EQ(found.by_smallest.share, 1) << r;
    }
  }
}

TEST(Chambers, AreTwoWhereTheNeckIsNarrowerThanASphere) {
  for (const double r : {0.1, 0.2, 0.5}) {
    EXPECT_EQ(chambers_for(test::two_cubes_mesh(1.001 * r), r).chambers.size(), 1u) << r;
    const Chambers two = chambers_for(test::two_cubes_mesh(0.999 * r), r);
    ASSERT_EQ(two.chambers.size(), 2u) << r;
    const double volume = 16 + std::pow(1.998 * r, 2);
    for (const Chambers::Chamber& chamber : two.chambers) {
      // A cube, and what a sphere that looks into the neck covers of it: less than a ball's half.
      EXPECT_GT(chamber.share, covered({2, 2, 2}, r) / volume - 4 * chamber.share_error - 2e-3);
      EXPECT_LT(chamber.share,
                (covered({2, 2, 2}, r) + 2 * pi / 3 * r * r * r) / volume + 4 * chamber.share_error);
      EXPECT_GE(chamber.clearance, r);
    }
    EXPECT_NE(two.chambers[0].position[0] < 2.5, two.chambers[1].position[0] < 2.5);
  }
}

TEST(Chambers, HaveTheirSpheresAndPackingFractions) {
  const double half = 0.3, large = 0.6, small = 0.4;
  Spheres<3> spheres;
  spheres.push_back({1, 0, 0}, large);
  spheres.push_back({4.6, 0.6, 0.6}, small);
  spheres.push_back({4.6, -0.6, -0.6}, small);
  spheres.push_back({2.5, 0, 0}, small);  // sticks out of the neck
  const Packing packing = packing_in(spheres, test::two_cubes_mesh(half));
  const Chambers found = chambers(packing).value();
  EXPECT_EQ(found.radius, small);
  ASSERT_EQ(found.chambers.size(), 2u);
  EXPECT_EQ(found.misplaced, 1u);
  ASSERT_EQ(found.of_sphere.size(), 4u);
  const std::uint32_t left = found.of_sphere[0], right = found.of_sphere[1];
  EXPECT_NE(left, right);
  EXPECT_EQ(found.of_sphere[2], right);
  EXPECT_EQ(found.of_sphere[3], Chambers::none);
  ASSERT_LT(std::max(left, right), 2u);
  EXPECT_EQ(found.chambers[left].spheres, 1u);
  EXPECT_EQ(found.chambers[right].spheres, 2u);
  EXPECT_LT(found.chambers[left].position[0], 2);
  EXPECT_GT(found.chambers[right].position[0], 3);
  const auto solid = [&](std::uint32_t k) {
    return found.chambers[k].packing_fraction * found.chambers[k].share * packing.volume;
  };
  EXPECT_NEAR(solid(left), 4 * pi / 3 * std::pow(large, 3), 1e-9);
  EXPECT_NEAR(solid(right), 8 * pi / 3 * std::pow(small, 3), 1e-9);
  EXPECT_GT(found.by_mean.radius, small);
  EXPECT_GT(found.by_mean.share, found.by_smallest.share);
}

TEST(Chambers, HaveTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::joined(test::two_cubes_mesh(0.2), test::translated(test::helix_mesh(), {0, 0, 9}));
  const auto with = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return chambers_for(mesh, 0.21);
  };
  const Chambers one = with(1), many = with(4);
  ASSERT_EQ(one.chambers.size(), 3u);
  ASSERT_EQ(many.chambers.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(one.chambers[k].position, many.chambers[k].position);
    EXPECT_EQ(one.chambers[k].clearance, many.chambers[k].clearance);
    EXPECT_EQ(one.chambers[k].share, many.chambers[k].share);
  }
  EXPECT_EQ(one.by_smallest.share, many.by_smallest.share);
}

TEST(Chambers, AreAbsentWithoutSpheresOrWalls) {
  EXPECT_FALSE(chambers(packing_of({}, {Vector<3>::Zero(), Vector<3>::Ones()})));
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 1);
  EXPECT_FALSE(chambers(testing::periodic_packing<3>(spheres, Vector<3>::Constant(2))));
}

}  // namespace chambers_test
}  // namespace bernal

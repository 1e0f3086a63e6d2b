#include "soft/soft_walls.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/random.hpp"
#include "soft/soft_packing.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace soft_walls_test {

std::unique_ptr<Container> container_of(const Domain& shape) {
  return make_container(shape, WallArithmetic::filtered, 0x1p-50);
}

Mesh cube_with_cubic_void() {
  return test::joined(test::box_mesh({0, 0, 0}, {2, 2, 2}),
                      test::inverted(test::box_mesh({0.8, 0.8, 0.8}, {0.4, 0.4, 0.4})));
}

// ---- one sphere

struct Overlapping {
  std::string name;
  Domain shape;
  Vector<3> center;
  double r;
  Vector<3> nearest;  // point of the wall

  friend void PrintTo(const Overlapping& tested, std::ostream* out) { *out << tested.name; }
};

class OneContact : public ::testing::TestWithParam<Overlapping> {};

/// One contact moves a sphere by the whole overlap, two by half their sum: so a wall that counts twice shows.
TEST_P(OneContact, PushesByTheOverlapAlongItsNormal) {
  const Overlapping& tested = GetParam();
  const auto container = container_of(tested.shape);
  const Vector<3> away = tested.center - tested.nearest;
  const double overlap = tested.r - away.norm();
  for (const SoftKernels& kernels : soft_kernels()) {
    SCOPED_TRACE(kernels.name);
    Spheres<3> spheres;
    spheres.push_back(tested.center, tested.r);
    SoftPacking packing(spheres, *container, kernels);
    // Single precision of the overlap and of the coordinates.
    const double tolerance = 4 * (0x1p-24 * tested.r + packing.resolution());
    EXPECT_NEAR(packing.sweep_and_measure(1), overlap / tested.r, tolerance / tested.r);
    EXPECT_NEAR(packing.squeeze()[0], std::pow(overlap / tested.r, 2), 3 * tolerance / tested.r);
    packing.write_to(spheres);
    const Vector<3> expected = tested.center + overlap * away.normalized();
    EXPECT_LT((spheres.center(0) - expected).norm(), tolerance) << spheres.center(0).transpose();
    EXPECT_LT(packing.sweep_and_measure(1), 2 * tolerance / tested.r);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , OneContact,
    ::testing::Values(
        Overlapping{"Plane", Box{{0, 0, 0}, {1, 2, 3}}, {0.06, 1, 1}, 0.1, {0, 1, 1}},
        Overlapping{"Barrel", Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 2}, {0.57, 0.76, 1}, 0.1, {0.6, 0.8, 1}},
        Overlapping{"BarrelFromDeepInside",
                    Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 2},
                    {0.03, 0.04, 1},
                    0.99,
                    {0.6, 0.8, 1}},
        Overlapping{"SphericalWall", Sphere{{1, 1, 1}, 1}, {1, 1.95, 1}, 0.1, {1, 2, 1}},
        Overlapping{"Face", test::box_mesh({0, 0, 0}, {1, 1, 1}), {0.04, 0.6, 0.5}, 0.1, {0, 0.6, 0.5}},
        // The diagonal of the face, where two triangles are equally near.
        Overlapping{
            "DiagonalOfAFace", test::box_mesh({0, 0, 0}, {1, 1, 1}), {0.5, 0.04, 0.5}, 0.1, {0.5, 0, 0.5}},
        Overlapping{"FaceInManyTriangles",
                    test::divided(test::box_mesh({0, 0, 0}, {1, 1, 1}), 5),
                    {0.08, 0.613, 0.507},
                    0.1,
                    {0, 0.613, 0.507}},
        // Nearly a radius deep, some 800 triangles overlap.
        Overlapping{"DeepInAFaceInManyTriangles",
                    test::divided(test::box_mesh({0, 0, 0}, {1, 1, 1}), 6),
                    {0.03, 0.613, 0.507},
                    0.25,
                    {0, 0.613, 0.507}},
        Overlapping{"InnerEdge", test::l_shape_mesh(), {0.92, 0.95, 0.5}, 0.2, {1, 1, 0.5}},
        Overlapping{"FaceNextToAnInnerEdge", test::l_shape_mesh(), {1.05, 0.9, 0.5}, 0.2, {1.05, 1, 0.5}},
        Overlapping{"InnerCorner", cube_with_cubic_void(), {0.75, 0.72, 0.76}, 0.2, {0.8, 0.8, 0.8}},
        Overlapping{"SideOfAVoid", cube_with_cubic_void(), {0.7, 0.85, 1.1}, 0.2, {0.8, 0.85, 1.1}}),
    [](const auto& tested) { return tested.param.name; });

TEST(SoftWalls, PushOutOfACornerFromEveryFace) {
  for (const Domain& shape : {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(test::box_mesh({0, 0, 0}, {1, 1, 1})),
                              Domain(test::divided(test::box_mesh({0, 0, 0}, {1, 1, 1}), 5))}) {
    const auto container = container_of(shape);
    Spheres<3> spheres;
    spheres.push_back({0.09, 0.08, 0.07}, 0.1);
    SoftPacking packing(spheres, *container, soft_kernels().front());
    EXPECT_NEAR(packing.sweep_and_measure(3), 0.3, 1e-6);
    EXPECT_NEAR(packing.squeeze()[0], 0.01 + 0.04 + 0.09, 1e-6);
    packing.write_to(spheres);
    EXPECT_LT((spheres.center(0) - Vector<3>(0.1, 0.1, 0.1)).norm(), 1e-7);
  }
}

TEST(SoftWalls, BetweenPlatesNearerThanADiameterPushToTheMiddle) {
  const auto container = container_of(test::box_mesh({0, 0, 0}, {1, 1, 0.15}));
  Spheres<3> spheres;
  spheres.push_back({0.4, 0.45, 0.06}, 0.1);
  SoftPacking packing(spheres, *container, soft_kernels().front());
  packing.sweep(1);  // (0.04 - 0.01) / 2
  packing.write_to(spheres);
  EXPECT_LT((spheres.center(0) - Vector<3>(0.4, 0.45, 0.075)).norm(), 1e-7);
}

// ---- planes in place of facets

/// A sphere that moves by less than the leeway meets planes, which are tangent to all that it touches: they
/// push as the facets do but for the square of the way, and never hide a wall that has come nearer.
TEST(SoftWalls, AreAsGoodAsPlanesForAWhile) {
  constexpr double r = 0.15, leeway = 0.02;
  std::size_t touched = 0, corners = 0, otherwise = 0;
  for (const Domain& shape : {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, 2}),
                              Domain(Sphere{{0, 0, 0}, 1}), Domain(cube_with_cubic_void()),
                              Domain(test::l_shape_mesh()), Domain(test::divided(test::l_shape_mesh(), 2))}) {
    const auto container = container_of(shape);
    const Bounds<3> bounds = container->bounds();
    const Vector<3> corner = bounds.lower - Vector<3>::Constant(0.5);
    const Vector<3> unit = (bounds.size() + Vector<3>::Constant(1)) * 0x1p-32;
    Random random(11, stream(Stream::test));
    for (int trial = 0; trial < 400; ++trial) {
      const Vector<3> from = uniform_point(random, bounds);
      const double clearance = container->clearance(from);
      if (clearance < 0.3 * r || clearance > 1.1 * r) continue;
      const Vector<3> to = from + 0.99 * leeway * r * random.uniform() * uniform_direction<3>(random);
      std::vector<SoftSphere> spheres(lanes + 1, {{0, 0, 0}, std::numeric_limits<float>::quiet_NaN()});
      const std::vector<std::uint32_t> ids(lanes + 1, 0);
      const auto put = [&](const Vector<3>& p) {
        spheres[0].r = static_cast<float>(r);
        for (int k = 0; k < 3; ++k)
          spheres[0].x[k] =
              static_cast<std::int32_t>(static_cast<std::uint32_t>((p[k] - corner[k]) / unit[k]));
      };
      const auto push = [&](SoftWalls& walls) {
        WallPush out;
        walls.push(0, spheres.data(), out);
        return out;
      };
      SoftWalls walls(*container, corner, unit, 1), anew(*container, corner, unit, 1);
      put(from);
      walls.build(spheres, ids, 0.05f);
      anew.build(spheres, ids, 0.05f);
      if (!walls.near(0)) continue;
      push(walls);
      put(to);
      anew.look_anew(true);
      const WallPush planes = push(walls), facets = push(anew);
      const double error = 3 * leeway * leeway * r;
      const Vector<3> difference(planes.x[0] - facets.x[0], planes.y[0] - facets.y[0],
                                 planes.z[0] - facets.z[0]);
      touched += facets.contacts[0] > 0;
      corners += facets.contacts[0] > 1;
      if (planes.contacts[0] == facets.contacts[0]) {
        EXPECT_LT(difference.norm(), leeway * r) << to.transpose();  // normals turn with the way
        EXPECT_NEAR(planes.depth[0], facets.depth[0], error * facets.contacts[0]) << to.transpose();
      } else {  // one that only just touches, or is just another patch
        ++otherwise;
      }
      EXPECT_NEAR(planes.worst[0], facets.worst[0], error / r) << to.transpose();
      EXPECT_LE(planes.free[0], container->clearance(to) + 1e-6 * r);
    }
  }
  EXPECT_GT(touched, 400u);
  EXPECT_GT(corners, 40u);
  EXPECT_LT(otherwise, touched / 20);
}

/// However long a sphere is shaken without lists being built anew, a wall that it overlaps pushes it off.
TEST(SoftWalls, LetASphereGoThatHasMovedBackAndForth) {
  constexpr double r = 0.1;
  for (const Domain& shape :
       {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(test::box_mesh({0, 0, 0}, {1, 1, 1}))}) {
    const auto container = container_of(shape);
    Spheres<3> spheres;
    spheres.push_back({0.5, 0.5, 0.06}, r);
    spheres.push_back({0.5, 0.58, 0.06}, r);
    SoftPacking packing(spheres, *container, soft_kernels().front());
    // Both overlap the floor. They part, are pushed together as their radii change, and never go far.
    for (int k = 0; k < 4000; ++k) {
      packing.swell(k % 2 == 0 ? 1 : 0.97);
      packing.sweep_and_measure(5.6f);
    }
    packing.swell(1.05);
    for (int k = 0; k < 50; ++k) packing.sweep(1);
    packing.write_to(spheres);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_GE(spheres.x[2][i], 1.05 * r - 1e-6) << i;
  }
}

// ---- where space repeats itself

/// Two spheres that overlap each other across the seam of a column, and its wall: the one goes through the
/// seam, and on along the wall, as if it were nowhere.
TEST(SoftWallsOfAColumn, PushSpheresThroughTheSeam) {
  const auto column = container_of(Cylinder{{0, 0, 3}, {0, 0, 1}, 1, 2, true});
  const double r = 0.2, depth = 0.05, apart = 0.1;
  Spheres<3> spheres;
  for (const double z : {4.99, 4.99 - apart}) spheres.push_back({1 - r + depth, 0, z}, r);
  SoftPacking packing(spheres, *column, soft_kernels().front());
  for (int sweep = 0; sweep < 60; ++sweep) packing.sweep(5);
  EXPECT_LT(packing.sweep_and_measure(1), 1e-3);
  packing.write_to(spheres);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(column->contains(spheres.center(i), r - 1e-3)) << i;
    EXPECT_GE(spheres.x[2][i], 3);
    EXPECT_LT(spheres.x[2][i], 5);
  }
  EXPECT_LT(spheres.x[2][0], 3.3);  // it came through
  EXPECT_GT(spheres.x[2][1], 4.6);
  const Vector<3> way = column->boundary().minimum_image(spheres.center(1) - spheres.center(0));
  EXPECT_NEAR(way.norm(), 2 * r, 2e-3);
}

// ---- many spheres

/// Spheres at random inside that would fill the container `phi` times over, their radii down to r / `range`.
Spheres<3> crowd_in(const Container& container, double r, double range, double phi, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<3> spheres;
  double volume = 0;
  while (volume < phi * container.volume()) {
    const Vector<3> c = uniform_point(random, container.bounds());
    if (!container.contains(c, 0)) continue;
    spheres.push_back(c, r * std::pow(range, -random.uniform()));
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(spheres.r.back(), 3);
  }
  return spheres;
}

Spheres<3> after_sweeps(Spheres<3> spheres, const Container& container, const SoftKernels& kernels,
                        int sweeps) {
  SoftPacking packing(spheres, container, kernels);
  for (int k = 0; k < sweeps; ++k) packing.sweep(5);
  packing.write_to(spheres);
  return spheres;
}

TEST(SoftWalls, GiveTheSameBitsInEveryInstructionSet) {
  for (const Domain& shape : {Domain(Cylinder{{0, 0, 0}, {1, 2, 3}, 0.5, 1}), Domain(test::l_shape_mesh())}) {
    const auto container = container_of(shape);
    const Spheres<3> crowd = crowd_in(*container, 0.08, 3, 0.7, 1);
    const Spheres<3> plain = after_sweeps(crowd, *container, soft_kernels().back(), 60);
    EXPECT_NE(plain, crowd);
    for (const SoftKernels& kernels : soft_kernels())
      EXPECT_EQ(after_sweeps(crowd, *container, kernels, 60), plain) << kernels.name;
  }
}

TEST(SoftWalls, GiveTheSameBitsForAnyNumberOfThreads) {
  for (const Domain& shape : {Domain(Box{{0, 0, 0}, {1, 1, 1}}), Domain(test::l_shape_mesh())}) {
    const auto container = container_of(shape);
    const double r = std::cbrt(container->volume()) / 42;
    const Spheres<3> crowd = crowd_in(*container, r, 1, 0.7, 1);
    ASSERT_GT(crowd.size(), 12000u);
    const auto with_threads = [&](std::size_t n) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, n);
      return after_sweeps(crowd, *container, soft_kernels().front(), 12);
    };
    EXPECT_EQ(with_threads(1), with_threads(2));
  }
}

struct Enclosed {
  std::string name;
  Domain shape;
  std::function<int(const Vector<3>&)> chamber;
  double r;      // of the largest
  double range;  // of the radii

  friend void PrintTo(const Enclosed& tested, std::ostream* out) { *out << tested.name; }
};

/// Two unit cubes side by side with a plate of the given thickness between them.
Mesh two_chambers(double plate) {
  return test::joined(test::box_mesh({-1, 0, 0}, {1, 1, 1}), test::box_mesh({plate, 0, 0}, {1, 1, 1}));
}

int side(const Vector<3>& c) { return c[0] > 0; }
int any(const Vector<3>&) { return 0; }

class EnclosedCrowd : public ::testing::TestWithParam<Enclosed> {};

TEST_P(EnclosedCrowd, NeverPassesAWall) {
  const Enclosed& tested = GetParam();
  const auto container = container_of(tested.shape);
  for (const double phi : {0.8, 2.5}) {
    const Spheres<3> start = crowd_in(*container, tested.r, tested.range, phi, 3);
    SoftPacking packing(start, *container, soft_kernels().front());
    packing.wear_lists(3);  // as a crowd does
    for (int k = 1; k <= 200; ++k) {
      packing.sweep(5.4f);
      if (k > 10 && k % 50 != 0) continue;
      Spheres<3> now = start;
      packing.write_to(now);
      for (std::size_t i = 0; i < now.size(); ++i) {
        ASSERT_TRUE(container->contains(now.center(i), 0))
            << "sphere " << i << " after " << k << " sweeps, " << now.center(i).transpose();
        ASSERT_EQ(tested.chamber(now.center(i)), tested.chamber(start.center(i))) << i << " after " << k;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    , EnclosedCrowd,
    ::testing::Values(
        Enclosed{"OnBothSidesOfAThinPlate", two_chambers(1e-4), side, 0.1, 1},
        Enclosed{"OfOneToTenOnBothSidesOfAThinPlate", two_chambers(1e-4), side, 0.3, 10},
        Enclosed{"OnBothSidesOfAPlateWithoutThickness", two_chambers(0), side, 0.1, 1},
        Enclosed{"OfOneToTenOnBothSidesOfAPlateWithoutThickness", two_chambers(0), side, 0.3, 10},
        Enclosed{"InAnL", test::l_shape_mesh(), any, 0.3, 10},
        Enclosed{"AroundAVoid", cube_with_cubic_void(), any, 0.3, 10},
        Enclosed{"InAThinShell",
                 test::joined(test::icosphere_mesh(1, 2), test::inverted(test::icosphere_mesh(0.9, 2))), any,
                 0.1, 10},
        Enclosed{"InACylinder", Cylinder{{0, 0, 0}, {1, 2, 3}, 0.5, 1}, any, 0.15, 10},
        Enclosed{"InASphere", Sphere{{0, 0, 0}, 0.7}, any, 0.15, 10},
        // Not one sphere has room.
        Enclosed{"InASlabOfHalfARadius", Box{{0, 0, 0}, {1, 1, 0.05}}, any, 0.1, 1}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace soft_walls_test
}  // namespace bernal

#include "bernal/domain/domain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"

namespace bernal {
namespace domain_test {

using std::numbers::pi;

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

TEST(Domain, KindVolumeArea) {
  const Domain box = Box{{1, 2, 3}, {1, 2, 4}};
  EXPECT_EQ(kind_of(box), "box");
  EXPECT_DOUBLE_EQ(volume_of(box), 8);
  EXPECT_DOUBLE_EQ(area_of(box), 28);

  const Domain cylinder = Cylinder{{0, 0, 0}, {3, 4, 12}, 2, 5};
  EXPECT_EQ(kind_of(cylinder), "cylinder");
  EXPECT_DOUBLE_EQ(volume_of(cylinder), 20 * pi);
  EXPECT_DOUBLE_EQ(area_of(cylinder), 28 * pi);

  const Domain sphere = Sphere{{0, 0, 0}, 3};
  EXPECT_EQ(kind_of(sphere), "sphere");
  EXPECT_DOUBLE_EQ(volume_of(sphere), 36 * pi);
  EXPECT_DOUBLE_EQ(area_of(sphere), 36 * pi);

  const Domain mesh = tetrahedron();
  EXPECT_EQ(kind_of(mesh), "mesh");
  EXPECT_DOUBLE_EQ(volume_of(mesh), 1);
  // Three right triangles and the oblique one: |(−1, 2, 0) × (−1, 0, 3)| / 2 = 7/2.
  EXPECT_DOUBLE_EQ(area_of(mesh), 1 + 1.5 + 3 + 3.5);
}

// Summed about the bounds' centre, the volume keeps its digits as far as the vertices themselves do.
TEST(Domain, VolumeOfAMeshFarAwayKeepsItsDigits) {
  Mesh mesh = tetrahedron();
  for (Vector<3>& v : mesh.vertices) v += Vector<3>(1 << 30, -(1 << 29), 1 << 28);
  EXPECT_DOUBLE_EQ(volume_of(mesh), 1);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  EXPECT_NE(volume_of(mesh), 1) << "orientation counts";
}

// The bounds are those of the two rims.
TEST(Domain, BoundsOfAnObliqueCylinder) {
  Random random(1, stream(Stream::test));
  for (int trial = 0; trial < 50; ++trial) {
    Cylinder s;
    s.base = uniform_direction<3>(random);
    s.axis = 7 * uniform_direction<3>(random);
    if (trial < 3) s.axis = Vector<3>::Unit(trial) * -2;
    s.radius = random.uniform(0.1, 2);
    s.height = random.uniform(0.1, 2);
    const Vector<3> axis = s.axis.normalized(), e = axis.unitOrthogonal(), f = axis.cross(e);
    const Bounds<3> bounds = bounds_of(s);
    Vector<3> lower = Vector<3>::Constant(1e9), upper = -lower;
    constexpr int n = 1000;
    for (int k = 0; k < n; ++k) {
      const double angle = 2 * pi * k / n;
      const Vector<3> rim = s.base + s.radius * (std::cos(angle) * e + std::sin(angle) * f);
      for (const Vector<3>& p : {rim, Vector<3>(rim + s.height * axis)}) {
        lower = lower.cwiseMin(p);
        upper = upper.cwiseMax(p);
      }
    }
    // n points of a rim miss its extreme by at most R (1 - cos(pi / n)).
    const double missed = s.radius * (1 - std::cos(pi / n)) + 1e-14;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(lower[k], bounds.lower[k] - 1e-14);
      EXPECT_LE(upper[k], bounds.upper[k] + 1e-14);
      EXPECT_NEAR(lower[k], bounds.lower[k], missed);
      EXPECT_NEAR(upper[k], bounds.upper[k], missed);
    }
  }
}

// At a unit offset along the axis nothing is lost to cancellation: 1 - a² of a = 1 is exactly no extent.
TEST(Domain, BoundsOfAnUprightCylinderAreExact) {
  const Bounds<3> bounds = bounds_of(Cylinder{{0, 0, 0}, {0, 0, 4}, 1, 2});
  EXPECT_EQ(bounds.lower, Vector<3>(-1, -1, 0));
  EXPECT_EQ(bounds.upper, Vector<3>(1, 1, 2));
}

TEST(PeriodicCylinder, IsOnePeriodOfAColumn) {
  for (const double length : {2.0, -0.5}) {
    const Domain column = Cylinder{{1, 2, 3}, {0, length, 0}, 2, 5, true};
    const double lowest = length > 0 ? 2 : -3;
    EXPECT_EQ(kind_of(column), "cylinder");
    EXPECT_EQ(name_of(column), "periodic cylinder");
    EXPECT_TRUE(has_walls(column));
    EXPECT_TRUE(is_periodic(column));
    EXPECT_DOUBLE_EQ(volume_of(column), 20 * pi);
    EXPECT_DOUBLE_EQ(area_of(column), 20 * pi) << "no lids";
    EXPECT_EQ(bounds_of(column).lower, Vector<3>(-1, lowest, 1));
    EXPECT_EQ(bounds_of(column).upper, Vector<3>(3, lowest + 5, 5));
    const Boundary<3> boundary = boundary_of<3>(column);
    EXPECT_EQ(boundary.edges, Vector<3>(0, 5, 0));
    EXPECT_EQ(boundary.wrap({9, lowest - 1, 9}), Vector<3>(9, lowest + 4, 9));
    EXPECT_EQ(boundary.wrap({9, lowest + 5, 9}), Vector<3>(9, lowest, 9));
  }
  EXPECT_FALSE(is_periodic(Cylinder{}));
  EXPECT_EQ((Cylinder{.axis = {1, 1, 0}}).coordinate_axis(), -1);
  EXPECT_EQ((Cylinder{.axis = {0, 0, 0}}).coordinate_axis(), -1);
}

TEST(Box, EndsOrRepeatsOnEveryAxis) {
  const Domain slab = Box{{1, 2, 3}, {4, 5, 6}, {true, false, true}};
  EXPECT_EQ(kind_of(slab), "periodic");
  EXPECT_EQ(name_of(slab), "box periodic but along axis 1");
  EXPECT_TRUE(has_walls(slab) && is_periodic(slab));
  EXPECT_DOUBLE_EQ(volume_of(slab), 120);
  EXPECT_DOUBLE_EQ(area_of(slab), 2 * 4 * 6);
  EXPECT_EQ(boundary_of<3>(slab).edges, Vector<3>(4, 0, 6));
  EXPECT_EQ(boundary_of<3>(slab).wrap({-1, -1, -1}), Vector<3>(3, -1, 5));

  const Domain closed = Box{{1, 2}, {4, 5}};
  EXPECT_EQ(kind_of(closed), "box");
  EXPECT_EQ(dimension_of(closed), 2);
  EXPECT_FALSE(is_periodic(closed));
  EXPECT_EQ(volume_of(closed), 20);
  EXPECT_FALSE(has_walls(periodic_box(Vector<2>(1, 1))));
  EXPECT_TRUE(has_walls(periodic_box(Vector<2>(1, 1), {false, true})));
}

TEST(Wrap, TakesCentresToOnePeriodAndLeavesOthers) {
  Spheres<dynamic> spheres(2);
  const Box box{{-1, 3}, {2, 5}, {true, false}};
  for (const double x : {-1.0, 0.0, 1.0, 7.25, -0x1p60, std::nextafter(-1.0, -2.0)})
    spheres.push_back(Vector<2>(x, 100 + x), 1);
  const Spheres<dynamic> before = spheres;
  wrap(spheres, box);
  EXPECT_EQ(spheres.x[1], before.x[1]);
  EXPECT_EQ(spheres.x[0], (std::vector<double>{-1, 0, -1, -0.75, 0, std::nextafter(-1.0, -2.0) + 2}));
}

// A period is the distance of images: it must not be rounded, wherever the frame puts the box.
TEST(Frame, DoesNotRoundPeriods) {
  Random random(4, stream(Stream::test));
  for (int i = 0; i < 1000; ++i) {
    const Vector<3> corner = uniform_point<3>(random, {-1e4 * Vector<3>::Ones(), 1e4 * Vector<3>::Ones()});
    const Vector<3> size = uniform_point<3>(random, {1e-3 * Vector<3>::Ones(), Vector<3>::Ones()});
    for (const Domain& domain : {Domain(Box{corner, size, {true, false, true}}),
                                 Domain(Cylinder{corner, {0, -3, 0}, size[0], size[1], true})}) {
      const Frame frame = frame_of(domain);
      EXPECT_EQ(frame.scale * boundary_of<3>(to_local(domain, frame)).edges, boundary_of<3>(domain).edges);
    }
  }
}

std::vector<Domain> one_of_each_kind(double size, const Vector<3>& offset) {
  Mesh mesh = tetrahedron();
  for (Vector<3>& v : mesh.vertices) v = offset + size * v;
  return {Box{offset, size * Vector<3>(1, 0.7, 1.9)}, Cylinder{offset, {1, 2, -2}, 0.7 * size, 1.3 * size},
          Sphere{offset, 0.77 * size}, mesh};
}

double spacing(double x) {
  return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x);
}

TEST(Frame, AnySizeAnywhereComesToTheSameLocalSize) {
  for (const double size : {1e-9, 1e-3, 1.0, 123.0, 1e9}) {
    for (const double diagonals : {0.0, 1.0, 1e4, 1e8}) {
      for (const Domain& shape : one_of_each_kind(size, size * diagonals * Vector<3>(0.3, -0.8, 0.6))) {
        SCOPED_TRACE(::testing::Message()
                     << kind_of(shape) << " of size " << size << ", " << diagonals << " away");
        const Frame frame = frame_of(shape);
        int exponent = 0;
        EXPECT_EQ(std::frexp(frame.scale, &exponent), 0.5) << "no power of two";
        const Bounds<3> scene = bounds_of(shape), local = bounds_of(to_local(shape, frame));
        EXPECT_GE(scene.diagonal() / frame.scale, 1);
        EXPECT_LT(scene.diagonal() / frame.scale, 2);

        // Few bits: a multiple of a sixteenth of the scale, within half of that from the centre.
        for (int k = 0; k < 3; ++k) {
          const double sixteenths = frame.origin[k] / frame.scale * 16;
          EXPECT_EQ(sixteenths, std::nearbyint(sixteenths));
          EXPECT_LE(std::abs(local.lower[k] + local.upper[k]) / 2, 1.0 / 32 + 2 * frame.resolution);
        }

        const double farthest =
            std::max(scene.lower.cwiseAbs().maxCoeff(), scene.upper.cwiseAbs().maxCoeff());
        EXPECT_EQ(frame.resolution, std::max(spacing(farthest) / frame.scale, spacing(2)));

        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(frame.to_scene(local.lower)[k], scene.lower[k], 2 * frame.resolution * frame.scale);
          EXPECT_NEAR(frame.to_scene(local.upper)[k], scene.upper[k], 2 * frame.resolution * frame.scale);
        }
        EXPECT_NEAR(volume_of(to_local(shape, frame)) * std::pow(frame.scale, 3) / volume_of(shape), 1,
                    100 * frame.resolution);
      }
    }
  }
}

// Far away, where coordinates have no more bits than the scale asks for, moving into the frame rounds
// nothing.
TEST(Frame, FarAwayTheWayIntoTheFrameIsExact) {
  Random random(2, stream(Stream::test));
  for (const double diagonals : {1e2, 1e4, 1e8}) {
    const Vector<3> offset = diagonals * Vector<3>(0.3, -0.8, 0.6);
    const Frame frame = frame_of(Box{offset, {1, 1, 1}});
    for (int i = 0; i < 1000; ++i) {
      const Vector<3> p = uniform_point<3>(random, {offset, offset + Vector<3>::Ones()});
      EXPECT_EQ(frame.to_scene(frame.to_local(p)), p);
    }
  }
}

TEST(Frame, AShapeWithoutExtentIsRefused) {
  EXPECT_THROW(frame_of(Mesh{}), Error);
  EXPECT_THROW(frame_of(Sphere{{0, 0, 0}, 0}), Error);
  EXPECT_THROW(frame_of(Sphere{{0, 0, 0}, std::numeric_limits<double>::quiet_NaN()}), Error);
  EXPECT_THROW(frame_of(Box{{0, 0, 0}, {1, std::numeric_limits<double>::infinity(), 1}}), Error);
}

}  // namespace domain_test
}  // namespace bernal

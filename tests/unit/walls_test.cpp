#include "hard/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bernal/core/random.hpp"
#include "hard/convex_walls.hpp"
#include "hard/hard_spheres.hpp"
#include "support/flights.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace walls_test {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;

/// Room between a sphere and the wall at time t, by its definition.
Real room(const Wall<3>& wall, const Vector<3>& p, const Vector<3>& v, double r, double growth, Real t) {
  const Point at = p.cast<Real>() + t * v.cast<Real>();
  const Point along = wall.along.cast<Real>();
  const Real radius = r + t * growth;
  if (!wall.round) return wall.extent - along.dot(at) - radius;
  const Point d = at - wall.center.cast<Real>();
  return wall.extent - (d - d.dot(along) * along).norm() - radius;
}

std::vector<Wall<3>> every_kind_of_wall(Random& random) {
  const Vector<3> n = uniform_direction<3>(random);
  return {{.along = n, .extent = 0.7},
          {.round = true, .along = n, .center = {0.1, -0.1, 0.2}, .extent = 0.9},
          {.round = true, .center = {0.05, 0.1, 0}, .extent = 1.1}};
}

/// All regions are convex and room falls from where it is largest, so the first zero is the only one after
/// that: bisection needs no more than a time at which there is no room.
TEST(TimeToTouch, IsThatOfBisection) {
  Random random(1, stream(Stream::test));
  int met = 0;
  for (int k = 0; k < 3000; ++k) {
    for (const Wall<3>& wall : every_kind_of_wall(random)) {
      const Vector<3> p = 0.5 * random.uniform() * uniform_direction<3>(random);
      const Vector<3> v = std::exp(random.uniform(-3, 1)) * uniform_direction<3>(random);
      const double r = 0.15 * random.uniform();
      const double growth = k % 3 == 0 ? 0 : std::exp(random.uniform(-6, 1));
      ASSERT_GT(room(wall, p, v, r, growth, 0), 0);
      const double time = wall.time_to_touch(p, v, r, growth);
      Real last = 0, next = 1e-3L;
      while (room(wall, p, v, r, growth, next) > 0 && next < 1e6L) last = next, next *= 2;
      if (next >= 1e6L) {
        EXPECT_GT(time, 1e5);
        continue;
      }
      for (int step = 0; step < 80; ++step) {
        const Real middle = (last + next) / 2;
        (room(wall, p, v, r, growth, middle) > 0 ? last : next) = middle;
      }
      ++met;
      // Room of about 1 is known to some roundoffs and falls at the speed at which the two meet.
      const Real slope = (room(wall, p, v, r, growth, next * (1 - 1e-7L)) -
                          room(wall, p, v, r, growth, next * (1 + 1e-7L))) /
                         (2e-7L * next);
      EXPECT_NEAR(time, static_cast<double>(next), 1e-14 + 1e-14 / static_cast<double>(slope) + 1e-13 * time);
    }
  }
  EXPECT_GT(met, 7000);
}

TEST(TimeToTouch, IsNowForWhatOverlapsByRoundingAndComesCloser) {
  Random random(2, stream(Stream::test));
  for (const Wall<3>& wall : every_kind_of_wall(random)) {
    const Vector<3> touching = wall.round ? wall.center + (wall.extent - 0.1) * wall.along.unitOrthogonal()
                                          : Vector<3>(0.6 * wall.along);
    if (wall.round && wall.along.isZero()) continue;
    const Vector<3> n = wall.outward(touching);
    const Vector<3> beyond = touching + 1e-15 * n;
    EXPECT_LT(wall.time_to_touch(beyond, n, 0.1, 0), 1e-14);
    EXPECT_LT(wall.time_to_touch(beyond, Vector<3>::Zero(), 0.1, 0.01), 1e-12);
    EXPECT_GT(wall.time_to_touch(beyond, -n, 0.1, 0.01), 0.5);
  }
}

/// A sphere that glides along a round wall and is outside by rounding must not glide away from it.
TEST(TimeToTouch, BringsBackWhatGlidesAlongARoundWall) {
  const Wall<3> wall{.round = true, .extent = 1};
  const Vector<3> outside(0.9 * (1 + 1e-16) + 2e-16, 0, 0), v(-1e-14, 1, 0);
  const double time = wall.time_to_touch(outside, v, 0.1, 0);
  EXPECT_LT(time, 1e-7);
}

struct Room {
  const char* name;
  Domain shape;
  double area, volume;
};

std::vector<Room> rooms() {
  const double pi = M_PI;
  return {{"box", Box{{0, 0, 0}, {1, 1.2, 0.9}}, 2 * (1.2 + 0.9 + 1.08), 1.08},
          {"cylinder", Cylinder{{0.6, 0.6, 0.1}, {0, 0, 1}, 0.5, 1.0}, 1.5 * pi, 0.25 * pi},
          {"sphere", Sphere{{0.6, 0.6, 0.6}, 0.6}, 4 * pi * 0.36, 4.0 / 3.0 * pi * 0.216}};
}

/// Spheres of radius r in the middle of a room, in a periodic box around it.
struct Flight {
  std::vector<Wall<3>> walls;
  Spheres<3> spheres;
  Vector<3> edges, shift;

  Flight(const Domain& shape, std::size_t n, double r, double most_size = 1)
      : walls(convex_walls(shape, 1e-9)) {
    const Bounds<3> bounds = bounds_of(shape);
    edges = bounds.size().array() + 6 * r * most_size;
    shift = 0.5 * edges - bounds.center();
    for (Wall<3>& wall : walls) wall.shift(shift);
    Random random(3, stream(Stream::test));
    while (spheres.size() < n) {
      const Vector<3> c = uniform_point(random, bounds) + shift;
      bool free = clearance(c) >= r;
      for (std::size_t j = 0; j < spheres.size() && free; ++j) free = (spheres.center(j) - c).norm() > 2 * r;
      if (free) spheres.push_back(c, r);
    }
  }
  double clearance(const Vector<3>& c) const {
    double least = 1e300;
    for (const Wall<3>& wall : walls) least = std::min(least, wall.clearance(c));
    return least;
  }
  HardSpheres<3> start(std::uint64_t seed = 1) const {
    return {spheres, edges, Random(seed, stream(Stream::test, 2)), {.walls = walls}};
  }
  /// How far the worst sphere is across a wall, in radii, at the size that they have now.
  double protrusion(const HardSpheres<3>& flight) const {
    Spheres<3> now = spheres;
    flight.write_to(now);
    double worst = -1e300;
    for (std::size_t i = 0; i < now.size(); ++i)
      worst = std::max(worst, flight.size() - clearance(now.center(i)) / now.r[i]);
    return worst;
  }
};

TEST(HardSpheresBetweenWalls, ConserveEnergyWhereNothingGrows) {
  for (const Room& room : rooms()) {
    SCOPED_TRACE(room.name);
    const Flight gas(room.shape, 200, 0.04);
    HardSpheres<3> flight = gas.start();
    const double energy = flight.kinetic_energy();
    std::uint64_t reflections = 0;
    for (int k = 0; k < 30; ++k) {
      reflections += flight.fly(0).reflections;
      ASSERT_LT(gas.protrusion(flight), 1e-13);
    }
    EXPECT_GT(reflections, 5000u);
    EXPECT_NEAR(flight.kinetic_energy() / energy, 1, 1e-10);
  }
}

struct Pressures {
  double virial, on_walls;  ///< P V / N k T
};

Pressures mean_pressures(const Room& room, std::size_t n, double r, int periods) {
  const Flight gas(room.shape, n, r);
  HardSpheres<3> flight = gas.start();
  for (int k = 0; k < 10; ++k) flight.fly(0);
  double virial = 0, momentum = 0, time = 0;
  for (int k = 0; k < periods; ++k) {
    const FlightPeriod period = flight.fly(0);
    virial += period.compressibility_factor * period.time;
    momentum += period.wall_momentum;
    time += period.time;
  }
  const double temperature = 2 * flight.kinetic_energy() / (3 * static_cast<double>(n));
  return {virial / time, momentum / time / room.area * room.volume / (static_cast<double>(n) * temperature)};
}

/// P V = N k T (1 + 4 φ + A r / 3 V): the second virial coefficient, and the room that walls keep from
/// centres; the next terms are 0.005. Spheres that seldom meet keep their first velocities for long, uniform
/// in a cube: their mean square across a wall scatters by some 3 %.
TEST(HardSpheresBetweenWalls, AreNearlyAnIdealGasWhereTheyAreFew) {
  constexpr double r = 0.02;
  constexpr std::size_t n = 300;
  for (const Room& room : rooms()) {
    SCOPED_TRACE(room.name);
    const double phi = n * ball_volume(3, r) / room.volume;
    const double expected = 1 + 4 * phi + room.area * r / (3 * room.volume);
    const Pressures pressures = mean_pressures(room, n, r, 20);
    EXPECT_NEAR(pressures.on_walls / expected, 1, 0.05);
    EXPECT_NEAR(pressures.virial / expected, 1, 0.015);
  }
}

/// The virial of pairs, with the radius for the way from a wall, is the pressure on the walls: at a packing
/// fraction of about 0.3 far above that of an ideal gas.
TEST(HardSpheresBetweenWalls, PressTheWallsAsTheirVirialSays) {
  for (const Room& room : rooms()) {
    SCOPED_TRACE(room.name);
    const double r = std::cbrt(0.3 * room.volume / (300 * 4.0 / 3.0 * M_PI));
    const Pressures pressures = mean_pressures(room, 300, r, 200);
    EXPECT_GT(pressures.virial, 3);
    EXPECT_NEAR(pressures.on_walls / pressures.virial, 1, 0.02);
  }
}

TEST(HardSpheresBetweenWalls, NeverCrossThemWhileTheyGrow) {
  for (const Room& room : rooms()) {
    SCOPED_TRACE(room.name);
    const Flight gas(room.shape, 150, 0.05, 2);
    HardSpheres<3> flight = gas.start();
    FlightPeriod period;
    for (int k = 0; k < 1000 && period.compressibility_factor < 1e8; ++k) {
      period = flight.fly(0.05);
      ASSERT_LT(gas.protrusion(flight), 1e-13);
    }
    EXPECT_GT(period.compressibility_factor, 1e8);
  }
}

/// One sphere grows until the walls hold it: the inscribed sphere.
TEST(HardSpheresBetweenWalls, GrowToTheInscribedSphere) {
  const double inscribed[] = {0.45, 0.5, 0.6};
  for (std::size_t k = 0; k < 3; ++k) {
    const Flight alone(rooms()[k].shape, 1, 0.2, 3);
    HardSpheres<3> flight = alone.start();
    FlightPeriod period;
    for (int j = 0; j < 10000 && period.compressibility_factor < 1e8; ++j) period = flight.fly(0.05);
    EXPECT_NEAR(flight.size() * 0.2, inscribed[k], 1e-6) << rooms()[k].name;
  }
}

TEST(ConvexWalls, AreTheFacesOfABoxMesh) {
  const Mesh mesh = test::divided(test::box_mesh({0, 0, 0}, {1, 2, 3}), 3);
  const std::vector<Wall<3>> walls = convex_walls(mesh, 1e-6);
  EXPECT_EQ(walls.size(), 6u);
  Random random(5, stream(Stream::test));
  for (int k = 0; k < 1000; ++k) {
    const Vector<3> p = uniform_point(random, Bounds<3>{{0, 0, 0}, {1, 2, 3}});
    double least = 1e300;
    for (const Wall<3>& wall : walls) least = std::min(least, wall.clearance(p));
    EXPECT_NEAR(least, std::min(p.minCoeff(), (Vector<3>(1, 2, 3) - p).minCoeff()), 1e-14);
  }
}

/// Every corner of the mesh lies on or behind a wall, and at most 6 tolerances outside of any.
void expect_sound(const Mesh& mesh, const std::vector<Wall<3>>& walls, double tolerance) {
  for (const auto& triangle : mesh.triangles) {
    bool behind = false;
    for (const Wall<3>& wall : walls) {
      double highest = -1e300;
      for (const auto v : triangle) highest = std::max(highest, wall.clearance(mesh.vertices[v]));
      behind = behind || highest < 1e-15;
      ASSERT_GT(highest, -6 * tolerance);
    }
    ASSERT_TRUE(behind) << "a facet that spheres could pass";
  }
}

/// In single precision corners are off by 6e-8; the triangles of a fan are as thin as 1e-5 and point
/// anywhere.
TEST(ConvexWalls, TakeAFanOfNeedlesRoundedByAFile) {
  for (const std::uint32_t sides : {100u, 1000u}) {
    Mesh mesh = test::prism_mesh(sides, 1, 2);
    const Eigen::AngleAxisd turn(0.7, Vector<3>(1, 2, 3).normalized());
    for (Vector<3>& v : mesh.vertices) v = (turn * v).cast<float>().cast<double>();
    const std::vector<Wall<3>> walls = convex_walls(mesh, 3e-6);
    EXPECT_LE(walls.size(), sides + 2);
    expect_sound(mesh, walls, 3e-6);
    // The larger the tolerance, the fewer walls of a round side.
    EXPECT_LT(convex_walls(mesh, 1e-4).size(), std::max<std::size_t>(walls.size(), 110));
  }
  const Mesh ball = test::icosphere_mesh(1, 3);
  expect_sound(ball, convex_walls(ball, 1e-6), 1e-6);
}

TEST(ConvexWalls, AreNoneOfWhatIsNotConvex) {
  for (const Mesh& mesh :
       {test::l_shape_mesh(), test::torus_mesh(1, 0.4, 12, 6),
        test::joined(test::icosphere_mesh(1, 1), test::inverted(test::icosphere_mesh(0.5, 0))),
        test::joined(test::box_mesh({0, 0, 0}, {1, 1, 1}), test::box_mesh({2, 0, 0}, {1, 1, 1}))})
    EXPECT_TRUE(convex_walls(mesh, 1e-4).empty());
}

/// Thousands of planes: the grid finds the same near ones as a look at all of them.
TEST(Walls, FindTheNearOnesOfMany) {
  std::vector<Wall<3>> many = convex_walls(test::prism_mesh(500, 1, 2), 1e-9);
  const Vector<3> edges(2.5, 2.5, 2.5);
  for (Wall<3>& wall : many) wall.shift({1.25, 1.25, 0.25});
  Walls<3> walls(many, edges);
  walls.start(1, 0.2);
  Random random(6, stream(Stream::test));
  int met = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vector<3> home = uniform_point(random, Bounds<3>{{0.3, 0.3, 0.3}, {2.2, 2.2, 2.2}});
    double clearance = 1e300, first = 1e300;
    const Vector<3> v = uniform_direction<3>(random);
    for (const Wall<3>& wall : many) clearance = std::min(clearance, wall.clearance(home));
    if (clearance < 0.1) continue;
    walls.settle(0, home, 0.2);
    for (const Wall<3>& wall : many) first = std::min(first, wall.time_to_touch(home, v, 0.1, 0));
    // A wall is in reach as long as the sphere's centre is no farther than 0.1 from home.
    if (first > 0.1) continue;
    ++met;
    EXPECT_EQ(walls.time_to_touch(0, home, v, 0.1, 0), first);
  }
  EXPECT_GT(met, 100);
}

}  // namespace walls_test
}  // namespace bernal

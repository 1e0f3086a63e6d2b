// The move limit without a skin at its three levels, against distances of fifty digits: `exact` is the last
// double before the contact, `filtered` never above it and at most a few roundoffs below, `plain` within its
// bound. Then the cases that are hard, by name, with answers known beforehand.
#include "domain/free_path.hpp"

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bernal/core/random.hpp"
#include "cad/certified_distance.hpp"
#include "domain/exact_way.hpp"
#include "support/containers.hpp"
#include "support/precise_distance.hpp"

namespace bernal {
namespace free_path_test {

using Real = boost::multiprecision::cpp_bin_float_50;
using test::Point;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double u = tolerance::roundoff;
constexpr WallArithmetic plain = WallArithmetic::plain, filtered = WallArithmetic::filtered,
                         exact_level = WallArithmetic::exact;

template <class R>
R distance_after(const Facet& f, const Motion& m, const R& t) {
  const Point<R> p = Point<R>(m.c) + t * Point<R>(m.direction);
  if (f.kind == Facet::Kind::plane)  // whose normal is taken as it stands
    return test::precise_distance<R>(f, p) / norm(Point<R>(f.b));
  return test::precise_distance<R>(f, p);
}

/// The least distance on the way up to t. Convex for a triangle, so the least of both ends where it still
/// falls, else by thirds; concave for the others.
Real least_distance(const Facet& f, const Motion& m, double t) {
  const Real first = distance_after<Real>(f, m, 0), last = distance_after<Real>(f, m, t);
  if (f.kind != Facet::Kind::triangle || t == 0) return std::min(first, last);
  if (distance_after<Real>(f, m, Real(t) * (1 - Real(1e-20))) >= last) return last;
  Real low = 0, high = t;
  for (int k = 0; k < 130; ++k) {
    const Real a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (distance_after(f, m, a) < distance_after(f, m, b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return std::min(first, distance_after<Real>(f, m, (low + high) / 2));
}

/// What the oracle itself may be wrong by, of lengths of order 1 and less: far below the squares of roundoffs
/// by which a tangent penetrates.
const Real oracle_error("1e-38");

double lengths(const Facet& f, const Motion& m) {
  double farthest = (m.c - f.a).norm();
  if (f.kind == Facet::Kind::triangle)
    farthest = std::max({farthest, (m.c - f.b).norm(), (m.c - f.c).norm()});
  return farthest + m.r + f.radius;
}

struct Tally {
  int at_once = 0, limited = 0, free = 0;
};

void expect_levels(const Facet& f, const Motion& m, Tally& tally, const std::string& what) {
  const double exact = free_path(f, m, exact_level), lower = free_path(f, m, filtered);
  ASSERT_GE(exact, 0) << what;
  ASSERT_LE(exact, m.limit) << what;
  (exact == m.limit ? tally.free : exact == 0 ? tally.at_once : tally.limited) += 1;
  const Real error = oracle_error * Real(std::max(1.0, lengths(f, m)));

  // The last double: it clears, the next does not; unless the ball penetrates from the start.
  const bool starts_clear = distance_after<Real>(f, m, 0) - m.r >= -error;
  if (starts_clear) {
    ASSERT_GE(least_distance(f, m, exact) - m.r, -error) << what;
  } else {
    ASSERT_EQ(exact, 0) << what;
  }
  // (Beside 0 that is too small a number to be added: what is convex dips further on.)
  if (exact < m.limit) {
    const double next = exact > 0 ? std::nextafter(exact, infinity) : 1e-12 / m.direction.norm();
    ASSERT_LT(least_distance(f, m, next) - m.r, 0) << what;
  }

  ASSERT_LE(lower, exact) << what;
  ASSERT_EQ(lower == m.limit, exact == m.limit) << what;
  const double slack = 4 * u * (lengths(f, m) / m.direction.norm() + exact);
  ASSERT_GE(lower, exact - slack - 2 * (std::nextafter(exact, infinity) - exact)) << what;

  const double rough = free_path(f, m, plain);
  const double bound = rounding_bound(lengths_of(f, m));
  if (starts_clear) {
    ASSERT_GE(static_cast<double>(least_distance(f, m, rough) - m.r), -bound) << what;
    if (rough < m.limit) {
      ASSERT_LE(static_cast<double>(least_distance(f, m, rough) - m.r), 2 * bound) << what;
    }
  }
}

Vector<3> random_point(Random& random) { return uniform_point<3>(random, {{-1, -1, -1}, {1, 1, 1}}); }

Facet random_facet(Random& random, Facet::Kind kind) {
  Facet f;
  f.kind = kind;
  f.a = random_point(random);
  f.b = uniform_direction<3>(random);
  f.radius = kind == Facet::Kind::plane ? 0 : random.uniform(0.3, 1);
  if (kind != Facet::Kind::triangle) return f;
  const double size = std::pow(10, random.uniform(-3, 0));
  f.radius = 0;
  f.b = f.a + size * random_point(random);
  f.c = f.a + size * random_point(random);
  if (random.uniform() < 0.2) f.c = f.b + std::pow(10, random.uniform(-17, -5)) * random_point(random);
  return f;
}

enum class Start { anywhere, near_tie, penetrating };
enum class Aim { anywhere, grazing, sliding };

/// A ball with room, or one whose radius is the distance to within a few doubles or a little more; on a way
/// that is free, passes some point of the facet at about its radius, or starts along it. Directions have any
/// length.
Motion random_motion(Random& random, const Facet& f, Start start, Aim aim) {
  Motion m;
  double room = 0;
  do {
    m.c = random_point(random);
    room = distance(f, m.c);
  } while (!(room > 1e-3));
  m.r = room * random.uniform(0.01, 0.9);
  if (start == Start::near_tie) {
    m.r = room;
    for (double k = std::floor(random.uniform(-3, 4)); k != 0; k -= std::copysign(1, k))
      m.r = std::nextafter(m.r, k > 0 ? infinity : 0);
  }
  if (start == Start::penetrating) m.r = room * (1 + std::pow(10, random.uniform(-15, -3)));
  const Vector<3> normal = (m.c - closest_point(f, m.c)).normalized();
  m.direction = uniform_direction<3>(random);
  if (aim == Aim::sliding) m.direction = m.direction.cross(normal).normalized();
  if (aim == Aim::grazing) {
    const Vector<3> to = closest_point(f, random_point(random)) - m.c;
    m.direction = (to + m.r * to.cross(m.direction).normalized()).normalized();
  }
  m.direction *= std::pow(10, random.uniform(-3, 3));
  m.limit = std::pow(10, random.uniform(-2, 0.5)) / m.direction.norm();
  return m;
}

const char* name_of(Facet::Kind kind) {
  constexpr const char* names[] = {"Plane", "Cylinder", "Sphere", "Triangle", "Frustum"};
  return names[static_cast<std::size_t>(kind)];
}

class Levels : public ::testing::TestWithParam<Facet::Kind> {
 protected:
  Tally run(Start start, Aim aim, int trials) {
    Tally tally;
    for (int i = 0; i < trials && !HasFatalFailure(); ++i) {
      Random random(i, stream(Stream::test, 10 * static_cast<int>(start) + static_cast<int>(aim)));
      const Facet f = random_facet(random, GetParam());
      expect_levels(f, random_motion(random, f, start, aim), tally, "trial " + std::to_string(i));
    }
    return tally;
  }
};

TEST_P(Levels, OfABallWithRoom) {
  const Tally tally = run(Start::anywhere, Aim::anywhere, 300);
  EXPECT_GT(tally.free, 20);
  EXPECT_EQ(tally.at_once, 0);
}

TEST_P(Levels, OfABallThatGrazes) {
  const Tally tally = run(Start::anywhere, Aim::grazing, 150);
  EXPECT_GT(tally.limited, 20);
}

TEST_P(Levels, OfABallThatTouchesNearly) {
  const Tally tally = run(Start::near_tie, Aim::anywhere, 150);
  EXPECT_GT(tally.at_once, 20);
  EXPECT_GT(tally.free + tally.limited, 20);
}

TEST_P(Levels, OfABallThatSlides) { run(Start::near_tie, Aim::sliding, 150); }

TEST_P(Levels, OfABallThatPenetrates) {
  const Tally tally = run(Start::penetrating, Aim::anywhere, 100);
  EXPECT_EQ(tally.at_once, 100);
}

INSTANTIATE_TEST_SUITE_P(Walls, Levels,
                         ::testing::Values(Facet::Kind::plane, Facet::Kind::cylinder, Facet::Kind::sphere,
                                           Facet::Kind::triangle),
                         [](const auto& tested) { return std::string(name_of(tested.param)); });

// ---- by name

const Facet floor_triangle{Facet::Kind::triangle, 0, {-1, -1, 0}, {3, -1, 0}, {-1, 3, 0}, 0};

void expect_all(const Facet& f, const Motion& m, double expected) {
  EXPECT_EQ(free_path(f, m, exact_level), expected);
  Tally tally;
  expect_levels(f, m, tally, "");
}

TEST(FreePath, TouchingIsReachedToTheLastBit) {
  expect_all(floor_triangle, {{0, 0, 1}, 0.25, {0, 0, -1}, 10}, 0.75);
  expect_all(floor_triangle, {{0, 0, 1}, 0.25, {0, 0, -4}, 10}, 0.1875);
  // A third is no double: the last one before it.
  const double third = free_path(floor_triangle, {{0, 0, 1}, 0.5, {0, 0, -1.5}, 10}, exact_level);
  EXPECT_EQ(third, 1.0 / 3);  // which is rounded down
  const Facet ball{Facet::Kind::sphere, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 13};
  expect_all(ball, {{0, 0, 0}, 3, {3, 4, 0}, 10}, 2);
}

TEST(FreePath, OfABallThatRestsAlongAndAwayIsNotLimited) {
  expect_all(floor_triangle, {{0, 0, 0.5}, 0.5, {1, 0, 0}, 7}, 7);
  expect_all(floor_triangle, {{0, 0, 0.5}, 0.5, {1, 0, 1e-300}, 7}, 7);
  expect_all(floor_triangle, {{0, 0, 0.5}, 0.5, {1, 0, -1e-17}, 7}, 0);
  expect_all(floor_triangle, {{0, 0, 0.5}, 0.5, {0, 0, -1}, 7}, 0);
}

TEST(FreePath, OfABallThatPenetratesIsNone) {
  const double r = std::nextafter(0.5, 1.0);
  for (const Vector<3>& way : {Vector<3>(0, 0, 1), Vector<3>(1, 0, 0), Vector<3>(0, 0, -1)})
    expect_all(floor_triangle, {{0, 0, 0.5}, r, way, 7}, 0);
}

TEST(FreePath, OfNoWayIsNone) {
  expect_all(floor_triangle, {{0, 0, 1}, 0.5, {0, 0, -1}, 0}, 0);
  for (const WallArithmetic level : {plain, filtered, exact_level})
    EXPECT_EQ(free_path(floor_triangle, {{0, 0, 1}, 0.5, {0, 0, 0}, 3}, level), 3);
}

// Past an edge, over a corner: by exactly r, and by r and a double.
TEST(FreePath, OfATangentPassEndsOnlyWhereItPenetrates) {
  const Facet edge{Facet::Kind::triangle, 0, {0, -4, 0}, {0, 4, 0}, {-5, 0, -1}, 0};
  expect_all(edge, {{-2, 0, 0.5}, 0.5, {1, 0, 0}, 8}, 8);
  const double r = std::nextafter(0.5, 1.0);
  const Motion pass{{-2, 0, 0.5}, r, {1, 0, 0}, 8};
  Tally tally;
  expect_levels(edge, pass, tally, "edge");
  // It meets the edge, half a double deep, about sqrt(2 r · 1e-16) before it stands over it.
  const double t = free_path(edge, pass, exact_level);
  EXPECT_LT(t, 2);
  EXPECT_NEAR(t, 2, 2e-8);
  const Facet corner{Facet::Kind::triangle, 0, {0, 0, 0}, {-1, -5, -4}, {1, -5, -4}, 0};
  expect_all(corner, {{-3, 0, 0.5}, 0.5, {1, 0, 0}, 8}, 8);
  expect_levels(corner, {{-3, 0, 0.5}, r, {1, 0, 0}, 8}, tally, "corner");
  EXPECT_EQ(tally.limited, 2);
}

TEST(FreePath, ThroughATriangleIsStoppedHoweverSmallTheBall) {
  for (const double r : {1e-9, 1e-100, 1e-300}) {
    const double t = free_path(floor_triangle, {{0.1, 0.2, 1}, r, {0, 0, -1}, 10}, exact_level);
    EXPECT_NEAR(t, 1 - r, u) << r;
    EXPECT_LT(t, 1) << r;
    EXPECT_LE(free_path(floor_triangle, {{0.1, 0.2, 1}, r, {0, 0, -1}, 10}, filtered), t);
  }
}

TEST(FreePath, AgainstNeedlesAndWhatHasNoArea) {
  Tally tally;
  for (const double height : {1e-3, 1e-9, 1e-15, 0.0}) {
    const Facet needle{Facet::Kind::triangle, 0, {-1, 0, 0}, {1, 0, 0}, {0.3, height, 0}, 0};
    expect_levels(needle, {{0.1, 1, 0.7}, 0.2, {0, -1, -0.7}, 10}, tally, "needle");
    expect_levels(needle, {{-3, 0.1, 0.01}, 0.2, {1, 0, 0}, 10}, tally, "along the needle");
  }
  const Facet point{Facet::Kind::triangle, 0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0};
  expect_all(point, {{0, 0, 1}, 0.25, {0, 0, -1}, 10}, 0.75);
  EXPECT_EQ(tally.limited, 8);
}

TEST(FreePath, FarFromTheOriginAndTiny) {
  const Vector<3> far(1e6, -2e6, 3e6);
  const Facet moved{Facet::Kind::triangle,  0, far + floor_triangle.a, far + floor_triangle.b,
                    far + floor_triangle.c, 0};
  expect_all(moved, {far + Vector<3>(0, 0, 1), 0.25, {0, 0, -1}, 10}, 0.75);
  Tally tally;
  expect_levels(moved, {far + Vector<3>(0.1, 0.3, 1), 1e-9, {0.3, 0.2, -1}, 10}, tally, "far");
  const double scale = 0x1p-30;
  const Facet tiny{Facet::Kind::triangle,    0, scale * floor_triangle.a, scale * floor_triangle.b,
                   scale * floor_triangle.c, 0};
  expect_all(tiny, {scale * Vector<3>(0, 0, 1), 0.25 * scale, {0, 0, -1}, 10}, 0.75 * scale);
  EXPECT_EQ(tally.limited, 1);
}

TEST(FreePath, WithoutLimitEndsAtTheWallOrNever) {
  const Facet pipe{Facet::Kind::cylinder, 0, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 1};
  const Facet plane{Facet::Kind::plane, 0, {0, 0, 0}, {0, 0, 1}, {0, 0, 0}, 0};
  for (const WallArithmetic level : {filtered, exact_level}) {
    EXPECT_EQ(free_path(pipe, {{0, 0, 0}, 0.25, {0, 0, 1}, infinity}, level), infinity);
    EXPECT_NEAR(free_path(pipe, {{0, 0, 0}, 0.25, {1, 0, 0}, infinity}, level), 0.75, 1e-15);
    EXPECT_EQ(free_path(plane, {{0, 0, 1}, 0.25, {0, 0, 1}, infinity}, level), infinity);
    EXPECT_NEAR(free_path(plane, {{0, 0, 1}, 0.25, {0, 0, -1}, infinity}, level), 0.75, 1e-15);
    EXPECT_EQ(free_path(floor_triangle, {{0, 0, 1}, 0.25, {0, 1, 1}, infinity}, level), infinity);
  }
}

// The integers against CGAL's rationals: a way of no length is a place.
TEST(WayClearsExactly, AsAPlaceDoesByAnotherArithmetic) {
  int clear = 0;
  for (int i = 0; i < 500; ++i) {
    Random random(i, stream(Stream::test, 77));
    const Facet f = random_facet(random, Facet::Kind::triangle);
    const Motion m = random_motion(random, f, Start::near_tie, Aim::anywhere);
    const bool clears = way_clears_exactly({f.a, f.b, f.c}, m, m.r, 0);
    EXPECT_EQ(clears, cad::exactly_clears(m.c, {f.a, f.b, f.c, 0}, m.r)) << i;
    clear += clears;
  }
  EXPECT_GT(clear, 100);
  EXPECT_LT(clear, 400);
}

// ---- in containers

class FreePathIn : public ::testing::TestWithParam<test::ContainerUnderTest> {};

TEST_P(FreePathIn, IsTheLeastOfAllFacetsAtEveryLevel) {
  const auto exact = GetParam().container(exact_level), lower = GetParam().container(filtered),
             rough = GetParam().container(plain);
  int limited = 0;
  for (int i = 0; i < 40; ++i) {
    Random random(i, stream(Stream::test, 5));
    Vector<3> c;
    do {
      c = uniform_point<3>(random, exact->bounds());
    } while (!exact->contains(c, 0.01));
    const double r = exact->clearance(c) * random.uniform(0.1, 0.9);
    const Vector<3> way = std::pow(10, random.uniform(-2, 2)) * uniform_direction<3>(random);
    const double limit = random.uniform(0.05, 2) / way.norm();
    const double t = exact->free_path(c, r, way, limit);
    std::vector<NearFacet> all;
    exact->facets_near(c, infinity, all);
    if (exact->kind() == "mesh") {
      double least = limit;
      for (const NearFacet& n : all)
        least = std::min(least, free_path(n.facet, {c, r, way, limit}, exact_level));
      if (is_repeated_mesh(GetParam().shape))
        EXPECT_NEAR(t, least, 16 * u * (8 / way.norm() + t));  // pieces of a way end at rounded places
      else
        EXPECT_EQ(t, least);
    }
    const double below = lower->free_path(c, r, way, limit);
    EXPECT_LE(below, t);
    EXPECT_GE(below, t - 8 * u * (8 / way.norm() + t));
    EXPECT_EQ(below == limit, t == limit);
    // Where the exact way ends the clearance is the radius, and within its bounds where the plain one does.
    const double end = rough->free_path(c, r, way, limit), bound = rough->free_path_bound(c, r);
    EXPECT_GE(exact->clearance(c + end * way), r - 2 * bound);
    if (t < limit) {
      EXPECT_NEAR(exact->clearance(c + t * way), r, bound);
      ++limited;
    }
    if (end < limit) {
      EXPECT_NEAR(exact->clearance(c + end * way), r, 3 * bound);
    }
  }
  EXPECT_GT(limited, 5);
}

INSTANTIATE_TEST_SUITE_P(Containers, FreePathIn, ::testing::ValuesIn(test::containers_under_test()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace free_path_test
}  // namespace bernal

// Every kernel of kernels/first_contact.hpp against its rule, by bisection and sampling in long double on
// thousands of random motions: free, grazing, resting, sliding and slightly penetrating.
#include "kernels/first_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>

#include "bernal/core/random.hpp"
#include "bernal/domain/facet.hpp"
#include "support/precise_distance.hpp"

namespace bernal {
namespace first_contact_test {

using Real = long double;
using test::Point;

constexpr double infinity = std::numeric_limits<double>::infinity();

// All lengths below are of order 1, so a coordinate is rounded by at most the spacing of doubles at 2.
constexpr double resolution = 2 * std::numeric_limits<double>::epsilon();
// "A few roundoffs of the distances involved": at most 8 resolutions for any formula (core/tolerance.hpp).
constexpr double rounding = 8 * resolution;

/// An obstacle: the kernel under test and the same distance by the oracle.
struct Obstacle {
  bool convex = true;  ///< its distance is a convex function of the centre
  std::function<Real(const Point<Real>&)> distance;
  std::function<Vector<3>(const Vector<3>&)> closest_point;
  std::function<double(const Vector<3>& c, double r, const Vector<3>& direction, double limit, double skin)>
      first_contact;
};

Obstacle obstacle_of(const Facet& f) {
  return {f.kind == Facet::Kind::plane || f.kind == Facet::Kind::triangle,
          [f](const Point<Real>& p) { return test::precise_distance<Real>(f, p); },
          [f](const Vector<3>& p) { return closest_point(f, p); },
          [f](const Vector<3>& c, double r, const Vector<3>& direction, double limit, double skin) {
            return first_contact(f, c, r, direction, limit, skin);
          }};
}

Vector<3> random_point(Random& random) { return uniform_point<3>(random, {{-1, -1, -1}, {1, 1, 1}}); }

Obstacle random_resting_sphere(Random& random) {
  const Vector<3> other = random_point(random);
  return {true, [other](const Point<Real>& p) { return norm(p - Point<Real>(other)); },
          [other](const Vector<3>&) { return other; },
          [other](const Vector<3>& c, double r, const Vector<3>& direction, double limit, double skin) {
            return first_contact<3>(c, direction, limit, other, r, skin);
          }};
}

Obstacle random_plane(Random& random) {
  Facet f;
  f.kind = Facet::Kind::plane;
  f.a = random_point(random);
  f.b = uniform_direction<3>(random);
  return obstacle_of(f);
}

Obstacle random_cylinder(Random& random) {
  Facet f;
  f.kind = Facet::Kind::cylinder;
  f.a = random_point(random);
  f.b = uniform_direction<3>(random);
  f.radius = random.uniform(0.05, 1);
  return obstacle_of(f);
}

Obstacle random_round_wall(Random& random) {
  Facet f;
  f.kind = Facet::Kind::sphere;
  f.a = random_point(random);
  f.radius = random.uniform(0.05, 1);
  return obstacle_of(f);
}

Obstacle random_triangle(Random& random) {
  Facet f;
  f.kind = Facet::Kind::triangle;
  f.a = random_point(random);
  const double size = std::pow(10, random.uniform(-3, 0));
  f.b = f.a + size * random_point(random);
  f.c = f.a + size * random_point(random);
  return obstacle_of(f);
}

struct Motion {
  Vector<3> c;
  double r;
  Vector<3> direction;
  double limit;
  double skin;
};

enum class Start { anywhere, resting, penetrating };
enum class Aim { anywhere, grazing, sliding };

/// A sphere and a direction. A resting sphere has a gap in [skin/2, skin], a penetrating one a slightly
/// negative gap; a grazing direction passes a chosen point of the obstacle at about r + skin, a sliding one
/// is perpendicular to the line to the nearest point.
Motion random_motion(Random& random, const Obstacle& obstacle, Start start, Aim aim) {
  Motion m;
  m.r = std::pow(10, random.uniform(-3, -1.4));
  m.skin = tolerance::skin(m.r, resolution);
  for (;;) {
    m.c = random_point(random);
    const double distance = static_cast<double>(obstacle.distance(m.c));
    if (start == Start::anywhere ? distance > m.r + m.skin : distance > 1e-3) break;
  }
  Vector<3> q = obstacle.closest_point(m.c);
  const Vector<3> normal = (m.c - q).normalized();
  if (start == Start::resting) m.c = q + (m.r + random.uniform(0.55, 1.0) * m.skin) * normal;
  if (start == Start::penetrating) m.c = q + m.r * (1 - std::pow(10, random.uniform(-9, -2))) * normal;

  m.direction = uniform_direction<3>(random);
  if (aim == Aim::sliding) m.direction = m.direction.cross(normal).normalized();
  if (aim == Aim::grazing) {
    q = obstacle.closest_point(random_point(random));
    const Vector<3> to_q = q - m.c;
    const Vector<3> across = to_q.cross(m.direction).normalized();
    m.direction = (to_q + (m.r + random.uniform(0, 1.5) * m.skin) * across).normalized();
  }
  m.limit = std::pow(10, random.uniform(-3, 0.5));
  // Often the way ends just where it becomes interesting: at a gap between the skin and none.
  if (random.uniform() < 0.3)
    m.limit =
        obstacle.first_contact(m.c, m.r, m.direction, m.limit, m.skin) + random.uniform(0, 1.5) * m.skin;
  return m;
}

/// Where a convex function is least on [low, high].
Real least_at(const std::function<Real(Real)>& f, Real low, Real high) {
  for (int k = 0; k < 120; ++k) {
    const Real a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (f(a) < f(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

struct Tally {
  int limited = 0, free = 0, at_once = 0;
};

/// The rule of kernels/first_contact.hpp, word by word.
void expect_rule(const Obstacle& obstacle, const Motion& m, Tally& tally, const std::string& what) {
  const auto gap = [&](Real t) {
    return obstacle.distance(Point<Real>(m.c) + t * Point<Real>(m.direction)) - m.r;
  };
  const double answer = obstacle.first_contact(m.c, m.r, m.direction, m.limit, m.skin);
  ASSERT_GE(answer, 0) << what;
  ASSERT_LE(answer, m.limit) << what;
  (answer == 0 ? tally.at_once : answer < m.limit ? tally.limited : tally.free) += 1;

  // The invariant, on the whole way: a convex gap is least somewhere, a concave one at an end.
  const Real start = gap(0);
  const Real floor = std::min(start, Real(m.skin) / 2) - rounding;
  ASSERT_GE(gap(answer), floor) << what;
  if (obstacle.convex) {
    ASSERT_GE(gap(least_at(gap, 0, answer)), floor) << what;
  }

  // It stops only for something that would come too near...
  if (answer == m.limit) return;
  Real low = answer, high = obstacle.convex ? least_at(gap, answer, m.limit) : Real(m.limit);
  ASSERT_LT(gap(high), m.skin / 2 + m.skin / 32 + rounding) << what << ": nothing there";

  // ... and no earlier than at the skin: the answer is where bisection finds the last gap of `skin`.
  if (start < m.skin && gap(answer) < m.skin) {
    // It rests or penetrates, and no place on the way is free.
    if (obstacle.convex) {
      EXPECT_EQ(answer, 0) << what;
    } else {
      const Real further = answer + 1e-3L * m.limit;
      EXPECT_TRUE(gap(further) <= gap(answer) + rounding) << what << ": the gap still grows";
    }
    return;
  }
  low = answer;
  for (int k = 0; k < 100; ++k) (gap((low + high) / 2) < m.skin ? high : low) = (low + high) / 2;
  EXPECT_NEAR(static_cast<double>(gap(answer)), m.skin, m.skin / 32 + rounding) << what;
  EXPECT_NEAR(static_cast<double>(gap(high)), m.skin, rounding) << what;
}

using MakeObstacle = Obstacle (*)(Random&);

struct NamedKernel {
  const char* name;
  MakeObstacle make;
  friend void PrintTo(const NamedKernel& kernel, std::ostream* out) { *out << kernel.name; }
};

class FirstContact : public ::testing::TestWithParam<NamedKernel> {
 protected:
  Tally run(Start start, Aim aim, int trials) {
    Tally tally;
    for (int i = 0; i < trials && !HasFailure(); ++i) {
      Random random(i, stream(Stream::test, 10 * static_cast<int>(start) + static_cast<int>(aim)));
      const Obstacle obstacle = GetParam().make(random);
      const Motion motion = random_motion(random, obstacle, start, aim);
      expect_rule(obstacle, motion, tally, "trial " + std::to_string(i));
    }
    return tally;
  }
};

TEST_P(FirstContact, OfASphereAnywhere) {
  const Tally tally = run(Start::anywhere, Aim::anywhere, 3000);
  EXPECT_GT(tally.free, 100);
}

TEST_P(FirstContact, OfAGrazingSphere) {
  const Tally tally = run(Start::anywhere, Aim::grazing, 3000);
  EXPECT_GT(tally.limited, 100);
}

TEST_P(FirstContact, OfARestingSphere) {
  const Tally tally = run(Start::resting, Aim::anywhere, 3000);
  EXPECT_GT(tally.at_once, 1000);
  EXPECT_GT(tally.free + tally.limited, 1000);
}

TEST_P(FirstContact, OfASlidingSphere) {
  const Tally tally = run(Start::resting, Aim::sliding, 3000);
  // A straight line along a convex obstacle leads away from it.
  if (GetParam().make == random_plane || GetParam().make == random_triangle ||
      GetParam().make == random_resting_sphere) {
    EXPECT_EQ(tally.free, 3000);
  }
}

TEST_P(FirstContact, OfAPenetratingSphere) {
  const Tally tally = run(Start::penetrating, Aim::anywhere, 3000);
  EXPECT_GT(tally.at_once, 1000);
  EXPECT_GT(tally.free + tally.limited, 1000);
}

INSTANTIATE_TEST_SUITE_P(Kernels, FirstContact,
                         ::testing::Values(NamedKernel{"Sphere", random_resting_sphere},
                                           NamedKernel{"Plane", random_plane},
                                           NamedKernel{"Cylinder", random_cylinder},
                                           NamedKernel{"RoundWall", random_round_wall},
                                           NamedKernel{"Triangle", random_triangle}),
                         [](const auto& kernel) { return std::string(kernel.param.name); });

// What a rolling sphere does all the time: it arrives, stops, turns and goes on. The invariant must not wear
// away with repetition.
TEST(FirstContactForEver, AThousandTurnsNeverEatUpTheSkin) {
  Random random(1, stream(Stream::test, 77));
  for (int trial = 0; trial < 20; ++trial) {
    const double r = random.uniform(0.01, 0.1), skin = tolerance::skin(r, resolution);
    const Vector<3> other = random_point(random);
    Facet round;
    round.kind = Facet::Kind::sphere;
    round.a = other;
    round.radius = 6 * r;
    Vector<3> c = other + Vector<3>(3 * r, 0, 0);
    int stops = 0;
    for (int move = 0; move < 1000; ++move) {
      const Vector<3> direction = uniform_direction<3>(random);
      double limit = r;
      limit = first_contact<3>(c, direction, limit, other, 2 * r, skin);
      limit = first_contact(round, c, r, direction, limit, skin);
      stops += limit < r;
      c += limit * direction;
      ASSERT_GE(norm(Point<Real>(c) - Point<Real>(other)) - 2 * r, skin / 2 - 2 * rounding);
      ASSERT_GE(test::precise_distance<Real>(round, c) - r, skin / 2 - 2 * rounding);
    }
    EXPECT_GT(stops, 100);
  }
}

TEST(FirstContactOfSpheres, InOtherDimensionsIsTheSameOnALine) {
  for (const double limit : {0.5, 1.0, 5.0, infinity}) {
    const double expected = std::min(limit, 2 - 1e-9);
    EXPECT_NEAR(first_contact<2>({0, 0}, {1, 0}, limit, {3, 0}, 1, 1e-9), expected, 1e-15);
    EXPECT_NEAR(first_contact<3>({0, 0, 0}, {1, 0, 0}, limit, {3, 0, 0}, 1, 1e-9), expected, 1e-15);
    EXPECT_NEAR(
        first_contact<5>(Vector<5>::Zero(), Vector<5>::UnitX(), limit, 3 * Vector<5>::UnitX(), 1, 1e-9),
        expected, 1e-15);
  }
}

TEST(FirstContactInfinity, AnEndlessLimitIsAllowed) {
  const Vector<3> c(0, 0, 0), z(0, 0, 1), x(1, 0, 0);
  EXPECT_EQ(first_contact_with_plane(c, 0.1, z, infinity, {0, 0, -1}, z, 1e-9), infinity);
  EXPECT_NEAR(first_contact_with_plane(c, 0.1, -z, infinity, {0, 0, -1}, z, 1e-9), 0.9 - 1e-9, 1e-15);
  EXPECT_EQ(first_contact_inside_cylinder(c, 0.1, z, infinity, c, z, 1, 1e-9), infinity);
  EXPECT_NEAR(first_contact_inside_cylinder(c, 0.1, x, infinity, c, z, 1, 1e-9), 0.9 - 1e-9, 1e-15);
  EXPECT_NEAR(first_contact_inside_sphere(c, 0.1, x, infinity, c, 1, 1e-9), 0.9 - 1e-9, 1e-15);
  EXPECT_EQ(first_contact_with_triangle(c, 0.1, -x, infinity, {1, -1, -1}, {1, 1, -1}, {1, 0, 1}, 1e-9),
            infinity);
  EXPECT_NEAR(first_contact_with_triangle(c, 0.1, x, infinity, {1, -1, -1}, {1, 1, -1}, {1, 0, 1}, 1e-9),
              0.9 - 1e-9, 1e-10);
}

// A sphere as large as its round container stays where it is and does not slip out.
TEST(FirstContactInside, ASphereThatDoesNotFitMovesToTheMiddleAndNoFurther) {
  const Vector<3> origin = Vector<3>::Zero(), x = Vector<3>::UnitX();
  for (const double r : {1.0, 1.0 - 1e-10, 1.5}) {
    EXPECT_EQ(first_contact_inside_sphere(origin, r, x, 1, origin, 1, 1e-9), 0);
    EXPECT_NEAR(first_contact_inside_sphere(-0.01 * x, r, x, 1, origin, 1, 1e-9), 0.01, 1e-9);
    EXPECT_EQ(first_contact_inside_sphere(0.01 * x, r, x, 1, origin, 1, 1e-9), 0);
  }
}

}  // namespace first_contact_test
}  // namespace bernal

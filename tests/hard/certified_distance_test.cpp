// The bounds of a point's distance from a triangle against rational arithmetic, on triangles of every bad
// shape.
#include "cad/certified_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/random.hpp"
#include "bernal/core/tolerance.hpp"

namespace bernal::cad {
namespace certified_distance_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector<3> random_vector(Random& random) {
  return Vector<3>(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

/// From well shaped to a needle or a cap without area, anywhere within `offset` of the origin.
WallTriangle random_triangle(Random& random, double offset) {
  const Vector<3> a = offset * random_vector(random), along = random_vector(random);
  const double thin = std::pow(10, random.uniform(-17, 0));
  return {a, a + along, a + random.uniform(-0.5, 1.5) * along + thin * random_vector(random), 0};
}

TEST(CertifiedDistance, BoundsHoldTheExactValue) {
  Random random(1, 0);
  for (int i = 0; i < 3000; ++i) {
    const WallTriangle t = random_triangle(random, std::pow(10, random.uniform(-3, 6)));
    const Vector<3> near = t.a + random.uniform() * (t.b - t.a);
    const Vector<3> p = near + std::pow(10, random.uniform(-15, 1)) * random_vector(random);
    const DistanceBounds bounds = bound_distance(p, t);
    ASSERT_LE(bounds.lower, bounds.upper);
    EXPECT_TRUE(exactly_clears(p, t, bounds.lower)) << "lower bound above the distance";
    EXPECT_FALSE(exactly_clears(p, t, std::nextafter(bounds.upper, infinity))) << "upper bound below it";
  }
}

// Near the unit cube the bounds are tight enough to decide all but ties.
TEST(CertifiedDistance, BoundsAreTightOnGoodTriangles) {
  Random random(2, 0);
  for (int i = 0; i < 3000; ++i) {
    const WallTriangle t = {random_vector(random) + Vector<3>(4, 0, 0),
                            random_vector(random) + Vector<3>(0, 4, 0),
                            random_vector(random) + Vector<3>(0, 0, 4), 0};
    const Vector<3> p = random_vector(random);
    const DistanceBounds bounds = bound_distance(p, t);
    // Each bound is widened by six roundoffs of the farthest vertex and eight of itself; the guesses add a
    // few.
    const double farthest = std::max({(p - t.a).norm(), (p - t.b).norm(), (p - t.c).norm()});
    EXPECT_LE(bounds.upper - bounds.lower, 20 * tolerance::roundoff * (farthest + bounds.upper));
  }
}

TEST(CertifiedDistance, DecisionsAreTheExactOnesAtTies) {
  Random random(3, 0);
  int clears = 0;
  for (int i = 0; i < 500; ++i) {
    const WallTriangle t = random_triangle(random, 1);
    const Vector<3> p = t.a + random_vector(random);
    const DistanceBounds bounds = bound_distance(p, t);
    double r = bounds.lower + random.uniform() * (bounds.upper - bounds.lower);
    for (int k = 0; k < 3; ++k, r = std::nextafter(r, infinity)) {
      EXPECT_EQ(certainly_clears(p, t, r), exactly_clears(p, t, r));
      clears += exactly_clears(p, t, r);
    }
  }
  EXPECT_GT(clears, 100);
  EXPECT_LT(clears, 1400);
}

TEST(CertifiedDistance, APointOnTheTriangleTouchesIt) {
  const WallTriangle t = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0};
  for (const Vector<3>& p : {Vector<3>(0.25, 0.25, 0), Vector<3>(0.5, 0.5, 0), Vector<3>(1, 0, 0)}) {
    EXPECT_EQ(bound_distance(p, t).lower, 0);
    EXPECT_TRUE(certainly_clears(p, t, 0));
    EXPECT_FALSE(certainly_clears(p, t, 1e-300));
  }
}

}  // namespace certified_distance_test
}  // namespace bernal::cad

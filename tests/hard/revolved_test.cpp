// Solids of revolution: millions of decisions at ties, profiles on the axis, flat cones, needles, and the
// certificate against an oracle of a hundred digits.
#include <gtest/gtest.h>

#include <atomic>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"
#include "bernal/verify/certificate.hpp"
#include "core/parallel.hpp"
#include "domain/free_path.hpp"
#include "support/containers.hpp"
#include "support/precise_distance.hpp"

namespace bernal {
namespace revolved_test {

using Real = boost::multiprecision::cpp_bin_float_100;
using test::Point;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Shape {
  std::string name;
  Revolved solid;
};

std::vector<Shape> shapes() {
  return {
      {"Cylinder", {.profile = {{0, 0}, {1, 0}, {1, 2}, {0, 2}}}},
      {"NeedleTip", {.profile = {{0, 0}, {1e-3, 1}, {0, 1}}}},
      {"FlatCone", {.profile = {{0, 0}, {1, 1e-6}, {0, 1}}}},
      {"ObliqueFrustum", {{1, 2, 3}, {1, -2, 0.5}, {{0, 0}, {0.4, 0}, {1, 1.2}, {0, 1.2}}}},
      {"Tube", {.profile = {{0.4, 0}, {1, 0}, {1, 1.6}, {0.4, 1.6}}}},
      {"ThreadThinTube", {.profile = {{0x1p-20, 0}, {1, 0}, {1, 1}, {0x1p-20, 1}}}},
      {"HourglassOfAHairsNeck", {.profile = {{0, -1}, {1, -1}, {1e-9, 0}, {1, 1}, {0, 1}}}},
      {"Hopper", {.profile = {{0, 0}, {0.2, 0}, {0.2, 0.2}, {1, 1}, {1, 2}, {0, 2}}}},
      {"ObliqueFlaskFarAway",
       {{300, -200, 500}, {1, 1, 3}, {{0, 2}, {0.25, 2}, {0.3, 1.2}, {1, 0.6}, {0.9, 0}, {0, 0.2}}}},
      {"KnifeEdges", {.profile = {{0.5, 0}, {1, 0.5}, {0.5, 1}, {0.75, 0.5}}}},
  };
}

/// Distance from the wall by its definition.
template <class R>
R distance_from(const Revolved& s, const Point<R>& p) {
  const Point<R> axis(s.axis), w = p - Point<R>(s.base);
  const Point<R> at(norm(cross(w, axis)) / norm(axis), dot(w, axis) / norm(axis), R(0));
  R least = R(1e300);
  s.for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
    const R d = norm(test::precise_offset(at, Point<R>(a[0], a[1], 0), Point<R>(b[0], b[1], 0)));
    if (d < least) least = d;
  });
  return least;
}

Vector<3> point_of(const Revolved& s, double r, double z, double angle) {
  const Vector<3> axis = s.axis.normalized(), u = axis.unitOrthogonal();
  return s.base + z * axis + r * (std::cos(angle) * u + std::sin(angle) * axis.cross(u));
}

/// Anywhere, or near a wall, on the axis, at the height of a corner, or beside an end of an edge.
Vector<3> place_in(const Revolved& s, Random& random, int kind) {
  const Bounds<3> bounds = bounds_of(Domain(s));
  const auto n = s.profile.size();
  const Vector<2>& corner = s.profile[static_cast<std::size_t>(random.uniform() * static_cast<double>(n))];
  const double angle = 2 * std::numbers::pi * random.uniform();
  const double off = std::pow(10, random.uniform(-16, -1));
  switch (kind % 4) {
    case 0:
      return uniform_point<3>(random, bounds);
    case 1:
      return point_of(s, 0, random.uniform(-1, 2), 0);
    case 2:
      return point_of(s, random.uniform(), corner[1], angle);
    default:
      return point_of(s, std::abs(corner[0] + random.uniform(-1, 1) * off),
                      corner[1] + random.uniform(-1, 1) * off, angle);
  }
}

TEST(RevolvedAtTies, FilteredDecidesAsExactAMillionTimes) {
  constexpr std::size_t places = 12'500, radii = 9;
  std::atomic<std::uint64_t> decided = 0, differences = 0, inside = 0;
  for (const Shape& shape : shapes()) {
    const double resolution = std::numeric_limits<double>::epsilon();
    const auto filtered = make_analytic_container(shape.solid, WallArithmetic::filtered, resolution),
               exact = make_analytic_container(shape.solid, WallArithmetic::exact, resolution);
    parallel_for(places, [&](std::size_t k) {
      Random random(k, stream(Stream::test, 3));
      const Vector<3> c = place_in(shape.solid, random, static_cast<int>(k));
      double r = std::max(0.0, filtered->clearance(c));
      for (int step = 0; step < 4; ++step) r = r > 0 ? std::nextafter(r, 0) : 0;
      for (std::size_t step = 0; step < radii; ++step, r = std::nextafter(r, infinity)) {
        const bool answer = exact->contains(c, r);
        differences += filtered->contains(c, r) != answer;
        inside += answer;
        ++decided;
      }
    });
  }
  EXPECT_GE(decided, 1'000'000u);
  EXPECT_EQ(differences, 0u);
  EXPECT_GT(inside, 100'000u);
  EXPECT_LT(inside, 900'000u);
}

// The exact decision against a hundred digits: where these tell, they say the same.
TEST(RevolvedAtTies, ExactIsAsAHundredDigitsSay) {
  int told = 0;
  for (const Shape& shape : shapes()) {
    std::vector<Facet> all;
    for (int k = 0; k < 400; ++k) {
      Random random(k, stream(Stream::test, 4));
      const Vector<3> c = place_in(shape.solid, random, k);
      const auto exact = make_analytic_container(shape.solid, WallArithmetic::exact, 1e-16);
      if (!exact->contains(c, 0)) continue;
      const Real distance = distance_from<Real>(shape.solid, Point<Real>(c));
      double r = static_cast<double>(distance);
      for (int step = 0; step < 3; ++step) r = std::nextafter(r, 0);
      for (int step = 0; step < 6; ++step, r = std::nextafter(r, infinity)) {
        if (abs(distance - Real(r)) < Real("1e-80")) continue;
        EXPECT_EQ(exact->contains(c, r), distance > Real(r)) << shape.name << " " << k;
        ++told;
      }
    }
  }
  EXPECT_GT(told, 5000);
}

// The certificate decides by its own predicates, and as the packer's exact walls do.
TEST(RevolvedAtTies, TheCertificateAgreesWithTheExactWalls) {
  int certified = 0, refused = 0;
  for (const Shape& shape : shapes()) {
    const auto exact = make_analytic_container(shape.solid, WallArithmetic::exact, 1e-16);
    for (int k = 0; k < 400; ++k) {
      Random random(k, stream(Stream::test, 5));
      const Vector<3> c = place_in(shape.solid, random, k);
      double r = std::abs(exact->clearance(c));
      for (int step = 0; step < 2; ++step) r = std::nextafter(r, 0);
      for (int step = 0; step < 5; ++step, r = std::nextafter(r, infinity)) {
        if (!(r > 0)) continue;
        Spheres<dynamic> one(3);
        one.push_back(Vector<dynamic>(c), r);
        for (const Arithmetic arithmetic : {Arithmetic::filtered, Arithmetic::exact}) {
          const bool is_certified = certify(one, shape.solid, {.arithmetic = arithmetic}).certified;
          ASSERT_EQ(is_certified, exact->contains(c, r)) << shape.name << " " << k << " r = " << r;
          (is_certified ? certified : refused) += 1;
        }
      }
    }
  }
  EXPECT_GT(certified, 5000);
  EXPECT_GT(refused, 5000);
}

// A gap is known of every ball, however far from the wall.
TEST(RevolvedCertificate, TheLeastGapToTheWallIsThatOfTheClearance) {
  for (const Shape& shape : shapes()) {
    const auto walls = make_analytic_container(shape.solid, WallArithmetic::exact, 1e-16);
    Random random(7, stream(Stream::test));
    for (int k = 0; k < 100; ++k) {
      const Vector<3> c = uniform_point<3>(random, bounds_of(Domain(shape.solid)));
      const double clearance = walls->clearance(c);
      if (!(clearance > 1e-6)) continue;
      const double r = clearance * random.uniform(1e-3, 0.999);
      Spheres<dynamic> one(3);
      one.push_back(Vector<dynamic>(c), r);
      const Certificate certificate = certify(one, shape.solid);
      EXPECT_TRUE(certificate.certified) << shape.name;
      EXPECT_GT(certificate.walls_tested, 0u) << shape.name;
      EXPECT_NEAR(certificate.min_wall_gap, (clearance - r) / r, 1e-9 * (clearance / r)) << shape.name;
    }
  }
}

// Where the exact way ends the next double is past the contact, and before it all is clear.
TEST(RevolvedWays, EndWhereTheBallTouches) {
  int limited = 0, far = 0;
  for (const Shape& shape : shapes()) {
    const auto exact = make_analytic_container(shape.solid, WallArithmetic::exact, 1e-16),
               filtered = make_analytic_container(shape.solid, WallArithmetic::filtered, 1e-16);
    for (int k = 0; k < 300; ++k) {
      Random random(k, stream(Stream::test, 6));
      const Vector<3> c = uniform_point<3>(random, bounds_of(Domain(shape.solid)));
      const double clearance = exact->clearance(c);
      if (!(clearance > 1e-5)) continue;
      const double r = clearance * (k % 3 == 0 ? 1 - 1e-9 : random.uniform(0.05, 0.95));
      const Vector<3> way = std::pow(10, random.uniform(-2, 2)) * uniform_direction<3>(random);
      const double limit = random.uniform(0.05, 4) / way.norm();
      const double t = exact->free_path(c, r, way, limit), below = filtered->free_path(c, r, way, limit);
      const auto gap = [&](const Real& at) {
        return distance_from<Real>(shape.solid, Point<Real>(c) + at * Point<Real>(way)) - Real(r);
      };
      EXPECT_LE(below, t) << shape.name << " " << k;
      EXPECT_EQ(below == limit, t == limit) << shape.name << " " << k;
      EXPECT_GE(below, t - 1e-13 * (1 / way.norm() + t)) << shape.name << " " << k;
      constexpr int looks = 40;
      for (int n = 0; n <= looks; ++n)
        ASSERT_GE(gap(Real(t) * n / looks), Real(-1e-60)) << shape.name << " " << k << " of " << n;
      if (t == limit) {
        ++far;
        continue;
      }
      ++limited;
      EXPECT_LT(gap(Real(std::nextafter(t, infinity))), 0) << shape.name << " " << k;
    }
  }
  EXPECT_GT(limited, 800);
  EXPECT_GT(far, 100);
}

TEST(RevolvedProfiles, ThatAreNoneAreRefusedWithOneLine) {
  const auto error_of = [](std::vector<Vector<2>> profile) {
    try {
      require_profile({.profile = std::move(profile)});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), "");
  EXPECT_NE(error_of({{0, 0}, {-1, 0}, {1, 1}}).find("r >= 0"), std::string::npos);
  EXPECT_NE(error_of({{0, 0}, {1, 1}, {1, 0}, {0, 1}}).find("meet at about"), std::string::npos);
  EXPECT_NE(error_of({{0, 0}, {1, 1}}).find("needs three"), std::string::npos);
  EXPECT_NE(error_of({{0, 0}, {1, infinity}, {0, 1}}).find("finite"), std::string::npos);
}

}  // namespace revolved_test
}  // namespace bernal

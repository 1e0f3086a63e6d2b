// Triangles that break textbook formulas: needles and caps down to heights of 1e-16 of their length,
// collinear and coinciding vertices. The oracle has fifty digits.
#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <string>

#include "bernal/core/random.hpp"
#include "kernels/closest_point.hpp"
#include "kernels/first_contact.hpp"
#include "support/precise_distance.hpp"

namespace bernal {
namespace sliver_test {

using Real = boost::multiprecision::cpp_bin_float_50;
using test::Point;
using Triangle = std::array<Vector<3>, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();

enum class Form { needle, cap, collinear, coinciding };

/// A triangle of length about 1 and height 10^-k in a random place, its vertices in random order.
/// needle: two vertices meet; cap: all angles near 0 or 180 degrees.
Triangle sliver(Random& random, Form form, int k) {
  const Vector<3> start = uniform_point<3>(random, {{-1, -1, -1}, {1, 1, 1}});
  const Vector<3> along = uniform_direction<3>(random) * random.uniform(0.3, 1);
  const Vector<3> up = along.unitOrthogonal() * std::pow(10, -k);
  Triangle t{start, start + along, start};
  if (form == Form::needle) t[2] = t[random() % 2] + up + random.uniform(-1, 1) * std::pow(10, -k) * along;
  if (form == Form::cap) t[2] = start + random.uniform(0.1, 0.9) * along + up;
  if (form == Form::collinear) t[2] = start + 0.5 * along;
  if (form == Form::coinciding) t[2] = t[random() % 2];
  for (int i = 2; i > 0; --i) std::swap(t[i], t[random() % (i + 1)]);
  return t;
}

Point<Real> precise_offset_of(const Triangle& t, const Point<Real>& p) {
  return test::precise_offset<Real>(p, t[0], t[1], t[2]);
}

/// Where on the way the distance, a convex function, is least; to be evaluated precisely by the caller.
double least_at(const Triangle& t, const Vector<3>& c, const Vector<3>& direction, double way) {
  const PreparedTriangle triangle(t[0], t[1], t[2]);
  double low = 0, high = way;
  for (int k = 0; k < 80; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (triangle.offset(c + a * direction).norm() < triangle.offset(c + b * direction).norm()) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

class Slivers : public ::testing::TestWithParam<Form> {
 protected:
  template <class Check>
  void for_many(Check check) {
    for (int k = 0; k <= 16; ++k) {
      for (int i = 0; i < 60 && !HasFatalFailure(); ++i) {
        SCOPED_TRACE("height 1e-" + std::to_string(k) + ", trial " + std::to_string(i));
        Random random(i, stream(Stream::test, 100 * static_cast<int>(GetParam()) + k));
        check(sliver(random, GetParam(), k), random);
      }
    }
  }

  /// A point near the triangle, at a distance of any magnitude, above the face, an edge or a corner.
  static Vector<3> random_point(Random& random, const Triangle& t) {
    const double u = random.uniform(-0.2, 1.2), v = random.uniform(-0.2, 1.2);
    const Vector<3> q = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
    return q + std::pow(10, random.uniform(-12, 0.5)) * uniform_direction<3>(random);
  }
};

// "A few roundoffs of |p - corner| + |base|", both at most 5 here.
TEST_P(Slivers, TheDistanceIsRightToRounding) {
  double worst = 0;
  for_many([&](const Triangle& t, Random& random) {
    const Vector<3> p = random_point(random, t);
    const double distance = PreparedTriangle(t[0], t[1], t[2]).offset(p).norm();
    const Real precise = norm(precise_offset_of(t, p));
    const double lengths = (p - t[0]).norm() + (t[1] - t[0]).norm() + (t[2] - t[0]).norm();
    worst = std::max(worst, std::abs(static_cast<double>(distance - precise)) / lengths);
    const Vector<3> q = closest_point_of_triangle(p, t[0], t[1], t[2]);
    EXPECT_LE(norm(precise_offset_of(t, q)), 1e-14) << "not on the triangle";
    EXPECT_LE(abs(norm(Point<Real>(p) - Point<Real>(q)) - precise), 1e-14) << "not the nearest point";
  });
  RecordProperty("worst_error_in_roundoffs_of_the_lengths", std::to_string(worst / tolerance::roundoff));
  EXPECT_LE(worst, 4 * tolerance::roundoff);
}

// What Newton's method for a moving sphere rests on: the plane across the offset has the triangle behind it.
// An offset wrong by some roundoffs of the lengths turns by that over the distance, and the far corners with
// it.
TEST_P(Slivers, TheOffsetSupportsTheTriangle) {
  for_many([&](const Triangle& t, Random& random) {
    const Vector<3> p = random_point(random, t);
    const Vector<3> offset = PreparedTriangle(t[0], t[1], t[2]).offset(p);
    const double distance = offset.norm();
    if (distance < 1e-14) return;
    const Point<Real> n = Real(1 / Real(distance)) * Point<Real>(offset);
    for (const Vector<3>& v : t) {
      const double behind = static_cast<double>(dot(n, Point<Real>(p) - Point<Real>(v)) - distance);
      EXPECT_GE(behind, -8 * tolerance::roundoff * (1 + (p - v).norm()) * (1 + 1 / distance));
    }
  });
}

TEST_P(Slivers, AMovingSphereNeverComesNearerThanHalfTheSkin) {
  int limited = 0, free = 0;
  for_many([&](const Triangle& t, Random& random) {
    const double r = std::pow(10, random.uniform(-4, -0.5));
    const double skin = tolerance::skin(r, 4.5e-16);
    Vector<3> c = random_point(random, t);
    Vector<3> offset = PreparedTriangle(t[0], t[1], t[2]).offset(c);
    if (offset.norm() == 0) return;
    c += (r + 2 * skin) * offset.normalized();
    offset = PreparedTriangle(t[0], t[1], t[2]).offset(c);  // the first was too short for a sharp direction
    c += (r + 2 * skin - offset.norm()) * offset.normalized();
    for (int move = 0; move < 4; ++move) {
      // Towards the triangle, then on along it and away from it.
      offset = PreparedTriangle(t[0], t[1], t[2]).offset(c).normalized();
      Vector<3> direction = uniform_direction<3>(random);
      if (move == 2) direction = direction.cross(offset).normalized();
      if (direction.dot(offset) > 0 && move < 2) direction = -direction;
      const double limit = random.uniform(0, 1);
      const double answer = first_contact_with_triangle(c, r, direction, limit, t[0], t[1], t[2], skin);
      for (const double way : {least_at(t, c, direction, answer), answer}) {
        const Point<Real> p = Point<Real>(c) + Real(way) * Point<Real>(direction);
        ASSERT_GE(static_cast<double>(norm(precise_offset_of(t, p)) - r - Real(skin) / 2), -1e-14)
            << "move " << move << " after " << way << " of " << answer;
      }
      (answer < limit ? limited : free) += 1;
      c += answer * direction;
    }
  });
  EXPECT_GT(limited, 500);
  EXPECT_GT(free, 500);
}

// A small sphere rests and glides, or sinks by next to nothing, over the whole length of the triangle: the
// slope is known to some roundoffs of length / r, and over a long way that is more than the skin.
TEST_P(Slivers, ASmallSphereGlidesFar) {
  int went = 0;
  for_many([&](const Triangle& t, Random& random) {
    const double r = std::pow(10, random.uniform(-4, -3)), skin = tolerance::skin(r, 4.5e-16);
    const PreparedTriangle triangle(t[0], t[1], t[2]);
    Vector<3> c = t[0] + 1e-3 * uniform_direction<3>(random);
    for (int k = 0; k < 3; ++k) {
      const Vector<3> offset = triangle.offset(c);
      c += (r + random.uniform(0.5, 0.6) * skin - offset.norm()) * offset.normalized();
    }
    const Vector<3> normal = triangle.offset(c).normalized();
    const Vector<3> far = (t[1] - c).norm() > (t[2] - c).norm() ? t[1] : t[2];
    Vector<3> direction = far - c;
    direction -= (direction.dot(normal) + random.uniform(0, 2e-12)) * normal;
    direction.normalize();
    if (norm(precise_offset_of(t, c)) - r < skin / 2) return;
    const double answer = first_contact_with_triangle(c, r, direction, 1, t[0], t[1], t[2], skin);
    went += answer == 1;
    for (const double way : {least_at(t, c, direction, answer), answer, 0.5 * answer}) {
      const Point<Real> p = Point<Real>(c) + Real(way) * Point<Real>(direction);
      ASSERT_GE(static_cast<double>(norm(precise_offset_of(t, p)) - r - Real(skin) / 2), -1e-15)
          << "after " << way << " of " << answer;
    }
  });
  EXPECT_GT(went, 50);
}

// What rests on a sliver can leave it.
TEST_P(Slivers, ARestingSphereLeaves) {
  for_many([&](const Triangle& t, Random& random) {
    const double r = std::pow(10, random.uniform(-3, -0.5)), skin = tolerance::skin(r, 4.5e-16);
    Vector<3> c = random_point(random, t);
    const Vector<3> away = PreparedTriangle(t[0], t[1], t[2]).offset(c);
    if (away.norm() < r + skin) return;
    c += first_contact_with_triangle(c, r, -away.normalized(), infinity, t[0], t[1], t[2], skin) *
         -away.normalized();
    const Vector<3> normal = PreparedTriangle(t[0], t[1], t[2]).offset(c).normalized();
    Vector<3> direction = uniform_direction<3>(random);
    if (direction.dot(normal) < 0) direction = -direction;
    EXPECT_EQ(first_contact_with_triangle(c, r, direction, 1, t[0], t[1], t[2], skin), 1);
  });
}

std::string name_of(const ::testing::TestParamInfo<Form>& form) {
  constexpr std::array names = {"Needles", "Caps", "Collinear", "Coinciding"};
  return names[static_cast<int>(form.param)];
}

INSTANTIATE_TEST_SUITE_P(All, Slivers,
                         ::testing::Values(Form::needle, Form::cap, Form::collinear, Form::coinciding),
                         name_of);

TEST(SliverOfNoLength, ATriangleThatIsAPointIsAPoint) {
  const Vector<3> v(1, 2, 3), p(1, 2, 7);
  EXPECT_EQ(closest_point_of_triangle(p, v, v, v), v);
  EXPECT_EQ(first_contact_with_triangle(p, 1, {0, 0, 1}, 5, v, v, v, 1e-9), 5);
  EXPECT_NEAR(first_contact_with_triangle(p, 1, {0, 0, -1}, 5, v, v, v, 1e-9), 3 - 1e-9, 1e-10);
}

}  // namespace sliver_test
}  // namespace bernal

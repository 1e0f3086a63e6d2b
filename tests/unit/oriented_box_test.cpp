#include "cad/oriented_box.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bernal/core/random.hpp"
#include "cad/wall_triangle.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {
namespace oriented_box_test {

using cad::OrientedBox;
using cad::WallTriangle;

struct Piece {
  WallTriangle wall;
  const WallTriangle& triangle() const { return wall; }
};

/// A piece of a surface that bends, about a place, so many times narrower than it is long; `bend` 0: in a
/// plane.
std::vector<Piece> piece_of_wall(Random& random, const Vector<3>& place, double size, double bend,
                                 double narrow) {
  const Bounds<3> around{-Vector<3>::Ones(), Vector<3>::Ones()};
  const Vector<3> n = uniform_point<3>(random, around).normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  const auto corner = [&] {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
    return Vector<3>(place + size * (x * u + narrow * y * v + bend * (x * x + y * y) * n));
  };
  std::vector<Piece> piece;
  for (std::uint32_t k = 0; k < 12; ++k) piece.push_back({{corner(), corner(), corner(), k}});
  return piece;
}

double distance_from(const std::vector<Piece>& piece, const Vector<3>& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Piece& k : piece)
    least = std::min(least, PreparedTriangle(k.wall.a, k.wall.b, k.wall.c).offset(p).norm());
  return least;
}

TEST(OrientedBox, NeverLeavesOutWhatIsNearer) {
  Random random(1, stream(Stream::test));
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> place = uniform_point<3>(random, {-Vector<3>::Ones(), Vector<3>::Ones()});
    const double size = std::pow(10, random.uniform(-6, 0)), bend = i % 3 == 0 ? 0 : random.uniform(0, 1);
    const std::vector<Piece> piece = piece_of_wall(random, place, size, bend, i % 2 == 0 ? 1 : 1e-3);
    const OrientedBox box(std::span<const Piece>(piece), 3);
    for (int k = 0; k < 20; ++k) {
      const double far = std::pow(10, random.uniform(-3, 2)) * size;
      const Vector<3> p =
          place + uniform_point<3>(random, {Vector<3>::Constant(-far), Vector<3>::Constant(far)});
      const double d = distance_from(piece, p);
      EXPECT_FALSE(box.is_beyond(p, d)) << d;
      EXPECT_FALSE(box.is_beyond(p, std::numeric_limits<double>::infinity()));
      const Vector<3> n = uniform_point<3>(random, {-Vector<3>::Ones(), Vector<3>::Ones()}).normalized();
      double least = std::numeric_limits<double>::infinity();
      for (const Piece& t : piece)
        for (const Vector<3>* v : {&t.wall.a, &t.wall.b, &t.wall.c}) least = std::min(least, n.dot(p - *v));
      EXPECT_LE(box.depth_along(n, p), least);
    }
  }
}

TEST(OrientedBox, KnowsHowFarAnObliquePlaneIs) {
  Random random(2, stream(Stream::test));
  const Vector<3> n = Vector<3>(1, 2, 3).normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Piece> piece;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const auto corner = [&] { return Vector<3>(random.uniform(-1, 1) * u + random.uniform(-1, 1) * v); };
    const Vector<3> a = corner(), b = corner(), c = corner();
    const bool turned = (b - a).cross(c - a).dot(n) < 0;
    piece.push_back({{a, turned ? c : b, turned ? b : c, k}});
  }
  const OrientedBox box(std::span<const Piece>(piece), 3);
  for (int k = 0; k < 100; ++k) {
    const double height = random.uniform(0.01, 2);
    const Vector<3> p = random.uniform(-1, 1) * u + random.uniform(-1, 1) * v + height * n;
    EXPECT_TRUE(box.is_beyond(p, 0.9999 * height));
    EXPECT_FALSE(box.is_beyond(p, distance_from(piece, p)));
    EXPECT_TRUE(box.is_beyond(10 * u, 10 - 2));
  }
}

TEST(OrientedBox, IsAsNarrowAsANeedleThatSlants) {
  const Vector<3> along = Vector<3>(1, 2, 3).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
  const std::vector<Piece> needle = {{{-along, along, 1e-3 * u, 0}}};
  const OrientedBox box(std::span<const Piece>(needle), 3);
  for (const Vector<3>& aside : {u, Vector<3>(-u), v, Vector<3>((u + v).normalized())}) {
    EXPECT_TRUE(box.is_beyond(0.9 * along + 0.02 * aside, 0.0189));
    EXPECT_FALSE(box.is_beyond(0.02 * aside, distance_from(needle, 0.02 * aside)));
  }
}

TEST(OrientedBox, AroundNothingThatIsKnownLeavesOutNothing) {
  EXPECT_FALSE(OrientedBox().is_beyond({1, 2, 3}, 1e-300));
  EXPECT_FALSE(OrientedBox().is_beyond({1, 2, 3}, 0));
}

}  // namespace oriented_box_test
}  // namespace bernal

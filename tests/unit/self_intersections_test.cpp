// Pairs of triangles against integers: which meet beyond the corners that they share.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bernal/core/random.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/diagnose/separation.hpp"

namespace bernal {
namespace self_intersections_test {

struct Grid {
  std::int64_t x, y;
  bool operator==(const Grid&) const = default;
};
using Flat = std::array<Grid, 3>;

int sign(std::int64_t n) { return n > 0 ? 1 : n < 0 ? -1 : 0; }

int turn(Grid a, Grid b, Grid c) { return sign((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)); }

bool is_between(Grid a, Grid b, Grid p) {
  return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool segments_meet(Grid a, Grid b, Grid c, Grid d) {
  if (is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b)) return true;
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

bool holds(const Flat& t, Grid p) {
  const std::array<int, 3> turns = {turn(t[0], t[1], p), turn(t[1], t[2], p), turn(t[2], t[0], p)};
  return std::ranges::min(turns) >= 0 || std::ranges::max(turns) <= 0;
}

bool segment_meets(const Flat& t, Grid a, Grid b) {
  if (holds(t, a) || holds(t, b)) return true;
  for (int k = 0; k < 3; ++k)
    if (segments_meet(t[k], t[(k + 1) % 3], a, b)) return true;
  return false;
}

/// The corners that both have stand first in both.
bool meet(const Flat& s, const Flat& t, int shared) {
  if (shared == 2) return turn(s[0], s[1], s[2]) == turn(s[0], s[1], t[2]);
  if (shared == 1) return segment_meets(s, t[1], t[2]) || segment_meets(t, s[1], s[2]);
  for (int k = 0; k < 3; ++k)
    if (segment_meets(s, t[k], t[(k + 1) % 3])) return true;
  return holds(t, s[0]);
}

/// In a plane that lies along no axis, far from the origin of coordinates if that is wanted.
Vector<3> in_space(Grid p, double far) {
  const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
  return {far + x, y - far, far + 3 * x - 2 * y};
}

Mesh pair_of(const Flat& s, const Flat& t, int shared, double far) {
  Mesh mesh;
  for (const Grid p : s) mesh.vertices.push_back(in_space(p, far));
  for (int k = shared; k < 3; ++k) mesh.vertices.push_back(in_space(t[k], far));
  mesh.triangles.push_back({0, 1, 2});
  std::array<std::uint32_t, 3> other{0, 1, 2};
  for (int k = shared; k < 3; ++k) other[k] = static_cast<std::uint32_t>(3 + k - shared);
  std::swap(other[0], other[2]);  // in another order than in the first
  mesh.triangles.push_back(other);
  return mesh;
}

TEST(SelfIntersections, OfTrianglesInOnePlaneAgreeWithIntegers) {
  Random random(1, 0);
  for (const std::int64_t grid : {4, 9, 1000})
    for (const double far : {0.0, 1e6, 1e12})
      for (int shared = 0; shared <= 2; ++shared) {
        int tried = 0, met = 0;
        for (int trial = 0; trial < 2000; ++trial) {
          const auto point = [&] {
            return Grid{static_cast<std::int64_t>(random.uniform() * static_cast<double>(grid)),
                        static_cast<std::int64_t>(random.uniform() * static_cast<double>(grid))};
          };
          const Flat s{point(), point(), point()};
          Flat t{point(), point(), point()};
          for (int k = 0; k < shared; ++k) t[k] = s[k];
          if (turn(s[0], s[1], s[2]) == 0 || turn(t[0], t[1], t[2]) == 0) continue;
          ++tried;
          const bool expected = meet(s, t, shared);
          met += expected;
          ASSERT_EQ(cad::count_self_intersections(pair_of(s, t, shared, far)), expected ? 1U : 0U)
              << "grid " << grid << ", far " << far << ", shared " << shared << ", trial " << trial;
        }
        EXPECT_GT(met, tried / 10) << "grid " << grid << ", far " << far << ", shared " << shared;
        EXPECT_LT(met, tried) << "grid " << grid << ", far " << far << ", shared " << shared;
      }
}

using Point = std::array<std::int64_t, 3>;

int side(const Point& a, const Point& b, const Point& c, const Point& p) {
  std::array<Point, 3> d;
  for (int k = 0; k < 3; ++k) {
    d[0][k] = a[k] - p[k];
    d[1][k] = b[k] - p[k];
    d[2][k] = c[k] - p[k];
  }
  std::int64_t sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += d[0][k] * (d[1][(k + 1) % 3] * d[2][(k + 2) % 3] - d[1][(k + 2) % 3] * d[2][(k + 1) % 3]);
  return sign(sum);
}

/// Nothing if four of the points lie in a plane, so that the signs do not tell.
int pierces(const std::array<Point, 3>& t, const Point& p, const Point& q) {
  const int below = side(t[0], t[1], t[2], p), above = side(t[0], t[1], t[2], q);
  std::array<int, 3> around;
  for (int k = 0; k < 3; ++k) around[k] = side(p, q, t[k], t[(k + 1) % 3]);
  if (below == 0 || above == 0 || std::ranges::find(around, 0) != around.end()) return -1;
  return below != above && around[0] == around[1] && around[1] == around[2];
}

TEST(SelfIntersections, OfTrianglesInSpaceAgreeWithIntegers) {
  Random random(2, 0);
  for (const std::int64_t grid : {7, 100'000}) {
    int told = 0, met = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
      std::array<std::array<Point, 3>, 2> pair;
      Mesh mesh;
      for (auto& triangle : pair)
        for (Point& p : triangle) {
          for (std::int64_t& c : p)
            c = static_cast<std::int64_t>(random.uniform() * static_cast<double>(grid));
          mesh.vertices.emplace_back(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                     static_cast<double>(p[2]));
        }
      mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
      bool expected = false, known = true;
      for (int own = 0; own < 2; ++own)
        for (int k = 0; k < 3; ++k) {
          const int pierced = pierces(pair[own], pair[1 - own][k], pair[1 - own][(k + 1) % 3]);
          known = known && pierced >= 0;
          expected = expected || pierced == 1;
        }
      if (!known) continue;
      ++told;
      met += expected;
      ASSERT_EQ(cad::count_self_intersections(mesh), expected ? 1U : 0U)
          << "grid " << grid << ", trial " << trial;
    }
    EXPECT_GT(met, told / 100) << grid;
    EXPECT_LT(met, told) << grid;
  }
}

TEST(Separation, ClaimsNothingThatRoundingCouldHaveMade) {
  // Two points a few last digits apart along d: the gap is less than what sums of products may be wrong by.
  const Vector<3> d(0.1, 0.7, -0.3), origin(0, 0, 0);
  Random random(3, 0);
  int proven = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector<3> p(1e6 * random.uniform(), 1e6 * random.uniform(), 1e6 * random.uniform());
    const double step = std::ldexp(1.0, static_cast<int>(40 * random.uniform()) - 50);
    const Vector<3> q = p + step * d;
    const std::array<Vector<3>, 1> a{p}, b{q};
    long double gap = 0;
    for (int k = 0; k < 3; ++k)
      gap += static_cast<long double>(d[k]) * (static_cast<long double>(q[k]) - p[k]);
    if (!cad::Separation(a, b, origin).proven_along(d)) continue;
    ++proven;
    EXPECT_GT(gap, 0.0L) << trial;
  }
  EXPECT_GT(proven, 100);
  EXPECT_LT(proven, 1900);
}

}  // namespace self_intersections_test
}  // namespace bernal

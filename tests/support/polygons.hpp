#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bernal/domain/domain.hpp"

// Domains of two dimensions, and their distances by the plainest definition.
namespace bernal::test {

inline Polygon triangle() { return {{{{0, 0}, {10, 0}, {4, 9}}}}; }
inline Polygon l_shape() { return {{{{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}}}}; }
inline Polygon with_hole() {
  return {{{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{3, 3}, {7, 4}, {6, 7}, {2.5, 6}}}};
}
inline Polygon clockwise(Polygon polygon) {
  for (auto& loop : polygon.loops) std::ranges::reverse(loop);
  return polygon;
}
inline Polygon moved(Polygon polygon, const Vector<2>& by, double factor = 1) {
  for (auto& loop : polygon.loops)
    for (Vector<2>& v : loop) v = factor * v + by;
  return polygon;
}
/// A corner of a thousandth of its length.
inline Polygon needle() { return {{{{0, 0}, {10, 0}, {10, 6}, {0, 0.01}}}}; }
/// A circle with waves.
inline Polygon star(int corners) {
  Polygon polygon{{{}}};
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    const double r = 5 + std::cos(7 * angle);
    polygon.loops.front().emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return polygon;
}

inline std::vector<std::pair<std::string, Domain>> flat_domains() {
  return {{"Rectangle", Box{{1, -2}, {3, 2.5}}},
          {"RectangleFarAway", Box{{1e6, -3e5}, {30, 0.7}}},
          {"Triangle", triangle()},
          {"ClockwiseTriangle", clockwise(triangle())},
          {"LShape", l_shape()},
          {"Hole", with_hole()},
          {"HoleFarAway", moved(with_hole(), {1e6, -1e6})},
          {"Needle", needle()},
          {"Star", star(300)},
          {"CornersInARow", Polygon{{{{0, 0}, {5, 0}, {5, 0}, {10, 0}, {10, 10}, {5, 10}, {0, 10}}}}}};
}

/// Signed distance from the walls, in long double over all edges, the side by the sum of the angles under
/// which they are seen.
inline long double precise_clearance_flat(const Domain& domain, const Vector<2>& p) {
  using Real = long double;
  if (const auto* box = std::get_if<Box>(&domain)) {
    Real least = std::numeric_limits<Real>::infinity(), squared_outside = 0;
    for (int k = 0; k < 2; ++k)
      for (const Real depth :
           {Real(p[k]) - box->corner[k], Real(double(box->corner[k] + box->size[k])) - p[k]}) {
        least = std::min(least, depth);
        if (depth < 0) squared_outside += depth * depth;
      }
    return least >= 0 ? least : -std::sqrt(squared_outside);
  }
  Real squared = std::numeric_limits<Real>::infinity();
  bool inside = false;
  for (const auto& loop : std::get<Polygon>(domain).loops) {
    Real angle = 0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      const Real ax = Real(a[0]) - p[0], ay = Real(a[1]) - p[1], bx = Real(b[0]) - p[0],
                 by = Real(b[1]) - p[1];
      const Real ex = bx - ax, ey = by - ay, length = ex * ex + ey * ey;
      const Real t = length > 0 ? std::clamp<Real>(-(ax * ex + ay * ey) / length, 0, 1) : 0;
      const Real x = ax + t * ex, y = ay + t * ey;
      squared = std::min(squared, x * x + y * y);
      angle += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    inside ^= std::abs(angle) > std::numbers::pi_v<Real>;
  }
  return (inside ? 1 : -1) * std::sqrt(squared);
}

}  // namespace bernal::test

#include "domain/exact_analytic.hpp"

#include <algorithm>

#include "core/rounding.hpp"
#include "domain/exact_way.hpp"

namespace bernal {

/// Where the upper corner is no double, its walls stand a size behind the lower one, seen from above.
std::vector<AnalyticWall> walls_of(const Box& shape) {
  const Bounds<3> bounds = bounds_of(shape);
  std::vector<AnalyticWall> walls;
  for (int k = 0; k < shape.dimension(); ++k) {
    if (shape.repeats(k)) continue;
    walls.push_back({Facet::Kind::plane, bounds.lower, Vector<3>::Unit(k), 0});
    if (is_exact_sum(shape.corner[k], shape.size[k]))
      walls.push_back({Facet::Kind::plane, bounds.upper, -Vector<3>::Unit(k), 0});
    else
      walls.push_back({Facet::Kind::plane, bounds.lower, -Vector<3>::Unit(k), shape.size[k]});
  }
  return walls;
}

/// The top stands `height` behind the base, seen from above.
std::vector<AnalyticWall> walls_of(const Cylinder& shape) {
  std::vector<AnalyticWall> walls = {{Facet::Kind::cylinder, shape.base, shape.axis, shape.radius}};
  if (shape.periodic) return walls;
  walls.push_back({Facet::Kind::plane, shape.base, shape.axis, 0});
  walls.push_back({Facet::Kind::plane, shape.base, -shape.axis, shape.height});
  return walls;
}

std::vector<AnalyticWall> walls_of(const Sphere& shape) {
  return {{Facet::Kind::sphere, shape.center, Vector<3>::Zero(), shape.radius}};
}

bool contains_exactly(const std::vector<AnalyticWall>& walls, const Vector<3>& c, double r) {
  const ExactVector place = exact(c);
  return std::ranges::all_of(walls, [&](const AnalyticWall& wall) { return clears_exactly(wall, place, r); });
}

namespace {

/// Positive where c lies to the left of the line from a to b.
int side_of(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c) {
  const Dyadic ax = a[0], ay = a[1];
  return ((Dyadic(b[0]) - ax) * (Dyadic(c[1]) - ay) - (Dyadic(b[1]) - ay) * (Dyadic(c[0]) - ax)).sign();
}

/// Whether the ray from c along the first axis crosses the edge, whose lower end alone belongs to it.
bool ray_crosses(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c) {
  if ((a[1] > c[1]) == (b[1] > c[1])) return false;
  if (std::min(a[0], b[0]) > c[0]) return true;
  if (std::max(a[0], b[0]) < c[0]) return false;
  const int side = side_of(a, b, c);
  return b[1] > a[1] ? side > 0 : side < 0;
}

bool edge_is_clear(const Vector<2>& a, const Vector<2>& b, const Vector<2>& c, const Dyadic& squared_radius) {
  const Dyadic wx = Dyadic(c[0]) - Dyadic(a[0]), wy = Dyadic(c[1]) - Dyadic(a[1]);
  const Dyadic ex = Dyadic(b[0]) - Dyadic(a[0]), ey = Dyadic(b[1]) - Dyadic(a[1]);
  const Dyadic along = wx * ex + wy * ey, squared_length = square(ex) + square(ey);
  if (along.sign() <= 0) return square(wx) + square(wy) >= squared_radius;
  if (along >= squared_length)
    return square(Dyadic(c[0]) - Dyadic(b[0])) + square(Dyadic(c[1]) - Dyadic(b[1])) >= squared_radius;
  return square(wx * ey - wy * ex) >= squared_radius * squared_length;
}

}  // namespace

bool contains_exactly(const Polygon& shape, const Vector<3>& center, double r) {
  ++exact_decisions;
  const Vector<2> c = center.head<2>();
  const Dyadic squared_radius = square(Dyadic(r));
  bool inside = false;
  for (const auto& loop : shape.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector<2>&a = loop[k], &b = loop[(k + 1) % loop.size()];
      inside ^= ray_crosses(a, b, c);
      // Comparisons of doubles have no error, and these differences are rounded by less than a part in 2^52.
      constexpr double more = 1 + 0x1p-50;
      const bool far = (a.cwiseMin(b) - c).maxCoeff() > more * r || (c - a.cwiseMax(b)).maxCoeff() > more * r;
      if (!far && !edge_is_clear(a, b, c, squared_radius)) return false;
    }
  }
  return inside;
}

}  // namespace bernal

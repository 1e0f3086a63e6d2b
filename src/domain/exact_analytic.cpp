#include "domain/exact_analytic.hpp"

#include <algorithm>

#include "domain/exact_way.hpp"

namespace bernal {

std::vector<AnalyticWall> walls_of(const Box& shape) {
  const Bounds<3> bounds = bounds_of(shape);
  std::vector<AnalyticWall> walls;
  for (int k = 0; k < 3; ++k) {
    if (shape.repeats(k)) continue;
    walls.push_back({Facet::Kind::plane, bounds.lower, Vector<3>::Unit(k), 0});
    walls.push_back({Facet::Kind::plane, bounds.upper, -Vector<3>::Unit(k), 0});
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

}  // namespace bernal

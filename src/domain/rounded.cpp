#include "domain/rounded.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/rounding.hpp"
#include "geometry/changes.hpp"

namespace bernal {
namespace {

/// (cos, sin) of so many steps from 0 to 90°, the ends exact.
std::vector<Vector<2>> quarter(int steps) {
  std::vector<Vector<2>> points{{1, 0}};
  for (int k = 1; k < steps; ++k) {
    const double angle = 0.5 * std::numbers::pi * k / steps;
    points.emplace_back(std::cos(angle), std::sin(angle));
  }
  points.emplace_back(0, 1);
  return points;
}

/// Around the z axis, those between two quarters twice.
std::vector<Vector<2>> whole_turn(const std::vector<Vector<2>>& arc) {
  std::vector<Vector<2>> points;
  for (int turn = 0; turn < 4; ++turn)
    for (const Vector<2>& p : arc)
      points.push_back(turn == 0   ? p
                       : turn == 1 ? Vector<2>(-p[1], p[0])
                       : turn == 2 ? Vector<2>(-p[0], -p[1])
                                   : Vector<2>(p[1], -p[0]));
  return points;
}

}  // namespace

Mesh rounded(const Box& box, double rounding) {
  constexpr int steps = 24;
  const std::vector<Vector<2>> arc = quarter(steps), around = whole_turn(arc);
  const auto n = static_cast<std::uint32_t>(around.size());
  // A point of the wall in a direction from the nearest corner of the inner box. `sides` says which corner
  // that is where the direction lies between two.
  const auto wall = [&](const Vector<3>& direction, const std::array<bool, 3>& sides) {
    Vector<3> p;
    for (int k = 0; k < 3; ++k) {
      const double lower = box.corner[k], upper = sum_rounded_down(lower, box.size[k]);
      const double depth = rounding * (1 - std::abs(direction[k])), middle = 0.5 * (lower + upper);
      p[k] = sides[static_cast<std::size_t>(k)] ? std::max(upper - depth, middle)
                                                : std::min(lower + depth, middle);
    }
    return p;
  };
  Mesh mesh;
  std::uint32_t rings = 0;
  for (const bool above : {false, true})
    for (int k = 0; k <= steps; ++k, ++rings) {
      // From the lower pole to the equator, and from there to the upper.
      const Vector<2>& at = arc[static_cast<std::size_t>(above ? k : steps - k)];
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t turn = i / (steps + 1);
        const Vector<3> direction(at[0] * around[i][0], at[0] * around[i][1], at[1]);
        mesh.vertices.push_back(wall(direction, {turn == 0 || turn == 3, turn < 2, above}));
      }
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({a, b, c});
  };
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = ring * n + i, b = ring * n + (i + 1) % n;
      add(a, b, b + n);
      add(a, b + n, a + n);
    }
  // The poles are rectangles.
  const std::uint32_t quarter_of_ring = n / 4, top = (rings - 1) * n;
  add(0, 2 * quarter_of_ring, quarter_of_ring);
  add(0, 3 * quarter_of_ring, 2 * quarter_of_ring);
  add(top, top + quarter_of_ring, top + 2 * quarter_of_ring);
  add(top, top + 2 * quarter_of_ring, top + 3 * quarter_of_ring);
  weld_equal_points(mesh);
  std::erase_if(mesh.triangles,
                [](const FaceCorners& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  return mesh;
}

Revolved rounded(const Cylinder& cylinder, double rounding) {
  const std::vector<Vector<2>> arc = quarter(32);
  const double inner = cylinder.radius - rounding, top = cylinder.height;
  Revolved solid{.base = cylinder.base, .axis = cylinder.axis};
  const auto add = [&](double r, double z) {
    if (solid.profile.empty() || solid.profile.back() != Vector<2>(r, z)) solid.profile.emplace_back(r, z);
  };
  add(0, 0);
  // Where the rounding meets a wall its points are on that wall without rounding.
  for (const Vector<2>& p : arc)
    add(p[1] == 1 ? cylinder.radius : inner + rounding * p[1], rounding * (1 - p[0]));
  for (const Vector<2>& p : arc)
    add(p[0] == 1 ? cylinder.radius : inner + rounding * p[0], top - rounding * (1 - p[1]));
  add(0, top);
  return solid;
}

}  // namespace bernal

#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

// Do these spheres overlap, is one outside? Asked of nothing but doubles and textbook formulas, sorted along
// one axis; shares nothing with packer or certificate. Rounding is the only allowance, and it is stated.
namespace bernal::testing {
namespace plain {

using Point = std::array<double, 3>;
inline Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Squared distance of the origin from a segment.
inline double squared_to_segment(const Point& a, const Point& b) {
  const Point ab = minus(b, a);
  const double length = dot(ab, ab);
  const double t = length > 0 ? std::clamp(-dot(a, ab) / length, 0.0, 1.0) : 0.0;
  const Point nearest = {a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]};
  return dot(nearest, nearest);
}

/// Squared distance of the origin from a triangle: from its plane where the foot lies between the edges, else
/// from the nearest edge.
inline double squared_to_triangle(const Point& a, const Point& b, const Point& c) {
  const Point n = cross(minus(b, a), minus(c, a));
  const auto beside = [&](const Point& p, const Point& q) { return dot(cross(minus(q, p), p), n) <= 0; };
  const double area = dot(n, n);
  double best = std::min({squared_to_segment(a, b), squared_to_segment(b, c), squared_to_segment(c, a)});
  if (area > 0 && beside(a, b) && beside(b, c) && beside(c, a)) {
    const double height = dot(a, n);
    best = std::min(best, height * height / area);
  }
  return best;
}

/// Distance from the nearest wall; negative outside. `reach`: farther walls do not matter.
inline double clearance(const Point& p, const Mesh& mesh, double reach) {
  double squared = reach * reach;
  // The side is told by the sum of solid angles (van Oosterom & Strackee 1983): 4 pi inside, 0 outside.
  double half_solid_angle = 0;
  for (const auto& t : mesh.triangles) {
    std::array<Point, 3> v;
    for (int k = 0; k < 3; ++k) {
      const Vector<3>& w = mesh.vertices[t[k]];
      v[k] = {w[0] - p[0], w[1] - p[1], w[2] - p[2]};
    }
    double apart = 0;
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({v[0][k], v[1][k], v[2][k]});
      const double d = std::max({low, -high, 0.0});
      apart += d * d;
    }
    if (apart < squared) squared = std::min(squared, squared_to_triangle(v[0], v[1], v[2]));
    const double a = std::sqrt(dot(v[0], v[0])), b = std::sqrt(dot(v[1], v[1])),
                 c = std::sqrt(dot(v[2], v[2]));
    half_solid_angle +=
        std::atan2(dot(v[0], cross(v[1], v[2])),
                   a * b * c + dot(v[0], v[1]) * c + dot(v[1], v[2]) * a + dot(v[2], v[0]) * b);
  }
  return half_solid_angle > std::numbers::pi ? std::sqrt(squared) : -std::sqrt(squared);
}

inline Point point(const Vector<dynamic>& v) { return {v[0], v[1], v[2]}; }

/// Gap to the wall in lengths, at most `reach`, and how far that may be off by rounding.
struct Gap {
  double gap, rounding;
};
inline Gap wall_gap(const Vector<dynamic>& c, double r, const Domain& domain) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  if (const auto* box = std::get_if<Box>(&domain)) {
    Gap least{std::numeric_limits<double>::infinity(), 0};
    for (int k = 0; k < box->dimension(); ++k) {
      if (box->repeats(k)) continue;
      const double low = box->corner[k], high = low + box->size[k];
      const double gap = std::min((c[k] - low) - r, (high - c[k]) - r);
      if (gap < least.gap) least = {gap, 4 * eps * box->size[k]};
    }
    return least;
  }
  if (const auto* sphere = std::get_if<Sphere>(&domain))
    return {(sphere->radius - r) - (c - sphere->center).norm(), 8 * eps * sphere->radius};
  if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> axis = cylinder->axis.normalized(), w = Vector<3>(c) - cylinder->base;
    const double along = w.dot(axis), lateral = (cylinder->radius - r) - (w - along * axis).norm();
    const double size = cylinder->radius + std::max(std::abs(along), cylinder->height);
    if (cylinder->periodic) return {lateral, 16 * eps * size};
    return {std::min({lateral, along - r, (cylinder->height - along) - r}), 16 * eps * size};
  }
  if (const auto* revolved = std::get_if<Revolved>(&domain)) {
    const Vector<3> axis = revolved->axis.normalized(), w = Vector<3>(c) - revolved->base;
    const double z = w.dot(axis), rho = (w - z * axis).norm();
    double least = std::numeric_limits<double>::infinity(), size = w.norm();
    bool inside = false;
    for (std::size_t k = 0; k < revolved->profile.size(); ++k) {
      const Vector<2> a = revolved->profile[k], b = revolved->profile[(k + 1) % revolved->profile.size()];
      size = std::max(size, a.norm());
      if ((a[1] > z) != (b[1] > z)) inside ^= rho < a[0] + (z - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      if (a[0] == 0 && b[0] == 0) continue;
      const Vector<2> e = b - a, to = Vector<2>(rho, z) - a;
      const double t = e.squaredNorm() > 0 ? std::clamp(to.dot(e) / e.squaredNorm(), 0.0, 1.0) : 0.0;
      least = std::min(least, (to - t * e).norm());
    }
    return {(inside ? least : -least) - r, 32 * eps * size};
  }
  const Mesh& mesh = std::get<Mesh>(domain);
  const Bounds<3> bounds = bounds_of(domain);
  const double size = (bounds.upper - bounds.lower).norm();
  return {clearance(point(c), mesh, 2 * r) - r, 32 * eps * size};
}

}  // namespace plain

/// What speaks against these spheres in this domain; empty if nothing does. Cost: about N^(5/3) and all
/// triangles of a mesh for every sphere.
inline std::string plain_objection(const Spheres<dynamic>& spheres, const Domain& domain,
                                   double allowed_overlap) {
  constexpr double eps = std::numeric_limits<double>::epsilon();
  const std::size_t n = spheres.size();
  const int dimension = spheres.dimension();
  std::vector<double> period(static_cast<std::size_t>(dimension), 0);
  if (const auto* box = std::get_if<Box>(&domain))
    for (int k = 0; k < dimension; ++k)
      if (box->repeats(k)) period[static_cast<std::size_t>(k)] = box->size[k];
  const auto* column = std::get_if<Cylinder>(&domain);
  const bool turning = column && column->periodic;

  for (std::size_t i = 0; i < n; ++i) {
    if (!(spheres.r[i] > 0) || !std::isfinite(spheres.r[i])) return fmt::format("radius of sphere {}", i);
    const auto [gap, rounding] = plain::wall_gap(spheres.center(i), spheres.r[i], domain);
    if (!(gap >= -rounding)) return fmt::format("sphere {} lies {:.3g} outside", i, -gap);
  }

  const auto too_near = [&](std::size_t i, std::size_t j) {
    double squared = 0, size = 0;
    Vector<dynamic> d = spheres.center(i) - spheres.center(j);
    if (turning) {
      const Vector<3> axis = column->axis.normalized(), w = d;
      d = w - column->height * std::round(w.dot(axis) / column->height) * axis;
      size = column->height;
    }
    for (int k = 0; k < dimension; ++k) {
      const double p = period[static_cast<std::size_t>(k)];
      if (p > 0) d[k] -= p * std::round(d[k] / p);
      squared += d[k] * d[k];
      size = std::max(size, p);
    }
    const double reach = (1 - allowed_overlap) * (spheres.r[i] + spheres.r[j]);
    return std::sqrt(squared) < reach * (1 - 8 * eps) - 4 * eps * size;
  };

  // Along the first axis without a period; none in a box that repeats itself everywhere: all pairs.
  int axis = 0;
  while (axis < dimension && period[static_cast<std::size_t>(axis)] > 0) ++axis;
  const bool sweeps = axis < dimension && !turning;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto lower = [&](std::size_t i) { return spheres.x[axis][i] - spheres.r[i]; };
  if (sweeps) std::ranges::sort(order, {}, lower);
  for (std::size_t a = 0; a < n; ++a) {
    const std::size_t i = order[a];
    for (std::size_t b = a + 1; b < n; ++b) {
      const std::size_t j = order[b];
      if (sweeps && lower(j) > spheres.x[axis][i] + spheres.r[i]) break;
      if (too_near(i, j)) return fmt::format("spheres {} and {} overlap", i, j);
    }
  }
  return "";
}

}  // namespace bernal::testing

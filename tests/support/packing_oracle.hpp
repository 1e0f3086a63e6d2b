#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include "bernal/core/spheres.hpp"
#include "bernal/domain/domain.hpp"

// What is true of a packing, from the definitions in domain.hpp: all pairs, all triangles, rational
// arithmetic with divisions. Slow and simple; it shares nothing with what it judges, neither search nor
// formula.

namespace bernal::oracle {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;
using Point = std::array<Rational, 3>;

inline Point point(const Vector<3>& v) { return {Rational(v[0]), Rational(v[1]), Rational(v[2])}; }
inline Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Point operator*(const Rational& s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Rational dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Squared distance of p from the triangle: the least over its edges and, where the foot of the perpendicular
/// has barycentric coordinates in [0, 1], its plane.
inline Rational squared_distance(const Point& p, const std::array<Point, 3>& v) {
  Rational best = dot(p - v[0], p - v[0]);
  for (int k = 0; k < 3; ++k) {
    const Point &a = v[k], &b = v[(k + 1) % 3];
    const Point along = b - a;
    const Rational length_squared = dot(along, along);
    Rational t = 0;
    if (length_squared != 0) t = std::clamp(dot(p - a, along) / length_squared, Rational(0), Rational(1));
    const Point rest = p - (a + t * along);
    best = std::min(best, dot(rest, rest));
  }
  const Point e = v[1] - v[0], f = v[2] - v[0], w = p - v[0];
  const Rational ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), we = dot(w, e), wf = dot(w, f);
  const Rational determinant = ee * ff - ef * ef;
  if (determinant != 0) {
    const Rational s = (ff * we - ef * wf) / determinant, t = (ee * wf - ef * we) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      const Point rest = w - (s * e + t * f);
      best = std::min(best, dot(rest, rest));
    }
  }
  return best;
}

/// Winding number of the mesh about p by a ray in an oblique direction; another direction where the ray meets
/// an edge or a vertex. Precondition: p is not on the mesh.
inline int winding(const Point& p, const Mesh& mesh) {
  for (int attempt = 0;; ++attempt) {
    const Point d{Rational(1009 + 17 * attempt, 1000), Rational(-733 + 29 * attempt, 997),
                  Rational(311, 1013)};
    int sum = 0;
    bool degenerate = false;
    for (const auto& t : mesh.triangles) {
      const Point a = point(mesh.vertices[t[0]]);
      const Point e = point(mesh.vertices[t[1]]) - a, f = point(mesh.vertices[t[2]]) - a, w = p - a;
      const Point n = cross(e, f);
      const Rational slope = dot(n, d);
      if (slope == 0) {
        degenerate = degenerate || (dot(n, n) != 0 && dot(n, w) == 0);
        continue;
      }
      const Rational along = -dot(n, w) / slope;  // p + along d lies in the plane of the triangle
      if (along <= 0) continue;
      const Point q = w + along * d;
      const Rational ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), qe = dot(q, e), qf = dot(q, f);
      const Rational determinant = ee * ff - ef * ef;
      const Rational s = (ff * qe - ef * qf) / determinant, u = (ee * qf - ef * qe) / determinant;
      const Rational least = std::min({s, u, 1 - s - u});
      if (least == 0) degenerate = true;
      if (least > 0) sum += slope > 0 ? 1 : -1;
    }
    if (!degenerate) return sum;
  }
}

/// The ball lies between the walls of the box, in any dimension.
inline bool inside(const Vector<dynamic>& c, double radius, const Box& box) {
  for (int k = 0; k < box.dimension(); ++k) {
    if (!box.periodic.empty() && box.periodic[static_cast<std::size_t>(k)]) continue;
    const Rational lower(box.corner[k]);
    if (Rational(c[k]) - Rational(radius) < lower) return false;
    if (Rational(c[k]) + Rational(radius) > lower + Rational(box.size[k])) return false;
  }
  return true;
}

/// The ball lies in the closed container.
inline bool inside(const Vector<dynamic>& center, double radius, const Domain& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return inside(center, radius, *box);
  const Point c = point(center);
  const Rational r(radius);
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    const Point w = c - point(sphere->center);
    const Rational room = Rational(sphere->radius) - r;
    return room >= 0 && dot(w, w) <= room * room;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    // height = h / |a| with h = w·a. All ends are compared as signed squares, s(x) = x |x|.
    const auto signed_square = [](const Rational& x) -> Rational { return x < 0 ? -x * x : x * x; };
    const Point a = point(cylinder->axis), w = c - point(cylinder->base);
    const Rational h = dot(w, a), aa = dot(a, a);
    const Rational signed_height = signed_square(h) / aa;
    const Rational room = Rational(cylinder->radius) - r;
    const Rational from_axis_squared = dot(w, w) - h * h / aa;
    if (cylinder->periodic) return room >= 0 && from_axis_squared <= room * room;
    return signed_height >= r * r && signed_height <= signed_square(Rational(cylinder->height) - r) &&
           room >= 0 && from_axis_squared <= room * room;
  }
  if (const auto* revolved = std::get_if<Revolved>(&shape)) {
    // In two hundred digits: what is nearer than a 1e-100th touches.
    using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<200>,
                                               boost::multiprecision::et_off>;
    const Point a = point(revolved->axis), w = c - point(revolved->base);
    const Rational h = dot(w, a), aa = dot(a, a), across = dot(w, w) - h * h / aa;
    const Real z = Real(h) / sqrt(Real(aa)), rho = sqrt(Real(across));
    Real least = 1e100;
    bool odd = false;
    for (std::size_t k = 0; k < revolved->profile.size(); ++k) {
      const Vector<2>&p = revolved->profile[k], &q = revolved->profile[(k + 1) % revolved->profile.size()];
      if (p[0] == 0 && q[0] == 0) continue;
      const Real er = Real(q[0]) - Real(p[0]), ez = Real(q[1]) - Real(p[1]), ee = er * er + ez * ez;
      if (ee == 0) continue;
      const Real s = (rho - Real(p[0])) * er + (z - Real(p[1])) * ez;
      const Real share = s < 0 ? Real(0) : s > ee ? Real(1) : Real(s / ee);
      const Real dr = rho - Real(p[0]) - share * er, dz = z - Real(p[1]) - share * ez;
      least = std::min(least, Real(sqrt(dr * dr + dz * dz)));
      if ((Real(p[1]) > z) != (Real(q[1]) > z)) odd ^= rho < Real(p[0]) + (z - Real(p[1])) / ez * er;
    }
    return odd && least >= Real(radius) - Real(1e-100);
  }
  const auto& mesh = std::get<Mesh>(shape);
  for (const auto& t : mesh.triangles) {
    const std::array<Point, 3> corner{point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]),
                                      point(mesh.vertices[t[2]])};
    if (squared_distance(c, corner) < r * r) return false;
  }
  return winding(c, mesh) == 1;
}

/// d < (1 - allowed)(ri + rj)
inline bool overlap(const Spheres<3>& s, std::size_t i, std::size_t j, double allowed = 0) {
  const Point d = point(s.center(i)) - point(s.center(j));
  const Rational reach = (1 - Rational(allowed)) * (Rational(s.r[i]) + Rational(s.r[j]));
  return dot(d, d) < reach * reach;
}

/// The closed bounding boxes of two spheres, grown by `margin` times the largest coordinate, meet.
inline bool boxes_touch(const Spheres<3>& s, std::size_t i, std::size_t j, double margin = 0) {
  const Rational reach = Rational(s.r[i]) + Rational(s.r[j]);
  for (int k = 0; k < 3; ++k) {
    const Rational a(s.x[k][i]), b(s.x[k][j]);
    const Rational size = std::max(abs(a), abs(b)) + reach;
    if (abs(a - b) > reach + Rational(margin) * size) return false;
  }
  return true;
}

struct Verdict {
  std::uint64_t overlapping = 0;
  std::uint64_t protruding = 0;
  std::uint64_t near_at_least = 0;  ///< pairs whose boxes meet
  std::uint64_t near_at_most = 0;   ///< pairs whose boxes meet when they are grown by some roundoffs
  double max_overlap = 0;           ///< over all pairs, and spheres with their images
  std::vector<std::array<std::uint64_t, 2>> pairs;  ///< that overlap, where they are listed
};

inline Verdict judge(const Spheres<3>& s, const Domain& shape, double allowed = 0) {
  Verdict v;
  v.max_overlap = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < s.size(); ++i) {
    v.protruding += inside(s.center(i), s.r[i], shape) ? 0 : 1;
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      v.overlapping += overlap(s, i, j, allowed) ? 1 : 0;
      v.near_at_least += boxes_touch(s, i, j) ? 1 : 0;
      v.near_at_most += boxes_touch(s, i, j, 0x1p-50) ? 1 : 0;
      const Point d = point(s.center(i)) - point(s.center(j));
      const Rational sum = Rational(s.r[i]) + Rational(s.r[j]);
      const double ratio = std::sqrt(Rational(dot(d, d) / (sum * sum)).convert_to<double>());
      v.max_overlap = std::max(v.max_overlap, 1 - ratio);
    }
  }
  return v;
}

}  // namespace bernal::oracle

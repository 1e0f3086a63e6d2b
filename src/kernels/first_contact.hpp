#pragma once
#include <algorithm>
#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "bernal/core/vector.hpp"
#include "kernels/closest_point.hpp"

namespace bernal {

// How far a sphere may move along a unit vector before it meets an obstacle: at most `limit` (>= 0).
//
// All kernels follow one rule (core/tolerance.hpp). Let gap(t) be the distance of the moving sphere's surface
// from the obstacle after a displacement t, and `skin` > 0.
//   gap is at least skin/2 on [0, limit]: the answer is limit, the obstacle is ignored.
//   otherwise: the first t at which gap falls below `skin`, 0 if it is below at the start.
//   gap(0) < skin/2 (slight penetration): 0, unless the gap grows; then only a later decrease limits, which
//     does not occur for convex obstacles.
// Invariant: gap >= min(gap(0), skin/2) on the whole path, to a few roundoffs of the distances involved;
// `skin` is at least a thousand of them.

/// The closest approach of a point that moves along a unit vector to another point: after the displacement
/// `along` (negative: already past), at a distance whose square is `squared_miss`. The error of the distance
/// is a few roundoffs of that at the start, also for close passes.
struct Approach {
  double along;
  double squared_miss;
};

template <int D>
inline Approach closest_approach(const Vector<D>& to_other, const Vector<D>& direction) {
  const double along = to_other.dot(direction);
  return {along, (to_other - along * direction).squaredNorm()};
}

/// A sphere against a fixed one in D dimensions: centres `c` and `other`, gap(t) = |c + t·direction - other|
/// - sum_of_radii. The root of the quadratic is computed without cancellation. Cost: 2 ns a neighbour in a
/// list whose limit shrinks, 4 ns if every other one is hit.
template <int D>
inline double first_contact(const Vector<D>& c, const Vector<D>& direction, double limit,
                            const Vector<D>& other, double sum_of_radii, double skin) {
  const Vector<D> to_other = other - c;
  const Approach approach = closest_approach<D>(to_other, direction);
  const double stop = sum_of_radii + skin;
  if (approach.along <= 0 || approach.along - stop >= limit) return limit;
  const double ignore = sum_of_radii + 0.5 * skin;
  if (approach.squared_miss >= ignore * ignore) return limit;
  const double t = (to_other.squaredNorm() - stop * stop) /
                   (approach.along + std::sqrt(stop * stop - approach.squared_miss));
  if (t >= limit) return limit;
  const double rest = approach.along - limit;
  if (rest > 0 && approach.squared_miss + rest * rest >= ignore * ignore) return limit;
  return std::max(t, 0.0);
}

/// A sphere of radius r against the plane through `point` with the unit normal `normal` into the free side:
/// gap(t) = (c + t·direction - point)·normal - r.
inline double first_contact_with_plane(const Vector<3>& c, double r, const Vector<3>& direction, double limit,
                                       const Vector<3>& point, const Vector<3>& normal, double skin) {
  const double slope = direction.dot(normal);
  if (slope >= 0) return limit;
  const double gap = (c - point).dot(normal) - r;
  if (gap + slope * limit >= 0.5 * skin) return limit;
  return std::clamp((gap - skin) / -slope, 0.0, limit);
}

/// How far a point at `w` may move by multiples of `v` before its distance from the origin exceeds `stop`;
/// `limit` if that distance stays within `ignore` (> stop). Both may be negative: then it is never within.
/// Invariant: |w + t·v| <= max(|w|, ignore), verified.
inline double first_exit(const Vector<3>& w, const Vector<3>& v, double limit, double stop, double ignore) {
  const double squared_speed = v.squaredNorm();
  if (squared_speed == 0) return limit;
  const double outward = w.dot(v);
  const double squared_start = w.squaredNorm();
  const double squared_ignore = ignore > 0 ? ignore * ignore : 0;
  // The distance is a convex function of t, so a bound at both ends holds in between.
  const double squared_end = squared_start + limit * (2 * outward + limit * squared_speed);
  if (ignore > 0 && squared_end <= squared_ignore) return limit;

  // The larger root of |w + t·v| = stop; without a root, the t of the least distance.
  const double room = (stop > 0 ? stop * stop : 0) - squared_start;
  const double root = std::sqrt(std::max(0.0, outward * outward + squared_speed * room));
  double t = outward > 0 ? room / (outward + root) : (root - outward) / squared_speed;
  t = std::clamp(t, 0.0, limit);
  const double squared_bound = std::max(squared_start, squared_ignore);
  for (double back = 4 * tolerance::roundoff * t; t > 0 && (w + t * v).squaredNorm() > squared_bound;
       back *= 2)
    t = std::max(0.0, t - back);
  return t;
}

/// A sphere of radius r inside the infinite cylinder of radius R about the line through `point` along the
/// unit vector `axis`: gap(t) = R - r - |c + t·direction - point|⊥axis, a concave function, which may grow
/// and fall again.
inline double first_contact_inside_cylinder(const Vector<3>& c, double r, const Vector<3>& direction,
                                            double limit, const Vector<3>& point, const Vector<3>& axis,
                                            double R, double skin) {
  const Vector<3> from_point = c - point;
  const Vector<3> w = from_point - from_point.dot(axis) * axis;
  if (w.norm() + limit <= R - r - skin) return limit;
  const Vector<3> v = direction - direction.dot(axis) * axis;
  return first_exit(w, v, limit, R - r - skin, R - r - 0.5 * skin);
}

/// A sphere of radius r inside the sphere of radius R about `center`: gap(t) = R - r - |c + t·direction -
/// center|.
inline double first_contact_inside_sphere(const Vector<3>& c, double r, const Vector<3>& direction,
                                          double limit, const Vector<3>& center, double R, double skin) {
  const Vector<3> w = c - center;
  if (w.norm() + limit <= R - r - skin) return limit;
  return first_exit(w, direction, limit, R - r - skin, R - r - 0.5 * skin);
}

/// A sphere of radius r against a triangle, from either side: faces, edges and corners.
///
/// f(t) = distance(c + t·direction, triangle) is convex and 1-Lipschitz, so Newton's method started left of
/// the first root of f = level never passes it, and f(t) + f'(t)·(limit - t) is a lower bound for the rest.
/// The slope is lowered by the rounding of the direction to the triangle, which keeps both statements true in
/// floating point for small spheres that move far; slivers need no more (see PreparedTriangle). Cost: 35 ns
/// if the triangle does not limit, 0.15 µs if it does.
inline double first_contact_with_triangle(const Vector<3>& c, double r, const Vector<3>& direction,
                                          double limit, const Vector<3>& a, const Vector<3>& b,
                                          const Vector<3>& corner_c, double skin) {
  const PreparedTriangle triangle(a, b, corner_c);
  const double stop = r + skin;
  const double ignore = r + 0.5 * skin;
  constexpr int most_iterations = 64;

  double t = 0;          // f is at least `ignore` up to here
  double answer = 0;     // the last t at which f was at least `stop`, or 0
  bool stopped = false;  // f has reached `stop`; the rest decides between contact and grazing
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Vector<3> p = c + t * direction;
    const Vector<3> offset = triangle.offset(p);
    const double f = offset.norm();
    if (f - stop >= limit - t) return limit;
    const double nominal_slope = offset.dot(direction) / f;
    if (f < ignore) return iteration == 0 && nominal_slope >= 0 ? limit : answer;

    // The error of the offset is a few roundoffs of f + base, that of its direction this over f.
    const double slope = nominal_slope - 8 * tolerance::roundoff * (1 + triangle.base_length() / f);
    if (slope >= 0 || f + slope * (limit - t) >= ignore) return limit;
    if (!stopped) {
      answer = t;
      stopped = f - stop <= skin / 64 * -slope;
    }
    const double step = (f - (stopped ? ignore : stop)) / -slope;
    if (stopped && step <= skin) return answer;  // f is straight over such a short way
    t += step;
  }
  return answer;
}

}  // namespace bernal

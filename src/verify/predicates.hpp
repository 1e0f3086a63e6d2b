#pragma once
#include <array>
#include <utility>

#include "bernal/domain/domain.hpp"
#include "verify/ball.hpp"
#include "verify/sign.hpp"

// The predicates of a certificate, each written once for any arithmetic `Number` with +, -, ×, `square`,
// `magnitude`, `smaller` and `sign`: Bounded (a filter) or Exact. There are only ring operations and
// comparisons, no division and no root, so Exact evaluates them without error on the given doubles. Radii are
// positive, gaps not negative.

namespace bernal::verify {

template <class Number>
struct Triple {
  Number x, y, z;
};

template <class Number>
Triple<Number> vector(const Vector<3>& v) {
  return {Number(v[0]), Number(v[1]), Number(v[2])};
}

/// A point whose coordinates are sums of two doubles, with `high` the double nearest to the sum.
struct WidePoint {
  Vector<3> high, low;
};

/// a[k] - b[k], and comparisons of coordinates by their doubles.
template <class Number>
Number minus(const Vector<3>& a, const Vector<3>& b, int k) {
  return Number(a[k]) - Number(b[k]);
}
template <class Number>
Number minus(const WidePoint& a, const WidePoint& b, int k) {
  return minus<Number>(a.high, b.high, k) + minus<Number>(a.low, b.low, k);
}
inline bool is_above(const Vector<3>& a, const Vector<3>& b, int k) { return a[k] > b[k]; }
inline bool is_above(const WidePoint& a, const WidePoint& b, int k) {
  return a.high[k] > b.high[k] || (a.high[k] == b.high[k] && a.low[k] > b.low[k]);
}
template <class Point>
bool are_level(const Point& a, const Point& b, int k) {
  return !is_above(a, b, k) && !is_above(b, a, k);
}

template <class Number, class Point>
Triple<Number> difference(const Point& a, const Point& b) {
  return {minus<Number>(a, b, 0), minus<Number>(a, b, 1), minus<Number>(a, b, 2)};
}
template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
Number squared_norm(const Triple<Number>& a) {
  return square(a.x) + square(a.y) + square(a.z);
}
template <class Number>
Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// (1 - allowed)(ri + rj + gap), for 0 <= allowed < 1.
template <class Number>
Number least_distance(double ri, double rj, double allowed, double gap) {
  const Number sum = gap == 0 ? Number(ri) + Number(rj) : Number(ri) + Number(rj) + Number(gap);
  return allowed == 0 ? sum : sum * (Number(1) - Number(allowed));
}

template <class Number, int D, class Space>
Number squared_distance(const Space& space, const Ball<D>& a, const Ball<D>& b) {
  return [&]<int... k>(std::integer_sequence<int, k...>) {
    return (... + square(space.template offset<Number>(k, a.c[k], b.c[k])));
  }
  (std::make_integer_sequence<int, D>());
}

/// |ci - cj| >= (1 - allowed)(ri + rj + gap) in an OpenSpace or, for the nearest images, a PeriodicSpace.
template <class Number, int D, class Space>
Truth balls_clear(const Space& space, const Ball<D>& a, const Ball<D>& b, double allowed, double gap = 0) {
  return at_least(squared_distance<Number>(space, a, b),
                  square(least_distance<Number>(a.r, b.r, allowed, gap)));
}

/// Whether the ball keeps its distance from its own images along a periodic axis with that edge.
template <class Number>
Truth own_images_clear(double r, double edge, double allowed, double gap) {
  return at_least(Number(edge), least_distance<Number>(r, r, allowed, gap));
}

/// c - r >= lower, in one coordinate.
template <class Number>
Truth above(double c, const Reach& r, double lower) {
  return at_least(Number(c) - r.as<Number>(), Number(lower));
}
/// c + r <= lower + size, in one coordinate.
template <class Number>
Truth below(double c, const Reach& r, double lower, double size) {
  return at_least(Number(lower) + Number(size), Number(c) + r.as<Number>());
}

/// The ball lies in the ball of radius R around `center`: |c - center| <= R - r.
template <class Number>
Truth ball_in_ball(const Vector<3>& c, const Reach& r, const Sphere& s) {
  const Number room = Number(s.radius) - r.as<Number>();
  const Truth is_room = at_least(room, Number(0));
  if (is_room != Truth::yes) return is_room;
  return at_least(square(room), squared_norm(difference<Number>(c, s.center)));
}

// A cylinder has three pieces of wall. With w = c - base, the axis a of any length and h = w·a, the height of
// the centre is h / |a| and its distance from the axis |w × a| / |a|; both are compared squared.

/// h >= r |a|
template <class Number>
Truth above_base(const Vector<3>& c, const Reach& r, const Cylinder& s) {
  const Triple<Number> a = vector<Number>(s.axis);
  const Number h = dot(difference<Number>(c, s.base), a);
  return at_least(h, Number(0)) & at_least(square(h), square(r.as<Number>()) * squared_norm(a));
}
/// h <= (height - r) |a|
template <class Number>
Truth below_top(const Vector<3>& c, const Reach& r, const Cylinder& s) {
  const Triple<Number> a = vector<Number>(s.axis);
  const Number h = dot(difference<Number>(c, s.base), a);
  const Number limit = Number(s.height) - r.as<Number>();
  const Number limit_squared = square(limit) * squared_norm(a);
  const Truth h_not_positive = at_least(Number(0), h), is_room = at_least(limit, Number(0));
  if (is_room == Truth::unknown) return Truth::unknown;
  return is_room == Truth::yes ? h_not_positive | at_least(limit_squared, square(h))
                               : h_not_positive & at_least(square(h), limit_squared);
}
/// |w × a| <= (R - r) |a|
template <class Number>
Truth inside_side(const Vector<3>& c, const Reach& r, const Cylinder& s) {
  const Number room = Number(s.radius) - r.as<Number>();
  const Truth is_room = at_least(room, Number(0));
  if (is_room != Truth::yes) return is_room;
  const Triple<Number> a = vector<Number>(s.axis);
  return at_least(square(room) * squared_norm(a), squared_norm(cross(difference<Number>(c, s.base), a)));
}

template <class Point>
using CornersOf = std::array<Point, 3>;
using Corners = CornersOf<Vector<3>>;

/// Whether the distance of p from the triangle is at least r.
///
/// A triangle is its three vertices, three open edges and open face. An edge matters only if p projects
/// between its ends, the face only if p projects inside; the vertices are tested unconditionally. Edges and
/// faces without extent impose nothing.
template <class Number, class Point>
Truth ball_clears_triangle(const Point& p, const Reach& r, const CornersOf<Point>& corner) {
  const Number r_squared = square(r.as<Number>());
  const Triple<Number> to_p[3] = {difference<Number>(p, corner[0]), difference<Number>(p, corner[1]),
                                  difference<Number>(p, corner[2])};
  const Triple<Number> edge[3] = {difference<Number>(corner[1], corner[0]),
                                  difference<Number>(corner[2], corner[1]),
                                  difference<Number>(corner[0], corner[2])};

  const Triple<Number> normal = cross(edge[0], edge[1]);
  const Number height_squared = square(dot(normal, to_p[0]));
  const Number limit_squared = r_squared * squared_norm(normal);
  // Strictly: a triangle without area has no plane, and 0 > 0 is false.
  if (more_than(height_squared, limit_squared) == Truth::yes) return Truth::yes;

  Truth clear = Truth::yes;
  for (int k = 0; k < 3; ++k) clear = clear & at_least(squared_norm(to_p[k]), r_squared);
  if (clear == Truth::no) return Truth::no;

  for (int k = 0; k < 3; ++k) {
    const Number along = dot(to_p[k], edge[k]);
    const Number length_squared = squared_norm(edge[k]);
    const Truth beyond = at_least(Number(0), along) | at_least(along, length_squared);
    if (beyond == Truth::yes) continue;
    clear = clear & (beyond | at_least(squared_norm(cross(to_p[k], edge[k])), r_squared * length_squared));
  }
  if (clear == Truth::no) return Truth::no;

  const Truth plane_clear = at_least(height_squared, limit_squared);
  if (plane_clear == Truth::yes) return clear;
  Truth beside = Truth::no;
  for (int k = 0; k < 3; ++k) beside = beside | is_negative(dot(cross(normal, edge[k]), to_p[k]).sign());
  return clear & (plane_clear | beside);
}

/// The side of the line a -> b, in projection along z, of the point (px + ε, py + ε²) for all sufficiently
/// small ε > 0; positive to the left. Zero only if the projections of a and b coincide. Antisymmetric in a,
/// b, so that a path across an edge leaves one triangle and enters the other.
template <class Number, class Point>
Sign side_seen_from_above(const Point& a, const Point& b, const Point& p) {
  if (are_level(a, b, 0) && are_level(a, b, 1)) return Sign::zero;
  const Number area =
      minus<Number>(b, a, 0) * minus<Number>(p, a, 1) - minus<Number>(b, a, 1) * minus<Number>(p, a, 0);
  if (area.sign() != Sign::zero) return area.sign();
  if (!are_level(a, b, 1)) return is_above(a, b, 1) ? Sign::positive : Sign::negative;
  return is_above(b, a, 0) ? Sign::positive : Sign::negative;
}

/// How the ray from p upwards (+z) crosses the triangle: `positive` if it leaves through the side from which
/// the triangle is counter-clockwise, `negative` if it enters, `zero` if it misses.
///
/// The ray is shifted by (ε, ε²) in x and y, so that it meets no edge, no vertex and no vertical triangle. If
/// p lies on the triangle the answer is `zero`; no ball around such a p clears it anyway.
template <class Number, class Point>
Sign crossing_above(const Point& p, const CornersOf<Point>& corner) {
  const Sign side[3] = {side_seen_from_above<Number>(corner[0], corner[1], p),
                        side_seen_from_above<Number>(corner[1], corner[2], p),
                        side_seen_from_above<Number>(corner[2], corner[0], p)};
  const auto any = [&](Sign s) { return side[0] == s || side[1] == s || side[2] == s; };
  if (any(Sign::zero) || (any(Sign::positive) && any(Sign::negative))) return Sign::zero;
  if (any(Sign::unknown)) return Sign::unknown;

  const Sign orientation = side[0];
  if (is_above(corner[0], p, 2) && is_above(corner[1], p, 2) && is_above(corner[2], p, 2)) return orientation;
  const Triple<Number> normal =
      cross(difference<Number>(corner[1], corner[0]), difference<Number>(corner[2], corner[0]));
  // normal·(p - corner) = normal_z (height of p above the plane), and normal_z has the sign `orientation`.
  const Sign height = dot(normal, difference<Number>(p, corner[0])).sign();
  if (height == Sign::unknown) return Sign::unknown;
  return height == -orientation ? orientation : Sign::zero;
}

/// Whether the distance of p in the plane from the edge between a and b, ends included, is at least r.
template <class Number>
Truth ball_clears_edge(const Vector<2>& p, const Reach& r, const Vector<2>& a, const Vector<2>& b) {
  const auto minus = [](double s, double t) { return Number(s) - Number(t); };
  const Number r_squared = square(r.as<Number>());
  const Number wx = minus(p[0], a[0]), wy = minus(p[1], a[1]);
  const Number ex = minus(b[0], a[0]), ey = minus(b[1], a[1]);
  const Truth clear = at_least(square(wx) + square(wy), r_squared) &
                      at_least(square(minus(p[0], b[0])) + square(minus(p[1], b[1])), r_squared);
  if (clear == Truth::no) return Truth::no;
  const Number along = wx * ex + wy * ey, length_squared = square(ex) + square(ey);
  const Truth beyond = at_least(Number(0), along) | at_least(along, length_squared);
  if (beyond == Truth::yes) return clear;
  return clear & (beyond | at_least(square(wx * ey - wy * ex), r_squared * length_squared));
}

/// Whether the ray from p along the first axis crosses the edge between a and b. The lower end belongs to the
/// edge, the upper does not, so a line through a corner is crossed there once, and one that only touches the
/// ray twice or not at all. For p on the edge the answer does not matter: no disc around it clears the edge.
template <class Number>
Truth crossing_to_the_right(const Vector<2>& p, const Vector<2>& a, const Vector<2>& b) {
  if ((a[1] > p[1]) == (b[1] > p[1])) return Truth::no;
  const auto minus = [](double s, double t) { return Number(s) - Number(t); };
  const Number side = minus(b[0], a[0]) * minus(p[1], a[1]) - minus(b[1], a[1]) * minus(p[0], a[0]);
  return b[1] > a[1] ? is_positive(side.sign()) : is_negative(side.sign());
}

}  // namespace bernal::verify

#include "verify/revolved_wall.hpp"

#include <algorithm>
#include <cmath>

#include "verify/predicates.hpp"
#include "verify/space.hpp"

namespace bernal::verify {
namespace {

/// The sign of x + y √d for d >= 0.
template <class Number>
Sign sign_with_root(const Number& x, const Number& y, const Number& d) {
  const Sign sx = x.sign(), sy = y.sign(), sd = d.sign();
  if (sx == Sign::unknown || sy == Sign::unknown) return Sign::unknown;
  if (sx == sy || sy == Sign::zero || sd == Sign::zero) return sx;
  if (sd == Sign::unknown) return Sign::unknown;
  if (sx == Sign::zero) return sy;
  const Sign larger = (square(x) - square(y) * d).sign();
  return sx == Sign::positive ? larger : -larger;
}

/// A centre about the axis a: |a| r is the root of X = |w × a|² and |a| z is h = w·a, with |a| that of N.
template <class Number>
struct AboutAxis {
  AboutAxis(const Vector<3>& c, const Revolved& solid)
      : w(difference<Number>(c, solid.base)),
        a(vector<Number>(solid.axis)),
        X(squared_norm(cross(w, a))),
        h(dot(w, a)),
        N(squared_norm(a)),
        squared(squared_norm(w)) {}

  /// The sign of x + y √X + (u + v √X) √N: with both brackets of one sign theirs; else their squares tell.
  Sign sign(const Number& x, const Number& y, const Number& u, const Number& v) const {
    const Sign one = sign_with_root(x, y, X), other = sign_with_root(u, v, X);
    if (one == Sign::unknown || other == Sign::unknown) return Sign::unknown;
    if (one == other || other == Sign::zero) return one;
    if (one == Sign::zero) return other;
    const Number difference = square(x) + square(y) * X - N * (square(u) + square(v) * X);
    const Number product = x * y - N * (u * v);
    const Sign larger = sign_with_root(difference, product + product, X);
    return one == Sign::positive ? larger : -larger;
  }

  Triple<Number> w, a;
  Number X, h, N, squared;
};

template <class Number>
Truth not_negative(const AboutAxis<Number>& p, const Number& x, const Number& y, const Number& u,
                   const Number& v) {
  return !is_negative(p.sign(x, y, u, v));
}

/// |a| ((r - qr)² + (z - qz)² - R²) >= 0
template <class Number>
Truth clears_circle(const AboutAxis<Number>& p, const Vector<2>& q, const Number& squared_reach) {
  const Number r(q[0]), z(q[1]), two(2);
  return not_negative(p, Number(0) - two * z * p.h, Number(0) - two * r,
                      p.squared + square(r) + square(z) - squared_reach, Number(0));
}

/// |a| ((r, z) - q)·e >= 0
template <class Number>
Truth is_past(const AboutAxis<Number>& p, const Vector<2>& q, const Number& er, const Number& ez) {
  return not_negative(p, ez * p.h, er, Number(0) - (Number(q[0]) * er + Number(q[1]) * ez), Number(0));
}

/// Whether the distance of the centre from what the edge sweeps over is at least the reach.
template <class Number>
Truth ball_clears_swept_edge(const Vector<3>& c, const Reach& reach, const Revolved& solid,
                             const Vector<2>& a, const Vector<2>& b) {
  const AboutAxis<Number> p(c, solid);
  const Number squared_reach = square(reach.as<Number>());
  const Truth clear = clears_circle(p, a, squared_reach) & clears_circle(p, b, squared_reach);
  if (clear == Truth::no) return Truth::no;
  const Number er = Number(b[0]) - Number(a[0]), ez = Number(b[1]) - Number(a[1]);
  const Number minus_er = Number(0) - er, minus_ez = Number(0) - ez;
  const Truth beyond = is_past(p, a, minus_er, minus_ez) | is_past(p, b, er, ez);
  if (beyond == Truth::yes) return clear;
  // The square of |a| ((r, z) - a) × e = ez √X - er h + k √N
  const Number k = Number(a[1]) * er - Number(a[0]) * ez, g = minus_er * p.h, two(2);
  const Number whole =
      square(ez) * p.X + square(k) * p.N + square(g) - squared_reach * (square(er) + square(ez)) * p.N;
  return clear & (beyond | not_negative(p, whole, two * ez * g, two * k * g, two * ez * k));
}

/// Whether the ray from the centre straight away from the axis crosses what the edge sweeps over. The lower
/// end belongs to the edge, the upper does not.
template <class Number>
Truth crossing_outwards(const Vector<3>& c, const Revolved& solid, const Vector<2>& a, const Vector<2>& b) {
  const AboutAxis<Number> p(c, solid);
  const Number zero(0), minus_h = zero - p.h;
  const Truth a_above = is_positive(p.sign(minus_h, zero, Number(a[1]), zero));
  const Truth b_above = is_positive(p.sign(minus_h, zero, Number(b[1]), zero));
  if (a_above == Truth::unknown || b_above == Truth::unknown) return Truth::unknown;
  if (a_above == b_above) return Truth::no;
  const Number er = Number(b[0]) - Number(a[0]), ez = Number(b[1]) - Number(a[1]);
  const Number k = Number(a[1]) * er - Number(a[0]) * ez;
  const Sign side = p.sign(zero - er * p.h, ez, k, zero);
  return b[1] > a[1] ? is_negative(side) : is_positive(side);
}

}  // namespace

RevolvedWall::RevolvedWall(const Revolved& solid)
    : solid_(solid), unit_axis_(solid.axis.stableNormalized()), edges_(edges_of(solid)) {
  for (const Vector<2>& p : solid.profile) extent_ = std::max(extent_, p.cwiseAbs().maxCoeff());
}

std::vector<PlaneEdge> RevolvedWall::edges_of(const Revolved& solid) {
  require(solid.base.allFinite() && solid.axis.allFinite() && !solid.axis.isZero(0),
          "a solid of revolution needs a finite base and an axis that is finite and not zero");
  std::vector<PlaneEdge> edges;
  const std::size_t n = solid.profile.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vector<2>&a = solid.profile[k], &b = solid.profile[(k + 1) % n];
    require(a.allFinite() && a[0] >= 0, "a profile needs finite points that are not beyond its axis");
    if (a[0] != 0 || b[0] != 0) edges.push_back({a, b});  // what lies on the axis is no wall
  }
  require(!edges.empty(), "a solid of revolution needs a profile");
  return edges;
}

WallState RevolvedWall::wall_state_of(const Ball<3>& ball, const CertifyOptions& options, double /*least*/,
                                      Tally& tally) const {
  const Arithmetic arithmetic = options.arithmetic;
  const Reach reach{ball.r, options.wall_gap};
  const Vector<3> w = ball.c - solid_.base, across = w.cross(unit_axis_);
  const Vector<2> place(std::hypot(across[0], across[1], across[2]), w.dot(unit_axis_));
  // The unit axis and w are off by a few roundoffs, and so are the products.
  const double rounding = 64 * tolerance::roundoff * (w.lpNorm<1>() + extent_);
  const Box<2> around = widened(box_of_ball<2>(place, rounding), 0);
  const double distance_to_nearest = distance_from_nearest(place, around, ball.r);
  bool clear = true;
  // At least the nearest edge is decided, so that the gap of every ball is known.
  const double looked = std::max(ball.r + wall_distances_known_up_to(options), distance_to_nearest);
  edges_.for_each_touching(widened(around, rounded_up(looked)), [&](const PlaneEdge& edge) {
    ++tally.walls;
    clear &= decide(arithmetic, tally.decisions, [&]<class Number>() {
               return ball_clears_swept_edge<Number>(ball.c, reach, solid_, edge.a, edge.b);
             }) == Truth::yes;
  });

  const bool inside = center_inside(ball, around, arithmetic, tally);
  const double distance = inside ? distance_to_nearest : -distance_to_nearest;
  const bool holds = inside && clear;
  WallState state{.inside = holds};
  state.add(distance, reach, holds);
  return state;
}

/// In boxes that become larger until one holds the nearest edge for certain.
double RevolvedWall::distance_from_nearest(const Vector<2>& place, const Box<2>& around, double first) const {
  double nearest = Box<2>::infinity;
  for (double looked = first;; looked = nearest < Box<2>::infinity ? nearest : 4 * looked) {
    edges_.for_each_touching(widened(around, rounded_up(looked)), [&](const PlaneEdge& edge) {
      nearest = std::min(nearest, distance_from_segment<2>(place, edge.a, edge.b));
    });
    if (nearest <= looked) return nearest;
  }
}

bool RevolvedWall::center_inside(const Ball<3>& ball, const Box<2>& place, Arithmetic arithmetic,
                                 Tally& tally) const {
  const Box<2> outwards{{place.lower[0], place.lower[1]}, {Box<2>::infinity, place.upper[1]}};
  bool odd = false;
  Decisions crossings;
  edges_.for_each_touching(outwards, [&](const PlaneEdge& edge) {
    odd ^= decide(arithmetic, crossings, [&]<class Number>() {
             return crossing_outwards<Number>(ball.c, solid_, edge.a, edge.b);
           }) == Truth::yes;
  });
  ++tally.centers;
  const bool by_double = arithmetic == Arithmetic::filtered && crossings.by_exact == 0;
  ++(by_double ? tally.decisions.by_double : tally.decisions.by_exact);
  return odd;
}

}  // namespace bernal::verify

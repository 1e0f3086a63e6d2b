#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/tolerance.hpp"
#include "domain/exact_way.hpp"
#include "domain/frustum.hpp"
#include "domain/last_clear.hpp"

namespace bernal {
namespace {

constexpr double largest_finite = std::numeric_limits<double>::max();

/// The sign of x + y·√d, d >= 0.
int sign_of(const Dyadic& x, const Dyadic& y, const Dyadic& d) {
  const int sx = x.sign(), sy = d.sign() == 0 ? 0 : y.sign();
  if (sy == 0 || sx == sy) return sx;
  if (sx == 0) return sy;
  return sx * (square(x) - square(y) * d).sign();
}

/// u0 + u1·√X
struct Surd {
  Dyadic u0 = 0, u1 = 0;
};

/// A point about an axis: |a| r is the root of X = |w × a|², |a| z is h = w·a, and |a| that of N.
struct AboutAxis {
  AboutAxis(const ProfileEdge& edge, const ExactVector& p) {
    const ExactVector w = p - exact(edge.base), a = exact(edge.axis), across = cross(w, a);
    X = dot(across, across);
    h = dot(w, a);
    N = dot(a, a);
    squared = dot(w, w);
  }
  /// The sign of u + v·√N.
  int sign(const Surd& u, const Surd& v) const {
    const int su = sign_of(u.u0, u.u1, X), sv = sign_of(v.u0, v.u1, X);
    if (sv == 0 || su == sv) return su;
    if (su == 0) return sv;
    const Dyadic rational = square(u.u0) + square(u.u1) * X - N * (square(v.u0) + square(v.u1) * X);
    const Dyadic two = 2;
    return su * sign_of(rational, two * (u.u0 * u.u1 - N * v.u0 * v.u1), X);
  }
  Dyadic X, h, N, squared;
};

struct ExactEdge {
  explicit ExactEdge(const ProfileEdge& edge)
      : ax(edge.a[0]), ay(edge.a[1]), bx(edge.b[0]), by(edge.b[1]), ex(bx - ax), ey(by - ay) {}

  /// |a| times (p - q)·e.
  int along(const AboutAxis& p, const Dyadic& qx, const Dyadic& qy) const {
    return p.sign({ey * p.h, ex}, {-(qx * ex + qy * ey), 0});
  }
  bool end_clears(const AboutAxis& p, const Dyadic& qx, const Dyadic& qy, const Dyadic& rr) const {
    const Dyadic minus_two = -2;
    return p.sign({minus_two * qy * p.h, minus_two * qx}, {p.squared + square(qx) + square(qy) - rr, 0}) >= 0;
  }
  /// |a| times (p - a) × e, as  e1 √X - e0 h + beta √N.
  Dyadic beta() const { return ay * ex - ax * ey; }
  bool line_clears(const AboutAxis& p, const Dyadic& rr) const {
    const Dyadic gamma = -(ex * p.h), b = beta(), two = 2;
    const Dyadic rational =
        square(ey) * p.X + square(b) * p.N + square(gamma) - rr * (square(ex) + square(ey)) * p.N;
    return p.sign({rational, two * ey * gamma}, {two * b * gamma, two * ey * b}) >= 0;
  }

  Dyadic ax, ay, bx, by, ex, ey;
};

}  // namespace

bool clears_exactly(const ProfileEdge& edge, const ExactVector& center, double r) {
  ++exact_decisions;
  const AboutAxis p(edge, center);
  const ExactEdge e(edge);
  const Dyadic rr = square(Dyadic(r));
  if (e.along(p, e.ax, e.ay) <= 0) return e.end_clears(p, e.ax, e.ay, rr);
  if (e.along(p, e.bx, e.by) >= 0) return e.end_clears(p, e.bx, e.by, rr);
  return e.line_clears(p, rr);
}

bool is_crossed_outwards_exactly(const ProfileEdge& edge, const ExactVector& center) {
  const AboutAxis p(edge, center);
  const ExactEdge e(edge);
  const auto is_above = [&](const Dyadic& z) { return p.sign({-p.h, 0}, {z, 0}) > 0; };
  if (is_above(e.ay) == is_above(e.by)) return false;
  const int side = p.sign({-(e.ex * p.h), e.ey}, {e.beta(), 0});  // of (p - a) × e
  return e.ey.sign() > 0 ? side < 0 : side > 0;
}

double free_path(const ProfileEdge& edge, const Motion& m, WallArithmetic arithmetic) {
  using Real = FrustumWay::Real;
  // Of its ends, of which the farther one is nine times as far as everything.
  const double lengths = 9 * ((m.c - edge.base).norm() + m.r + edge.a.lpNorm<1>() + edge.b.lpNorm<1>());
  if (arithmetic == WallArithmetic::filtered &&
      keeps_inside(edge, m.c, m.direction, m.limit, m.r + 64 * tolerance::roundoff * lengths))
    return m.limit;
  const FrustumWay way(edge, m.c, m.direction);
  const auto clears = [&](double t) { return clears_exactly(edge, place_after(m, t), m.r); };
  if (!(way.distance(0) > m.r + way.error(0, m.r)) && !clears(0)) return 0;
  const double limit = std::min(m.limit, largest_finite);
  if (!(way.speed() > 0)) return m.limit;
  Real from = 0;
  constexpr int most_grazes = 16;
  for (int graze = 0; graze < most_grazes; ++graze) {
    const Real t = way.first_below(m.r, from, limit);
    const bool ends = t == FrustumWay::never;
    if (ends && (!std::isfinite(m.limit) || way.distance(limit) > m.r + way.error(limit, m.r)))
      return m.limit;
    const Real at = ends ? Real(limit) : t;
    const Real slack = tolerance::roundoff * ((way.lengths() + m.r) / way.speed() + 2 * at);
    const Real before = std::max(from, at - slack), beyond = std::min<Real>(limit, at + slack);
    if (arithmetic == WallArithmetic::filtered && way.distance(before) > m.r + way.error(before, m.r) &&
        way.distance(beyond) < m.r - way.error(beyond, m.r)) {
      const auto rounded = static_cast<double>(before);
      return rounded > before ? std::nextafter(rounded, 0.0) : rounded;
    }
    double past = static_cast<double>(at);
    bool found = false;
    Real step = slack;
    for (int k = 0; k < 8 && !found; ++k, step *= 2) {
      past = static_cast<double>(std::min<Real>(limit, at + step));
      found = !clears(past);
      if (past >= limit) break;
    }
    if (found) return last_clear(static_cast<double>(at), past, clears);
    if (past >= limit) return m.limit;
    from = past;
  }
  return static_cast<double>(from);
}

double first_contact_exactly(const ProfileEdge& edge, const Motion& m, double skin) {
  const double stop = m.r + skin, ignore = m.r + 0.5 * skin;
  const double limit = std::min(m.limit, largest_finite);
  const auto clears = [&](double t, double r) { return clears_exactly(edge, place_after(m, t), r); };
  const double guess = first_contact_with_frustum(edge, m.c, m.r, m.direction, m.limit, skin);
  if (guess >= m.limit) {
    if (!std::isfinite(m.limit) || clears(limit, ignore) || !clears(0, ignore)) return m.limit;
    return free_path(edge, {m.c, ignore, m.direction, m.limit}, WallArithmetic::exact);
  }
  if (clears(0, stop)) return free_path(edge, {m.c, stop, m.direction, m.limit}, WallArithmetic::exact);
  return guess;
}

}  // namespace bernal

#include "domain/frustum.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include <Eigen/Geometry>

namespace bernal {
namespace {

using Real = FrustumWay::Real;

constexpr Real never = FrustumWay::never;
constexpr Real tiny = LDBL_EPSILON;

/// The roots of a t² + 2 b t + c, ascending; none, one or two.
int roots_of(Real a, Real b, Real c, Real (&roots)[2]) {
  if (a == 0) {
    if (b == 0) return 0;
    roots[0] = -c / (2 * b);
    return 1;
  }
  const Real discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return 0;
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b));
  roots[0] = q / a;
  roots[1] = q != 0 ? c / q : 0;
  if (roots[1] < roots[0]) std::swap(roots[0], roots[1]);
  return 2;
}

}  // namespace

Vector<2> in_half_plane(const Vector<3>& p, const Vector<3>& base, const Vector<3>& unit_axis) {
  const Vector<3> w = p - base;
  const double z = w.dot(unit_axis);
  return {(w - z * unit_axis).norm(), z};
}

Vector<2> nearest_of_edge(const Vector<2>& p, const Vector<2>& a, const Vector<2>& b) {
  const Vector<2> e = b - a, w = p - a;
  const double along = w.dot(e), squared = e.squaredNorm();
  if (!(along > 0)) return a;
  if (along >= squared) return b;
  return a + (along / squared) * e;
}

ProfileEdge edge_of(const Facet& f) { return {f.a, f.b, {f.c[0], 0}, {f.c[1], f.c[2]}}; }

Facet facet_of(const ProfileEdge& edge, std::uint32_t id) {
  Facet f;
  f.kind = Facet::Kind::frustum;
  f.id = id;
  f.b = edge.axis.stableNormalized();
  f.a = edge.base + edge.a[1] * f.b;
  f.c = {edge.a[0], edge.b[0], edge.b[1] - edge.a[1]};
  return f;
}

FrustumWay::FrustumWay(const ProfileEdge& edge, const Vector<3>& c, const Vector<3>& direction)
    : a_{edge.a[0], edge.a[1]},
      e_{static_cast<Real>(edge.b[0]) - edge.a[0], static_cast<Real>(edge.b[1]) - edge.a[1]},
      length_(std::hypot(e_[0], e_[1])) {
  const LongVector axis = edge.axis.cast<Real>().stableNormalized();
  const LongVector w = c.cast<Real>() - edge.base.cast<Real>(), v = direction.cast<Real>();
  z_ = w.dot(axis);
  vz_ = v.dot(axis);
  p_ = w - z_ * axis;
  v_ = v - vz_ * axis;
  pp_ = p_.squaredNorm();
  pv_ = p_.dot(v_);
  vv_ = v_.squaredNorm();
  speed_ = v.norm();
  lengths_ = w.norm() + std::abs(a_[0]) + std::abs(a_[1]) + length_;
}

FrustumWay::Point FrustumWay::at(Real t) const { return {(p_ + t * v_).norm(), z_ + t * vz_}; }

Real FrustumWay::distance(Real t) const {
  const Point p = at(t);
  const Real x = p[0] - a_[0], y = p[1] - a_[1], along = x * e_[0] + y * e_[1];
  if (!(along > 0)) return std::hypot(x, y);
  if (along >= length_ * length_) return std::hypot(x - e_[0], y - e_[1]);
  return std::abs(x * e_[1] - y * e_[0]) / length_;
}

Real FrustumWay::error(Real t, double r) const { return 64 * tiny * (lengths_ + std::abs(t) * speed_ + r); }

Real FrustumWay::line_distance(Real t) const {
  const Point p = at(t);
  return std::abs((p[0] - a_[0]) * e_[1] - (p[1] - a_[1]) * e_[0]) / length_;
}

FrustumWay::Crossing FrustumWay::line_below(Real R, Real from, Real limit) const {
  const Real n0 = e_[1] / length_, n1 = -e_[0] / length_;
  Crossing first;
  for (const Real side : {Real(1), Real(-1)}) {
    const Real k = side * R + n0 * a_[0] + n1 * (a_[1] - z_), m = n1 * vz_;
    Real roots[2];
    const int count =
        n0 == 0 ? roots_of(0, Real(-0.5) * m, k, roots)
                : roots_of(n0 * n0 * vv_ - m * m, n0 * n0 * pv_ + k * m, n0 * n0 * pp_ - k * k, roots);
    for (int i = 0; i < count; ++i) {
      const auto offset = [&](Real t) { return side * (n0 * at(t)[0] - (k - m * t)); };
      const auto slope = [&](Real t) {
        const Real r = at(t)[0];
        return side * (n0 * (r > 0 ? (pv_ + t * vv_) / r : std::sqrt(vv_)) + m);
      };
      Real t = roots[i];
      for (int step = 0; step < 6 && slope(t) != 0; ++step) {  // what cancels in the coefficients
        const Real next = t - offset(t) / slope(t);
        if (!(std::abs(offset(next)) < std::abs(offset(t)))) break;
        t = next;
      }
      // Of the other sign of the root, or of a way that leads away.
      if (std::abs(offset(t)) > std::sqrt(tiny) * (lengths_ + R + std::abs(t) * speed_) || !(slope(t) < 0))
        continue;
      if (!(t >= from && t <= limit)) continue;
      first.of_line = std::min(first.of_line, t);
      const Point p = at(t);
      const Real along = (p[0] - a_[0]) * e_[0] + (p[1] - a_[1]) * e_[1];
      const Real rounding = 256 * tiny * length_ * (lengths_ + t * speed_);
      if (along >= -rounding && along <= length_ * length_ + rounding)
        first.of_edge = std::min(first.of_edge, t);
    }
  }
  return first;
}

Real FrustumWay::end_below(const Point& end, Real R, Real from, Real limit) const {
  if (!(speed_ > 0)) return never;
  const Real r0 = end[0], dz = z_ - end[1];
  const Real a = vv_ + vz_ * vz_, b = pv_ + vz_ * dz, c = (r0 - R) * (r0 + R) + pp_ + dz * dz;
  const Real size = lengths_ + R;
  limit = std::min(limit, 4 * size / speed_);  // farther on it is far from the piece for good
  const Real rounding = 16 * tiny * size * R;
  const auto excess = [&](Real t) {
    const Point p = at(t);
    const Real d = std::hypot(p[0] - r0, p[1] - end[1]);
    return (d - R) * (d + R);
  };
  const auto falls = [&](Real t) {
    const Real r = at(t)[0];
    return b + t * a - r0 * (r > 0 ? (pv_ + t * vv_) / r : 0) < 0;
  };
  // One that touches at the start and comes off.
  if (excess(from) <= rounding) {
    if (falls(from)) return from;
    Real step = 4 * tiny * size / speed_;
    while (from < limit && excess(from) <= rounding) {
      const Real next = from + step;
      if (excess(next) < excess(from) - rounding) return from;
      from = next;
      step *= 2;
    }
  }
  struct Part {
    Real begin, end;
  };
  // Halves of halves, the first on top: one a halving, of which doubles of 64 bits allow no more than these.
  std::array<Part, 96> parts;
  std::size_t left = 0;
  parts[left++] = {from, limit};
  constexpr int most = 4000;
  for (int k = 0; left > 0; ++k) {
    auto [begin, last] = parts[--left];
    if (!(begin <= last)) continue;
    const Real low = at(begin)[0], slope = last > begin ? (at(last)[0] - low) / (last - begin) : 0;
    Real roots[2];
    if (roots_of(a, b - r0 * slope, c - 2 * r0 * (low - slope * begin), roots) < 2) continue;
    begin = std::max(begin, roots[0]);
    last = std::min(last, roots[1]);
    if (!(begin <= last)) continue;
    if (excess(begin) <= rounding && falls(begin)) return begin;
    const bool gives_up = k > most || left + 2 > parts.size();
    if (gives_up || (last - begin) * speed_ <= 8 * tiny * size) {
      if (excess(begin) <= rounding || gives_up) return begin;
      continue;
    }
    const Real middle = begin + (last - begin) / 2;
    parts[left++] = {middle, last};
    parts[left++] = {begin, middle};
  }
  return never;
}

Real FrustumWay::first_below(Real R, Real from, Real limit) const {
  if (!(R > 0) || !(from <= limit)) return never;
  Real first = never;
  if (length_ > 0) {
    const Crossing crossing = line_below(R, from, limit);
    first = crossing.of_edge;
    // Until it comes near the line it is near no end.
    if (line_distance(from) >= R) {
      if (crossing.of_line == never) return never;
      from = std::max(from, crossing.of_line - 64 * tiny * (lengths_ + R) / speed_);
    }
  }
  first = std::min(first, end_below(a_, R, from, std::min(first, limit)));
  return std::min(first, end_below({a_[0] + e_[0], a_[1] + e_[1]}, R, from, std::min(first, limit)));
}

bool keeps_inside(const ProfileEdge& edge, const Vector<3>& c, const Vector<3>& direction, double limit,
                  double distance) {
  const double squared_axis = edge.axis.squaredNorm();
  const Vector<2> e = edge.b - edge.a;
  const double length = e.norm();
  const double speed = direction.norm();
  if (!(length > 0) || !(squared_axis > 0) || !(speed > 0)) return false;
  // Farther on it is far from the piece for good.
  limit = std::min(limit, 8 / speed * ((c - edge.base).norm() + edge.a.norm() + edge.b.norm() + distance));
  const Vector<3> axis = edge.axis / std::sqrt(squared_axis);
  const auto side_of = [&](const Vector<3>& p) {
    const Vector<2> w = in_half_plane(p, edge.base, axis) - edge.a;
    return (e[1] * w[0] - e[0] * w[1]) / length;
  };
  const double start = side_of(c), side = start < 0 ? -1 : 1;
  if (side * e[1] > 0 || !(side * start >= distance)) return false;
  return side * side_of(c + limit * direction) >= distance;
}

double first_contact_with_frustum(const ProfileEdge& edge, const Vector<3>& c, double r,
                                  const Vector<3>& direction, double limit, double skin) {
  if (keeps_inside(edge, c, direction, limit, r + 0.5 * skin)) return limit;
  const FrustumWay way(edge, c, direction);
  const Real stop = static_cast<Real>(r) + skin, ignore = r + Real(0.5) * skin;
  // No way is longer than where everything is behind.
  const Real end = std::min<Real>(limit, 4 * (way.lengths() + stop));
  const Real start = way.distance(0);
  if (start - stop >= end) return limit;
  const auto rounded = [&](Real t) { return std::clamp(static_cast<double>(t), 0.0, limit); };
  Real from = 0;
  if (start < ignore) {
    Real step = Real(1e-3) * skin, before = start;
    if (!(way.distance(step) > start)) return 0;
    while (from < end && before < ignore) {
      const Real next = std::min(from + step, end), there = way.distance(next);
      if (there < before) return rounded(from);
      before = there;
      from = next;
      step *= 2;
    }
    if (from >= end) return limit;
  }
  const Real ignored = way.first_below(ignore, from, end);
  if (ignored == never) return limit;
  if (way.distance(from) < stop) {
    if (from == 0) return 0;
    Real step = Real(0.1) * skin;  // comes off still
    while (from < ignored && way.distance(from) < stop) {
      if (!(way.distance(from + step) > way.distance(from))) return rounded(from);
      from += step;
    }
  }
  return rounded(std::min(ignored, way.first_below(stop, from, end)));
}

}  // namespace bernal

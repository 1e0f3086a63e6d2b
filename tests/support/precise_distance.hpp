#pragma once
#include <array>
#include <cmath>

#include "bernal/domain/facet.hpp"

namespace bernal::test {

// Distances by the plainest formulas there are, in arithmetic so wide (`Real`: long double, or a hundred
// digits of Boost.Multiprecision) that rounding plays no part. The oracles for kernels/ and domain/.

template <class Real>
struct Point {
  Real x, y, z;
  Point(Real x_, Real y_, Real z_) : x(x_), y(y_), z(z_) {}
  Point(const Vector<3>& v) : x(v[0]), y(v[1]), z(v[2]) {}
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point operator*(const Real& s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Real dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend Real norm(const Point& a) {
    using std::sqrt;
    return sqrt(dot(a, a));
  }
};

/// p minus the nearest point of the segment.
template <class Real>
Point<Real> precise_offset(const Point<Real>& p, const Point<Real>& a, const Point<Real>& b) {
  const Point<Real> ab = b - a, w = p - a;
  const Real along = dot(w, ab), squared = dot(ab, ab);
  if (along <= 0) return w;
  if (along >= squared) return p - b;
  return w - Real(along / squared) * ab;
}

/// p minus the nearest point of the triangle: of its plane if the foot lies inside, else of its edges.
template <class Real>
Point<Real> precise_offset(const Point<Real>& p, const Point<Real>& a, const Point<Real>& b,
                           const Point<Real>& c) {
  const Point<Real> n = cross(b - a, c - a);
  const Real squared = dot(n, n);
  if (squared > 0 && dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
      dot(cross(a - c, p - c), n) >= 0)
    return Real(dot(p - a, n) / squared) * n;
  Point<Real> nearest = precise_offset(p, a, b);
  for (const auto& [s, e] : {std::pair{b, c}, std::pair{c, a}}) {
    const Point<Real> other = precise_offset(p, s, e);
    if (dot(other, other) < dot(nearest, nearest)) nearest = other;
  }
  return nearest;
}

template <class Real>
Real precise_distance(const Facet& f, const Point<Real>& p) {
  const Point<Real> a = f.a, b = f.b;
  switch (f.kind) {
    case Facet::Kind::plane:
      return dot(p - a, b);
    case Facet::Kind::cylinder: {
      const Point<Real> w = p - a;
      return Real(f.radius) - norm(w - Real(dot(w, b) / dot(b, b)) * b);
    }
    case Facet::Kind::sphere:
      return Real(f.radius) - norm(p - a);
    case Facet::Kind::frustum: {
      const Point<Real> w = p - a;
      const Real z = dot(w, b) / norm(b);
      const Point<Real> across = w - Real(z / norm(b)) * b;
      return norm(precise_offset(Point<Real>(norm(across), z, 0), Point<Real>(f.c[0], 0, 0),
                                 Point<Real>(f.c[1], f.c[2], 0)));
    }
    case Facet::Kind::triangle:
      break;
  }
  return norm(precise_offset(p, a, b, Point<Real>(f.c)));
}

}  // namespace bernal::test

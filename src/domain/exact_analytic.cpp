#include "domain/exact_analytic.hpp"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

namespace bernal {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using ExactVector = std::array<Rational, 3>;

ExactVector difference(const Vector<3>& a, const Vector<3>& b) {
  return {Rational(a[0]) - Rational(b[0]), Rational(a[1]) - Rational(b[1]), Rational(a[2]) - Rational(b[2])};
}

Rational dot(const ExactVector& a, const ExactVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

bool contains_exactly(const Box& shape, const Vector<3>& c, double r) {
  const Bounds<3> bounds = bounds_of(shape);
  for (int k = 0; k < 3; ++k) {
    if (shape.repeats(k)) continue;
    if (Rational(c[k]) - Rational(bounds.lower[k]) < Rational(r)) return false;
    if (Rational(bounds.upper[k]) - Rational(c[k]) < Rational(r)) return false;
  }
  return true;
}

bool contains_exactly(const Cylinder& shape, const Vector<3>& c, double r) {
  if (r > shape.radius || (r > shape.height && !shape.periodic)) return false;
  const ExactVector w = difference(c, shape.base);
  const ExactVector axis = {Rational(shape.axis[0]), Rational(shape.axis[1]), Rational(shape.axis[2])};
  const Rational s = dot(w, axis);
  const Rational squared_axis = dot(axis, axis);
  const Rational squared_s = s * s;
  const Rational radius = r;
  if (!shape.periodic) {
    if (s < 0 || squared_s < radius * radius * squared_axis) return false;
    const Rational reach = Rational(shape.height) - radius;
    if (squared_s > reach * reach * squared_axis) return false;
  }
  const Rational room = Rational(shape.radius) - radius;
  return dot(w, w) * squared_axis - squared_s <= room * room * squared_axis;
}

bool contains_exactly(const Sphere& shape, const Vector<3>& c, double r) {
  if (r > shape.radius) return false;
  const ExactVector w = difference(c, shape.center);
  const Rational room = Rational(shape.radius) - Rational(r);
  return dot(w, w) <= room * room;
}

}  // namespace bernal

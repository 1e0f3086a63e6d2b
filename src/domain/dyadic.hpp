#pragma once
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>

#include "bernal/core/vector.hpp"

namespace bernal {

/// An integer times a power of two: what doubles are, and what sums and products of them are, without
/// rounding. There is no division and no root: a predicate is the sign of a polynomial. Cost: about 20 ns an
/// operation on numbers of a few hundred bits; up to a thousand need no memory of their own.
class Dyadic {
 public:
  /// Precondition: finite.
  Dyadic(double x = 0) {
    if (x == 0) return;
    constexpr int digits = 53;
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), digits));
    const int zeros = __builtin_ctzll(static_cast<unsigned long long>(mantissa));
    mantissa_ = mantissa >> zeros;
    exponent_ = exponent - digits + zeros;
  }

  /// -1, 0 or 1.
  int sign() const { return mantissa_.sign(); }

  Dyadic operator-() const { return {-mantissa_, exponent_}; }
  friend Dyadic operator*(const Dyadic& x, const Dyadic& y) {
    return {x.mantissa_ * y.mantissa_, x.exponent_ + y.exponent_};
  }
  friend Dyadic operator+(const Dyadic& x, const Dyadic& y) {
    if (x.sign() == 0) return y;
    if (y.sign() == 0) return x;
    if (x.exponent_ < y.exponent_) return y + x;
    return {(x.mantissa_ << static_cast<unsigned>(x.exponent_ - y.exponent_)) + y.mantissa_, y.exponent_};
  }
  friend Dyadic operator-(const Dyadic& x, const Dyadic& y) { return x + -y; }
  friend bool operator<(const Dyadic& x, const Dyadic& y) { return (x - y).sign() < 0; }
  friend bool operator<=(const Dyadic& x, const Dyadic& y) { return (x - y).sign() <= 0; }
  friend bool operator>(const Dyadic& x, const Dyadic& y) { return y < x; }
  friend bool operator>=(const Dyadic& x, const Dyadic& y) { return y <= x; }

 private:
  using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<1024>,
                                                boost::multiprecision::et_off>;
  Dyadic(Integer mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}

  Integer mantissa_ = 0;
  int exponent_ = 0;
};

inline Dyadic square(const Dyadic& x) { return x * x; }

using ExactVector = std::array<Dyadic, 3>;

inline ExactVector exact(const Vector<3>& v) { return {Dyadic(v[0]), Dyadic(v[1]), Dyadic(v[2])}; }
inline ExactVector operator+(const ExactVector& a, const ExactVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline ExactVector operator-(const ExactVector& a, const ExactVector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline ExactVector operator*(const Dyadic& s, const ExactVector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Dyadic dot(const ExactVector& a, const ExactVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline ExactVector cross(const ExactVector& a, const ExactVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace bernal

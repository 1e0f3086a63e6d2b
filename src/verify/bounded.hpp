#pragma once
#include <algorithm>
#include <cmath>

#include "bernal/core/tolerance.hpp"
#include "verify/sign.hpp"

namespace bernal::verify {

/// A real number known as a double with an error bound: |x - value| <= error.
///
/// Running error analysis (Wilkinson 1963; Higham, Accuracy and Stability of Numerical Algorithms, 2002,
/// section 3.3). With u = 2^-53 every operation fl(x ∘ y) has an error of at most u |fl(x ∘ y)|, plus 2^-1075
/// if a product underflows; sums and differences that underflow are exact. So
///   x + y:  error = ex + ey + u |v|
///   x × y:  error = |x| ey + |y| ex + ex ey + u |v| + tiny
/// with `tiny` above the five underflows (of the product, and of the four terms of its bound).
///
/// The bounds themselves are rounded: each is a sum of products of non-negative doubles, so too small by a
/// factor of at least (1 - u)^k after k operations. `sign` allows for k up to 2^22, a thousand times as many
/// as the longest predicate has. Overflow makes value and error infinite or NaN, and the sign unknown.
///
/// Cost: an addition 4, a product 9 floating-point operations, without branches.
class Bounded {
 public:
  explicit Bounded(double x) : value_(x), error_(0) {}

  Sign sign() const {
    constexpr double slack = 1 + 0x1p-30;
    const double error = slack * error_;
    if (value_ > error) return Sign::positive;
    if (-value_ > error) return Sign::negative;
    return error_ == 0 && value_ == 0 ? Sign::zero : Sign::unknown;
  }

  friend Bounded operator+(const Bounded& a, const Bounded& b) {
    const double value = a.value_ + b.value_;
    return {value, a.error_ + b.error_ + u * std::abs(value)};
  }
  friend Bounded operator-(const Bounded& a, const Bounded& b) {
    const double value = a.value_ - b.value_;
    return {value, a.error_ + b.error_ + u * std::abs(value)};
  }
  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    const double value = a.value_ * b.value_;
    const double propagated = std::abs(a.value_) * b.error_ + (std::abs(b.value_) + b.error_) * a.error_;
    return {value, propagated + u * std::abs(value) + tiny};
  }
  friend Bounded square(const Bounded& a) {
    const double value = a.value_ * a.value_;
    return {value, (2 * std::abs(a.value_) + a.error_) * a.error_ + u * value + tiny};
  }
  /// |x| and min(x, y) change by no more than their arguments. Precondition: no overflow so far.
  friend Bounded magnitude(const Bounded& a) { return {std::abs(a.value_), a.error_}; }
  friend Bounded smaller(const Bounded& a, const Bounded& b) {
    return {std::min(a.value_, b.value_), std::max(a.error_, b.error_)};
  }

 private:
  static constexpr double u = tolerance::roundoff;
  static constexpr double tiny = 0x1p-1070;

  Bounded(double value, double error) : value_(value), error_(error) {}

  double value_;
  double error_;
};

}  // namespace bernal::verify

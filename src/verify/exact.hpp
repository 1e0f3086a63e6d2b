#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

#include <boost/multiprecision/cpp_int.hpp>

#include "verify/sign.hpp"

namespace bernal::verify {

/// A dyadic rational m·2^e of any size: closed under +, - and ×, so every predicate on doubles that needs
/// neither division nor roots is evaluated without error.
///
/// Holds every finite double exactly. Cost: about 30 ns an operation up to 512 bits, which no predicate here
/// exceeds unless its arguments differ by many orders of magnitude; no limit beyond that.
class Exact {
 public:
  /// Precondition: finite.
  explicit Exact(double x) {
    if (x == 0) return;
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::frexp(x, &exponent) * 0x1p53);
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    mantissa_ = mantissa >> zeros;
    exponent_ = exponent - 53 + zeros;
  }

  Sign sign() const { return static_cast<Sign>(mantissa_.sign()); }

  friend Exact operator+(const Exact& a, const Exact& b) {
    if (a.mantissa_.is_zero()) return b;
    if (b.mantissa_.is_zero()) return a;
    const int exponent = std::min(a.exponent_, b.exponent_);
    return {(a.mantissa_ << (a.exponent_ - exponent)) + (b.mantissa_ << (b.exponent_ - exponent)), exponent};
  }
  friend Exact operator-(const Exact& a, const Exact& b) { return a + Exact(-b.mantissa_, b.exponent_); }
  friend Exact operator*(const Exact& a, const Exact& b) {
    return {a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_};
  }
  friend Exact square(const Exact& a) { return a * a; }
  friend Exact magnitude(const Exact& a) { return a.sign() == Sign::negative ? Exact(0) - a : a; }
  friend Exact smaller(const Exact& a, const Exact& b) { return (b - a).sign() == Sign::negative ? b : a; }

 private:
  using Integer = boost::multiprecision::number<
      boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                             boost::multiprecision::unchecked>,
      boost::multiprecision::et_off>;

  Exact(Integer mantissa, int exponent) : mantissa_(std::move(mantissa)), exponent_(exponent) {}

  Integer mantissa_ = 0;
  int exponent_ = 0;
};

}  // namespace bernal::verify

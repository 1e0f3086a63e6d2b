#include "verify/exact.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace bernal::verify {

Exact::Exact(double x) {
  if (x == 0) return;
  int exponent = 0;
  const auto mantissa = static_cast<std::int64_t>(std::frexp(x, &exponent) * 0x1p53);
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  mantissa_ = mantissa >> zeros;
  exponent_ = exponent - 53 + zeros;
}

Exact::Exact(const Integer& mantissa, int exponent) : mantissa_(mantissa), exponent_(exponent) {}
Exact::Exact(const Exact&) = default;
Exact& Exact::operator=(const Exact&) = default;
Exact::~Exact() = default;

Sign Exact::sign() const { return static_cast<Sign>(mantissa_.sign()); }

Exact operator+(const Exact& a, const Exact& b) {
  if (a.mantissa_.is_zero()) return b;
  if (b.mantissa_.is_zero()) return a;
  const int exponent = std::min(a.exponent_, b.exponent_);
  return {(a.mantissa_ << (a.exponent_ - exponent)) + (b.mantissa_ << (b.exponent_ - exponent)), exponent};
}
Exact operator-(const Exact& a, const Exact& b) { return a + Exact(-b.mantissa_, b.exponent_); }
Exact operator*(const Exact& a, const Exact& b) {
  return {a.mantissa_ * b.mantissa_, a.exponent_ + b.exponent_};
}

}  // namespace bernal::verify

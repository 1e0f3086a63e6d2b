#pragma once
#include <cmath>
#include <limits>

namespace bernal {

/// a + b less its rounding to a double: itself a double and found without error (Møller 1965; Knuth, The Art
/// of Computer Programming 2, section 4.2.2). Precondition, here and below: no overflow.
inline double rounding_of_sum(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  return (a - (sum - of_b)) + (b - of_b);
}
inline bool is_exact_sum(double a, double b) { return rounding_of_sum(a, b) == 0; }

/// a × b less its rounding to a double, without error where that is a double, as it is of an integer b below
/// 2^53 and any a, and of all that do not underflow (Dekker 1971). Precondition: no overflow.
inline double rounding_of_product(double a, double b) { return std::fma(a, b, -(a * b)); }

/// The least double that is not below a + b, and the largest that is not above it: the sum itself where it is
/// a double.
inline double sum_rounded_up(double a, double b) {
  const double sum = a + b;
  return rounding_of_sum(a, b) > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity()) : sum;
}
inline double sum_rounded_down(double a, double b) { return -sum_rounded_up(-a, -b); }

}  // namespace bernal

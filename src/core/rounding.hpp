#pragma once
#include <cmath>
#include <limits>

namespace bernal {

/// The least double that is not below a + b, and the largest that is not above it: the sum itself where it is
/// a double. The rounding error of a sum is a double and found without error (Møller 1965; Knuth, The Art of
/// Computer Programming 2, section 4.2.2). Precondition: no overflow.
inline double sum_rounded_up(double a, double b) {
  const double sum = a + b, of_b = sum - a;
  const double error = (a - (sum - of_b)) + (b - of_b);
  return error > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity()) : sum;
}
inline double sum_rounded_down(double a, double b) { return -sum_rounded_up(-a, -b); }

}  // namespace bernal

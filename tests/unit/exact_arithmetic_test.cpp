// The certificate's two number types against rational arithmetic: Exact is always right, Bounded is right or
// silent, and silent only near zero.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <boost/multiprecision/cpp_int.hpp>

#include "bernal/core/random.hpp"
#include "verify/bounded.hpp"
#include "verify/exact.hpp"

namespace bernal::verify {
namespace exact_arithmetic_test {

using Rational = boost::multiprecision::cpp_rational;

Rational square(const Rational& x) { return x * x; }
Rational magnitude(const Rational& x) { return abs(x); }
Rational smaller(const Rational& a, const Rational& b) { return a < b ? a : b; }
int sign(const Rational& x) { return x.sign(); }

/// x with about `digits` significant bits and any exponent in [-spread, spread].
double number(Random& random, int digits, int spread) {
  const double mantissa = std::round(std::ldexp(random.uniform(-1, 1), digits));
  return std::ldexp(mantissa, static_cast<int>(random.uniform(-spread, spread + 1.0)));
}

/// Polynomials that vanish for some of the drawn arguments and nearly vanish for others.
template <class Number>
Number determinant(const double* v) {
  const auto minus = [](double s, double t) -> Number { return Number(s) - Number(t); };
  return minus(v[0], v[1]) * minus(v[2], v[3]) - minus(v[4], v[1]) * minus(v[5], v[3]);
}
template <class Number>
Number sphere(const double* v) {
  return square(Number(v[0]) - Number(v[1])) + square(Number(v[2]) - Number(v[3])) -
         square(Number(v[4]) + Number(v[5]));
}
template <class Number>
Number high_degree(const double* v) {
  const Number a = determinant<Number>(v), b = sphere<Number>(v);
  return square(a) * b - square(b) * a * Number(v[0]);
}
/// The distance to the nearest of two images, less what it is in double.
template <class Number>
Number image_distance(const double* v) {
  const double d = std::abs(v[0] - v[1]), edge = d + std::abs(v[2]);
  const Number direct = magnitude(Number(v[0]) - Number(v[1]));
  return smaller(direct, Number(edge) - direct) - Number(std::min(d, edge - d));
}

class Signs : public ::testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Signs, AreRightOrUnknown) {
  const auto [digits, spread] = GetParam();
  Random random(1, stream(Stream::test));
  int zeros = 0, unknown = 0, total = 0;
  const auto expect_right = [&](const Rational& truth, const Exact& exact, const Bounded& bounded) {
    EXPECT_EQ(static_cast<int>(exact.sign()), sign(truth));
    const Sign guess = bounded.sign();
    EXPECT_TRUE(guess == Sign::unknown || static_cast<int>(guess) == sign(truth));
    zeros += sign(truth) == 0 ? 1 : 0;
    unknown += guess == Sign::unknown ? 1 : 0;
    ++total;
  };
  for (int trial = 0; trial < 2000; ++trial) {
    double v[6];
    for (double& x : v) x = number(random, digits, spread);
    if (trial % 3 == 0)
      v[4] = std::nextafter(v[0], v[1]), v[5] = std::nextafter(v[2], 0.0);  // nearly singular
    if (trial % 3 == 1) v[4] = v[0], v[5] = v[2];                           // singular
    expect_right(determinant<Rational>(v), determinant<Exact>(v), determinant<Bounded>(v));
    expect_right(sphere<Rational>(v), sphere<Exact>(v), sphere<Bounded>(v));
    expect_right(image_distance<Rational>(v), image_distance<Exact>(v), image_distance<Bounded>(v));
    expect_right(high_degree<Rational>(v), high_degree<Exact>(v), high_degree<Bounded>(v));
  }
  EXPECT_GT(zeros, 0);
  EXPECT_GT(unknown, 0);
  // A third is nearly singular and a third singular; far from 1 most products leave the range of double.
  if (spread < 100) {
    EXPECT_LT(unknown, 0.6 * total);
  }
}

// Small integers tie exactly; 53 bits round; the wide spreads underflow to subnormals and overflow.
INSTANTIATE_TEST_SUITE_P(Widths, Signs,
                         ::testing::Values(std::pair{3, 0}, std::pair{53, 0}, std::pair{53, 30},
                                           std::pair{20, 500}, std::pair{53, 900}));

TEST(Signs, OfSubnormalProducts) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ((Exact(tiny) * Exact(tiny)).sign(), Sign::positive);
  EXPECT_EQ((Bounded(tiny) * Bounded(tiny)).sign(), Sign::unknown);
  EXPECT_EQ((Bounded(tiny) - Bounded(tiny)).sign(), Sign::zero);
  EXPECT_EQ((Bounded(2 * tiny) - Bounded(tiny)).sign(), Sign::positive);
}

TEST(Signs, OfOverflowAreUnknown) {
  const double huge = std::numeric_limits<double>::max();
  EXPECT_EQ((Exact(huge) * Exact(huge) - Exact(huge)).sign(), Sign::positive);
  EXPECT_EQ((Bounded(huge) * Bounded(huge)).sign(), Sign::unknown);
  EXPECT_EQ((Bounded(huge) + Bounded(huge) - Bounded(huge)).sign(), Sign::unknown);
}

}  // namespace exact_arithmetic_test
}  // namespace bernal::verify

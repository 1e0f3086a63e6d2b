// The prediction against one that saves nothing: chords from the closed form in long double, found by
// bisection, and every rod put into the largest of all gaps by looking at all of them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/quadrature/exp_sinh.hpp>

#include "bernal/predict/predict.hpp"

namespace bernal {
namespace predict_oracle_test {

using Real = long double;

/// 1 - F(L) for lognormal diameters of median 1 by number: Farr 2013, eq. 26.
Real longer_chords(Real sigma, Real length) {
  const Real x = std::log(length) / (sigma * std::sqrt(Real{2}));
  return (std::erfc(x - std::sqrt(Real{2}) * sigma) -
          length * length * std::exp(-2 * sigma * sigma) * std::erfc(x)) /
         2;
}

std::vector<Real> rods_by_bisection(Real sigma, int count) {
  std::vector<Real> rods;
  for (int i = 1; i <= count; ++i) {
    const Real longer = (i - Real{0.5}) / count;
    Real low = 0, high = std::exp(12 * sigma);
    for (Real middle = high / 2; low < middle && middle < high; middle = low + (high - low) / 2)
      (longer_chords(sigma, middle) > longer ? low : high) = middle;
    rods.push_back(low);
  }
  return rods;
}

Real covered_the_slow_way(const std::vector<Real>& rods) {
  constexpr Real f = 0.7654L;
  std::vector<Real> gaps = {f * rods.front()};  // between the first rod and its own image
  for (std::size_t i = 1; i < rods.size(); ++i) {
    Real& gap = *std::ranges::max_element(gaps);
    const Real right = std::max(gap - (1 + f) * rods[i], f * rods[i]);
    gap = f * rods[i];
    gaps.push_back(right);
  }
  const Real length = std::accumulate(rods.begin(), rods.end(), Real{0});
  return length / (length + std::accumulate(gaps.begin(), gaps.end(), Real{0}));
}

TEST(PredictOracle, TheClosedFormIsTheIntegral) {
  // 1 - F(L) = ∫_L^∞ (D² - L²) p(D) dD / <D²>, with ln D normal and <D²> = exp(2 sigma²).
  boost::math::quadrature::exp_sinh<Real> integrator;
  for (const Real sigma : {0.3L, 0.5L, 1.0L})
    for (const Real length : {0.2L, 1.0L, 1.7L, 4.0L}) {
      const auto density = [&](Real d) {
        const Real z = std::log(d) / sigma;
        return (d * d - length * length) * std::exp(-z * z / 2) /
               (d * sigma * std::sqrt(2 * std::acos(-1.0L)));
      };
      const Real integral = integrator.integrate(density, length, std::numeric_limits<Real>::infinity());
      EXPECT_NEAR(static_cast<double>(integral * std::exp(-2 * sigma * sigma)),
                  static_cast<double>(longer_chords(sigma, length)), 1e-12);
    }
}

TEST(PredictOracle, SixteenThousandRodsToNineDigits) {
  // Chords to 2e-12 (chord_table.hpp) and sums of 16,000 numbers leave far less than this.
  constexpr double tolerance = 1e-9;
  constexpr int rods = 16000;
  for (const double sigma : {0.5, 1.0}) {
    const auto sizes = make_lognormal(1, sigma, Basis::number, 0, std::numeric_limits<double>::infinity());
    const Real slow = covered_the_slow_way(rods_by_bisection(sigma, rods));
    EXPECT_NEAR(predict_packing_fraction(*sizes, rods).phi, static_cast<double>(slow), tolerance)
        << "sigma " << sigma;
    RecordProperty(
        "difference",
        std::to_string(1e12 * static_cast<double>(predict_packing_fraction(*sizes, rods).phi - slow)) +
            "e-12");
  }
}

}  // namespace predict_oracle_test
}  // namespace bernal

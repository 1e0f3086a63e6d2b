#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Dense>
#include <boost/math/special_functions/gamma.hpp>

#include "bernal/core/error.hpp"
#include "bernal/sizes/size_distribution.hpp"
#include "support/size_cases.hpp"

namespace bernal {
namespace size_kinds_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(SizeMoments, HaveTheirClosedForms) {
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::number)->moment(1), 1.5);
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::number)->moment(2), 7.0 / 3);
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::number)->moment(-1), std::log(2.0));
  // Density 2/(1 - 1/4) r^-3 on [1, 2].
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::volume)->moment(1), 4.0 / 3);
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::volume)->moment(2), 8.0 / 3 * std::log(2.0));
  EXPECT_DOUBLE_EQ(make_uniform(1, 2, Basis::volume)->moment(3), 8.0 / 3);
  EXPECT_DOUBLE_EQ(make_lognormal(2, 0.3, Basis::number, 0, infinity)->moment(3), 8 * std::exp(4.5 * 0.09));
  // Volume shares 3 : 7 of radii 1 and 3 are numbers 3/1 : 7/27.
  EXPECT_DOUBLE_EQ(make_classes({3, 1}, {7, 3}, Basis::volume)->moment(1),
                   (3.0 + 7.0 / 9) / (3.0 + 7.0 / 27));
}

TEST(SizeMoments, OfANarrowDistributionLoseNoDigits) {
  // <r> of [1, 1 + w] by volume is 1 + w/2 - w²/4 + O(w³).
  const double w = 1e-8;
  EXPECT_NEAR((make_uniform(1, 1 + w, Basis::volume)->moment(1) - 1) / w, 0.5, 1e-6);
}

TEST(SizeMoments, OfRosinRammlerAreIncompleteGammaFunctions) {
  // By volume, <r^j> is r63^j times the integral of x^(j/n) e^-x between the cuts.
  const double r63 = 2, n = 1.7, min = 0.3, max = 5;
  const auto sizes = make_rosin_rammler(r63, n, min, max);
  const auto by_volume = [&](int j) {
    const double s = 1 + j / n;
    return std::pow(r63, j) *
           (boost::math::tgamma(s, std::pow(min / r63, n)) - boost::math::tgamma(s, std::pow(max / r63, n)));
  };
  for (const int j : {-1, 1, 2, 5})
    EXPECT_NEAR(sizes->moment(3 + j) / sizes->moment(3) / (by_volume(j) / by_volume(0)), 1, 1e-13) << j;
}

TEST(SizeMoments, OfAMixtureByVolumeHaveItsShares) {
  const auto a = make_uniform(1, 2, Basis::number), b = make_lognormal(5, 0.2, Basis::number, 0, infinity);
  const double a3 = a->moment(3), b3 = b->moment(3);
  const auto sizes =
      testing::mixture_of(make_uniform(1, 2, Basis::number),
                          make_lognormal(5, 0.2, Basis::number, 0, infinity), 0.2, Basis::volume);
  const double number_of_a = (0.2 / a3) / (0.2 / a3 + 0.8 / b3);
  EXPECT_NEAR(sizes->moment(1), number_of_a * a->moment(1) + (1 - number_of_a) * b->moment(1), 1e-13);
  EXPECT_NEAR(sizes->moment(3) / (number_of_a * a3), 5, 1e-12);
}

TEST(Normal, WithoutACutIsCutWhereNothingIs) {
  const auto sizes = make_normal(7, 1, Basis::number, 0, infinity);
  EXPECT_EQ(sizes->min(), 1);
  EXPECT_EQ(sizes->max(), 13);
  EXPECT_NEAR(sizes->moment(1), 7, 1e-13);
  EXPECT_NEAR(sizes->moment(2), 50, 1e-7);
}

TEST(Table, IsTheSplineThroughItsPoints) {
  // Where the density is positive its derivative is that of the cumulative; the points lie on it.
  const std::vector<double> x = {0.5, 0.8, 1.5, 1.7, 2.5, 4}, y = {0.2, 1, 2, 1.7, 0.6, 0.1};
  const auto sizes = make_table(x, y, Basis::number);
  const double h = 1e-4;
  std::vector<double> ratio;
  for (std::size_t i = 1; i + 1 < x.size(); ++i)
    ratio.push_back((sizes->cumulative(x[i] + h) - sizes->cumulative(x[i] - h)) / (2 * h) / y[i]);
  for (const double each : ratio) EXPECT_NEAR(each / ratio[0], 1, 1e-6);
}

/// The natural spline by brute force: all coefficients from one dense system of conditions.
double dense_spline(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto n = static_cast<Eigen::Index>(x.size()) - 1;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(4 * n);
  Eigen::Index row = 0;
  const auto derivative = [&](Eigen::Index i, double t, int order, double sign) {
    for (int k = order; k < 4; ++k) {
      double factor = sign * std::pow(t, k - order);
      for (int j = 0; j < order; ++j) factor *= k - j;
      a(row, 4 * i + k) = factor;
    }
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const double h = x[i + 1] - x[i];
    derivative(i, 0, 0, 1), b(row++) = y[i];
    derivative(i, h, 0, 1), b(row++) = y[i + 1];
    if (i + 1 == n) continue;
    for (const int order : {1, 2}) derivative(i, h, order, 1), derivative(i + 1, 0, order, -1), ++row;
  }
  derivative(0, 0, 2, 1), ++row;
  derivative(n - 1, x[n] - x[n - 1], 2, 1);
  const Eigen::VectorXd c = a.partialPivLu().solve(b);
  const auto i = std::min<Eigen::Index>(n - 1, std::ranges::upper_bound(x, at) - x.begin() - 1);
  const double t = at - x[i];
  return c(4 * i) + t * (c(4 * i + 1) + t * (c(4 * i + 2) + t * c(4 * i + 3)));
}

TEST(Table, AgreesWithBruteForceWhereverTheSplineGoesBelowZero) {
  Random random(1, stream(Stream::test));
  int below = 0;
  for (int table = 0; table < 20; ++table) {
    std::vector<double> x = {1}, y = {random.uniform()};
    for (int i = 0; i < 6; ++i) {
      x.push_back(x.back() + random.uniform(0.2, 1));
      y.push_back(random.uniform() < 0.5 ? 0 : random.uniform());
    }
    const auto sizes = make_table(x, y, Basis::volume);
    constexpr int n = 2000;
    const double step = (x.back() - x.front()) / n;
    std::vector<double> up_to = {0};
    for (int i = 0; i < n; ++i) {
      const double r = x.front() + (i + 0.5) * step, f = dense_spline(x, y, r);
      below += f < 0;
      up_to.push_back(up_to.back() + std::max(0.0, f) / (r * r * r));
    }
    for (int i = 0; i <= n; i += 100)  // the midpoint rule is off by step² f''/24, and so at kinks
      EXPECT_NEAR(sizes->cumulative(x.front() + i * step), up_to[i] / up_to[n], 1e-5) << table;
    for (const double r : x)  // where the density may vanish, and Newton's method has no slope to go by
      for (const double p : {sizes->cumulative(r), std::nextafter(sizes->cumulative(r), 0.0),
                             std::nextafter(sizes->cumulative(r), 1.0)})
        EXPECT_NEAR(sizes->cumulative(sizes->quantile(p)), p, 1e-13) << table;
  }
  EXPECT_GT(below, 1000);
}

TEST(Sieve, IsStraightOverTheLogarithmByVolume) {
  const auto sizes = make_sieve({1, 2, 4, 8}, {0, 0.3, 0.3, 1});
  const auto passing = [&](double r) { return 1 - sizes->moment_above(3, r) / sizes->moment(3); };
  for (const double r : {1.0, 1.2, 1.9, 2.0, 3.0, 4.0, 4.5, 7.0, 8.0})
    EXPECT_NEAR(passing(r), testing::sieve_law(r), 1e-14) << r;
}

TEST(Lognormal, HasTheMeansItWasMadeFrom) {
  const auto sizes = make_lognormal_of_means(2, 0.5, 0, infinity);
  EXPECT_NEAR(sizes->moment(4) / sizes->moment(3), 2, 1e-13);
  EXPECT_NEAR(sizes->moment(3) / sizes->moment(2), 0.5, 1e-13);
}

TEST(Lognormal, KeepsItsDigitsFarInATail) {
  for (const double z : {-30.0, -8.0, 8.0, 30.0}) {
    const double a = std::exp(z), b = std::exp(z + 0.5);
    const auto sizes = make_lognormal(1, 1, Basis::number, a, b);
    for (const double p : {0.01, 0.5, 0.99}) {
      const double r = sizes->quantile(p);
      EXPECT_GT(r, a);
      EXPECT_LT(r, b);
      EXPECT_NEAR(sizes->cumulative(r), p, 1e-10) << "z " << z;
    }
    EXPECT_GT(sizes->moment(1), a);
    EXPECT_LT(sizes->moment(1), b);
  }
}

TEST(SizeArguments, AreRefusedWhereAbsurd) {
  const double nan = std::nan("");
  const std::vector<std::function<void()>> absurd = {
      [] { make_constant(0); },
      [] { make_constant(-1); },
      [=] { make_constant(nan); },
      [] { make_constant(infinity); },
      [] { make_classes({}, {}, Basis::number); },
      [] {
        make_classes({1, 2}, {1}, Basis::number);
      },
      [] {
        make_classes({1, 1}, {1, 2}, Basis::number);
      },
      [] {
        make_classes({1, 2}, {1, 0}, Basis::number);
      },
      [] {
        make_classes({1, -2}, {1, 1}, Basis::volume);
      },
      [] { make_uniform(2, 1, Basis::number); },
      [] { make_uniform(0, 1, Basis::number); },
      [] { make_uniform(1, infinity, Basis::number); },
      [] { make_lognormal(1, 0, Basis::number, 0, infinity); },
      [] { make_lognormal(-1, 0.3, Basis::number, 0, infinity); },
      [] { make_lognormal(1, 0.3, Basis::number, 2, 1); },
      [=] { make_lognormal(1, 0.3, Basis::number, nan, 1); },
      [] { make_lognormal(1, 0.01, Basis::number, 1e6, 1e7); },  // nothing lies there
      [] { make_lognormal_of_means(1, 1, 0, infinity); },
      [] { make_normal(-1, 1, Basis::number, 0.1, 1); },
      [] { make_normal(1, 0, Basis::number, 0.1, 1); },
      [] { make_normal(1, 0.5, Basis::number, 0, infinity); },  // reaches zero
      [] { make_normal(1, 0.1, Basis::number, 2, 1.5); },
      [] { make_normal(1, 0.1, Basis::number, 2, 3); },  // nothing lies there
      [] { make_table({1}, {1}, Basis::number); },
      [] {
        make_table({1, 2}, {1}, Basis::number);
      },
      [] {
        make_table({2, 1}, {1, 1}, Basis::number);
      },
      [] {
        make_table({1, 2}, {0, 0}, Basis::number);
      },
      [] {
        make_table({1, 2}, {1, -1}, Basis::number);
      },
      [=] {
        make_table({1, 2}, {1, nan}, Basis::number);
      },
      [] { make_sieve({1}, {0}); },
      [] {
        make_sieve({1, 2}, {1, 2});
      },
      [] {
        make_sieve({1, 2, 3}, {0, 2, 1});
      },
      [] {
        make_sieve({1, 2}, {0, 0});
      },
      [] {
        make_sieve({2, 1}, {0, 1});
      },
      [] { make_rosin_rammler(1, 1, 0, 2); },
      [] { make_rosin_rammler(1, -1, 0.1, 2); },
      [] { make_rosin_rammler(1, 5, 3, infinity); },  // above the upper cut
      [] { make_rosin_rammler(1, 50, 1000, 2000); },  // nothing lies there
      [] { make_fuller(1, 0.5, 0); },
      [] { make_fuller(1, 0.5, 2); },
      [] { make_fuller(infinity, 0.5, 1); },
      [] { make_fuller(1, -0.5, 0.1); },
      [] { make_lognormal_of_mean(0, 1, Basis::number, 0, infinity); },
      [] { make_lognormal_of_mean(1, 0, Basis::number, 0, infinity); },
      [] { make_histogram({1}, {}, Basis::number); },
      [] {
        make_histogram({1, 2}, {1, 1}, Basis::number);
      },
      [] {
        make_histogram({2, 1}, {1}, Basis::mass);
      },
      [] {
        make_histogram({0, 1}, {1}, Basis::mass);
      },
      [] {
        make_histogram({1, 2}, {0}, Basis::mass);
      },
      [=] {
        make_histogram({1, 2, 3}, {1, nan}, Basis::number);
      },
      [] {
        make_from_percentiles({{0.5, 1}}, PercentileLaw::lognormal, Basis::volume, 0, infinity);
      },
      [] {
        make_from_percentiles({{0.1, 2}, {0.9, 1}}, PercentileLaw::lognormal, Basis::volume, 0, infinity);
      },
      [] {
        make_from_percentiles({{0.1, 1}, {1, 2}}, PercentileLaw::through, Basis::volume, 0, infinity);
      },
      [] {  // without "min"
        make_from_percentiles({{0.1, 1}, {0.9, 2}}, PercentileLaw::rosin_rammler, Basis::volume, 0, infinity);
      },
      [] { make_mixture({}, {}, Basis::number); },
      [] { testing::mixture_of(make_constant(1), make_constant(2), 1, Basis::number); },
  };
  for (std::size_t i = 0; i < absurd.size(); ++i) {
    try {
      absurd[i]();
      ADD_FAILURE() << "case " << i << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    }
  }
}

}  // namespace size_kinds_test
}  // namespace bernal

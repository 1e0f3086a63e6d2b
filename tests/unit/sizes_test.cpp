#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include "bernal/core/error.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest_draw = 1 - 0x1p-53;  ///< of Random::uniform

double normal_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

/// A distribution, and the law that its user stated: the fraction of the basis at or below a radius.
struct Case {
  std::string name;
  std::function<std::unique_ptr<SizeDistribution>()> make;
  Basis basis;
  std::function<double(double)> stated;
};

std::function<double(double)> cut_lognormal(double median, double sigma, double min, double max) {
  return [=](double r) {
    const auto below = [&](double x) { return x > 0 ? normal_below(std::log(x / median) / sigma) : 0; };
    return (below(std::clamp(r, min, max)) - below(min)) / (below(max) - below(min));
  };
}

std::vector<Case> cases() {
  const auto at = [](double r) { return [r](double x) { return x < r ? 0.0 : 1.0; }; };
  const auto between = [](double a, double b) {
    return [a, b](double r) { return (std::clamp(r, a, b) - a) / (b - a); };
  };
  const auto thirds = [](double r) { return r < 1 ? 0 : r < 2 ? 0.2 : r < 4 ? 0.7 : 1; };
  return {
      {"constant", [] { return make_constant(0.0309); }, Basis::number, at(0.0309)},
      {"classes_number",
       [] {
         return make_classes({4, 1, 2}, {3, 2, 5}, Basis::number);
       },
       Basis::number, thirds},
      {"classes_volume",
       [] {
         return make_classes({4, 1, 2}, {3, 2, 5}, Basis::volume);
       },
       Basis::volume, thirds},
      {"one_class", [] { return make_classes({7}, {0.1}, Basis::volume); }, Basis::volume, at(7)},
      {"uniform_number", [] { return make_uniform(1, 2, Basis::number); }, Basis::number, between(1, 2)},
      {"uniform_volume", [] { return make_uniform(1, 2, Basis::volume); }, Basis::volume, between(1, 2)},
      {"uniform_narrow", [] { return make_uniform(1, 1 + 1e-9, Basis::volume); }, Basis::volume,
       between(1, 1 + 1e-9)},
      {"uniform_wide", [] { return make_uniform(1, 20, Basis::volume); }, Basis::volume, between(1, 20)},
      {"uniform_equal", [] { return make_uniform(3, 3, Basis::volume); }, Basis::volume, at(3)},
      {"lognormal_number", [] { return make_lognormal(2, 0.3, Basis::number, 0, infinity); }, Basis::number,
       cut_lognormal(2, 0.3, 0, infinity)},
      {"lognormal_volume", [] { return make_lognormal(2, 0.3, Basis::volume, 0, infinity); }, Basis::volume,
       cut_lognormal(2, 0.3, 0, infinity)},
      {"lognormal_cut", [] { return make_lognormal(1, 0.5, Basis::number, 0.5, 1.5); }, Basis::number,
       cut_lognormal(1, 0.5, 0.5, 1.5)},
      {"lognormal_cut_volume", [] { return make_lognormal(1, 0.5, Basis::volume, 0.5, 1.5); }, Basis::volume,
       cut_lognormal(1, 0.5, 0.5, 1.5)},
  };
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class Sizes : public ::testing::TestWithParam<Case> {
 protected:
  std::unique_ptr<SizeDistribution> sizes = GetParam().make();

  std::vector<double> samples(int n) const {
    Random random(1, stream(Stream::test));
    std::vector<double> drawn(n);
    for (double& r : drawn) r = sizes->sample(random);
    return drawn;
  }
};

TEST_P(Sizes, QuantileInvertsCumulative) {
  // quantile(p) is the smallest radius with cumulative(radius) >= p, so just below it less than p lies. A
  // quantile is right to some roundoffs of its radius, a probability to as many times r f(r) <= 1e9 (narrow
  // case).
  const double slack = GetParam().name == "uniform_narrow" ? 1e-6 : 1e-13;
  for (const double p :
       {1e-12, 1e-6, 0.001, 0.1, 0.2, 0.25, 0.5, 0.7, 0.75, 0.9, 0.999, 1 - 1e-6, 1 - 1e-12}) {
    const double r = sizes->quantile(p);
    EXPECT_GE(sizes->cumulative(r), p - slack) << "p " << p;
    EXPECT_LE(sizes->cumulative(r * (1 - 1e-14)), p + slack) << "p " << p;
  }
}

TEST_P(Sizes, QuantileIsMonotonicAndKeepsItsLimits) {
  EXPECT_EQ(sizes->quantile(0), sizes->min());
  EXPECT_EQ(sizes->quantile(1), sizes->max());
  double previous = sizes->min();
  for (int i = 1; i <= 1000; ++i) {
    const double r = sizes->quantile(i / 1000.0);
    EXPECT_GE(r, previous);
    previous = r;
  }
  EXPECT_EQ(sizes->cumulative(sizes->min() / 2), 0);
  EXPECT_EQ(sizes->cumulative(sizes->max()), 1);
}

TEST_P(Sizes, EveryDrawIsPositiveAndFinite) {
  for (const double u : {0x1p-54, 0x1p-53, largest_draw}) {
    EXPECT_GT(sizes->quantile(u), 0) << u;
    EXPECT_TRUE(std::isfinite(sizes->quantile(u))) << u;
  }
}

TEST_P(Sizes, MomentsMatchSamples) {
  const std::vector<double> drawn = samples(100'000);
  EXPECT_NEAR(sizes->moment(0), 1, 1e-14);
  for (const int k : {-2, -1, 1, 2, 3}) {
    double mean = 0;
    for (const double r : drawn) mean += std::pow(r, k) / drawn.size();
    const double expected = sizes->moment(k);
    const double variance = std::max(0.0, sizes->moment(2 * k) - expected * expected);
    const double rounding = 1e-10 * expected;  // of 1e5 additions
    EXPECT_NEAR(mean, expected, 4 * std::sqrt(variance / drawn.size()) + rounding) << "k " << k;
  }
}

TEST_P(Sizes, SamplesFollowCumulative) {
  // Kolmogorov and Smirnov: D sqrt(n) exceeds 1.95 with probability 0.001 (less with steps).
  std::vector<double> drawn = samples(100'000);
  std::ranges::sort(drawn);
  const double n = static_cast<double>(drawn.size());
  double largest = 0;
  for (auto it = drawn.begin(); it != drawn.end();) {
    const auto end = std::upper_bound(it, drawn.end(), *it);
    const double before = (it - drawn.begin()) / n, after = (end - drawn.begin()) / n;
    largest = std::max(largest, std::abs(after - sizes->cumulative(*it)));
    largest = std::max(largest, std::abs(before - sizes->cumulative(std::nextafter(*it, 0))));
    it = end;
  }
  EXPECT_LT(largest * std::sqrt(n), 1.95);
}

// The number distribution, weighed with r³ where the user spoke of volume, must be the law that was stated;
// by the midpoint rule over the number of spheres, which is off by at most one midpoint at the jump of each
// indicator.
TEST_P(Sizes, IsTheLawThatWasStated) {
  constexpr int n = 200'000;
  const bool volume = GetParam().basis == Basis::volume;
  std::vector<double> r(n), weight(n);
  double total = 0;
  for (int i = 0; i < n; ++i) {
    r[i] = sizes->quantile((i + 0.5) / n);
    total += weight[i] = volume ? std::pow(r[i], 3) : 1;
  }
  const double tolerance = 2 * weight.back() / total + 1e-6;
  for (const double p : {0.05, 0.3, 0.5, 0.8, 0.97}) {
    const double radius = sizes->quantile(p);
    double below = 0;
    for (int i = 0; i < n; ++i)
      if (r[i] <= radius) below += weight[i];
    EXPECT_NEAR(below / total, GetParam().stated(radius), tolerance) << "radius " << radius;
  }
}

TEST_P(Sizes, MomentsLieBetweenThePowersOfTheLimits) {
  for (const int k : {-3, 1, 2, 3, 4, 6}) {
    const double low = std::pow(sizes->min(), k), high = std::pow(sizes->max(), k);
    EXPECT_GE(sizes->moment(k), std::min(low, high) * (1 - 1e-13)) << k;
    EXPECT_LE(sizes->moment(k), std::max(low, high) * (1 + 1e-13)) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Sizes, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

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

}  // namespace
}  // namespace bernal

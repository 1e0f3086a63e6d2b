// The rod model against slower ways to compute it: placement by sorted insertion, lengths by bisection in
// extended precision, and the numbers that its paper prints with the erf that its paper used.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/predict/predict.hpp"
#include "predict/chord_table.hpp"
#include "predict/rods.hpp"

namespace bernal {
namespace rods_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
using Sizes = std::unique_ptr<SizeDistribution>;

/// Spheres of volume-weighted mean diameter `d43`: equal for sigma = 0, else lognormal.
struct Population {
  double volume, d43, sigma;
};

Sizes sizes_of(const std::vector<Population>& populations) {
  std::vector<Sizes> of;
  std::vector<double> shares;
  for (const auto& [volume, d43, sigma] : populations) {
    of.push_back(sigma == 0 ? make_constant(d43)
                            : make_lognormal_of_means(d43, d43 * std::exp(-sigma * sigma), 0, infinity));
    shares.push_back(volume);
  }
  return make_mixture(std::move(of), std::move(shares), Basis::volume);
}

/// As the paper says it: all gaps in order, the largest is taken, two are put back.
double covered_fraction_by_insertion(const std::vector<double>& lengths, double f = 0.7654) {
  std::vector<double> gaps = {f * lengths.front()};
  for (std::size_t i = 1; i < lengths.size(); ++i) {
    const double gap = gaps.back(), length = lengths[i];
    gaps.pop_back();
    for (const double part : {f * length, std::max(f * length, gap - (1 + f) * length)})
      gaps.insert(std::ranges::upper_bound(gaps, part), part);
  }
  double rods = 0, empty = 0;
  for (const double length : lengths) rods += length;
  for (const double gap : gaps) empty += gap;
  return rods / (rods + empty);
}

/// Up to five populations, half of them of equal spheres. Sizes range over e^(2 spread).
std::vector<Population> random_mixture(std::mt19937_64& engine, double spread = 4) {
  std::uniform_real_distribution<double> share(0.01, 1), log_size(-spread, spread), width(0.05, 0.6 * spread);
  std::vector<Population> populations(1 + engine() % 5);
  for (Population& p : populations)
    p = {share(engine), std::exp(log_size(engine)), engine() % 2 == 0 ? 0 : width(engine)};
  return populations;
}

TEST(RodModel, PlacementEqualsSortedInsertion) {
  std::mt19937_64 engine(1);
  for (int k = 0; k < 200; ++k) {
    const int rods = 2 + static_cast<int>(engine() % 800);
    const auto sizes = sizes_of(random_mixture(engine));
    const auto lengths = predict::ChordTable(*sizes, rods).rod_lengths(rods);
    ASSERT_NEAR(predict::covered_fraction(lengths), covered_fraction_by_insertion(lengths), 1e-12) << k;
    const double f = std::uniform_real_distribution<double>(0, 2)(engine);
    ASSERT_NEAR(predict::covered_fraction(lengths, f), covered_fraction_by_insertion(lengths, f), 1e-12)
        << k << ' ' << f;
  }
}

TEST(RodModel, SplittingAPopulationOrScalingAllChangesNothing) {
  std::mt19937_64 engine(2);
  for (int k = 0; k < 20; ++k) {
    const std::vector<Population> whole = random_mixture(engine);
    std::vector<Population> split = whole, scaled = whole;
    split.push_back(split.front());
    split.front().volume *= 0.3;
    split.back().volume *= 0.7;
    for (Population& p : scaled) p.d43 *= 3.7e-5;
    const double phi = predict_packing_fraction(*sizes_of(whole), 2000).phi;
    // Lengths are right to 1e-11, each in its own direction.
    EXPECT_NEAR(predict_packing_fraction(*sizes_of(split), 2000).phi, phi, 1e-11) << k;
    EXPECT_NEAR(predict_packing_fraction(*sizes_of(scaled), 2000).phi, phi, 1e-11) << k;
  }
}

/// Rods by bisection of F: eq. 34 for any erfc, in any precision.
template <class Real, class Erfc>
std::vector<double> rods_by_bisection(const std::vector<Population>& populations, int count, Erfc erfc) {
  const auto chords = [&](Real length) {
    Real shorter = 0, all = 0;
    for (const auto& [volume, d43, sigma] : populations) {
      const Real s = sigma, d = d43;
      const Real number = volume / (d * d * d * std::exp(-6 * s * s)),
                 all_of_it = d * d * std::exp(-5 * s * s);
      all += number * all_of_it;
      if (sigma == 0) {
        const Real at_most = std::min(length, d);
        shorter += number * at_most * at_most;
      } else {
        const Real z = (std::log(length / d) + Real(3.5) * s * s) / (s * std::sqrt(Real(2)));
        const Real below = 1 - erfc(z - s * std::sqrt(Real(2))) / 2;
        shorter += number * (all_of_it * below + length * length * erfc(z) / 2);
      }
    }
    return shorter / all;
  };
  std::vector<double> lengths;
  for (int i = 0; i < count; ++i) {
    Real low = -40, high = 40;  // of ln L
    while (high - low > 16 * std::numeric_limits<Real>::epsilon() * std::max(Real(1), std::abs(low))) {
      const Real middle = (low + high) / 2;
      (chords(std::exp(middle)) < (count - i - Real(0.5)) / count ? low : high) = middle;
    }
    lengths.push_back(static_cast<double>(std::exp(low)));
  }
  return lengths;
}

TEST(RodModel, AgreesWithExtendedPrecision) {
  const std::vector<std::vector<Population>> cases = {{{1, 1, 0.5}},
                                                      {{1, 1, 0.05}},
                                                      {{1, 3, 2}},
                                                      {{0.3, 1, 0.3}, {0.7, 8, 0.6}},
                                                      {{0.25, 1, 0}, {0.75, 5, 0}},
                                                      {{0.5, 1, 0}, {0.4, 2, 0.3}, {0.1, 40, 0}}};
  for (const auto& populations : cases) {
    const int rods = 2000;
    const auto reference =
        rods_by_bisection<long double>(populations, rods, [](long double x) { return std::erfc(x); });
    const auto lengths = predict::ChordTable(*sizes_of(populations), rods).rod_lengths(rods);
    double worst = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i)
      worst = std::max(worst, std::abs(lengths[i] / reference[i] - 1));
    EXPECT_LT(worst, 1e-10);
    EXPECT_NEAR(predict::covered_fraction(lengths), covered_fraction_by_insertion(reference), 1e-11);
  }
}

/// erfc by Abramowitz & Stegun 7.1.26, right to 1.5e-7: what the published program uses.
double published_erfc(double x) {
  const double t = 1 / (1 + 0.3275911 * std::abs(x));
  const double tail =
      t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) *
      std::exp(-x * x);
  return x < 0 ? 2 - tail : tail;
}

double published(const std::vector<Population>& populations, int rods) {
  return predict::covered_fraction(rods_by_bisection<double>(populations, rods, published_erfc));
}

TEST(RodModel, TableOneOfFarr2013) {
  for (const int rods : {16000, 64000}) {
    EXPECT_NEAR(published({{1, 1, 0}}, rods), 0.643485, 0.6e-6) << rods;
    EXPECT_NEAR(published({{1, 1, 0.5}}, rods), rods == 16000 ? 0.707259 : 0.707262, 0.51e-6) << rods;
    EXPECT_NEAR(published({{1, 1, 1.0}}, rods), rods == 16000 ? 0.801339 : 0.801368, 0.51e-6) << rods;
  }
  EXPECT_NEAR(published({{1, 2, std::sqrt(std::log(4.0))}}, 16000), 0.829998, 0.51e-6);
}

TEST(RodModel, TableTwoOfFarr2013) {
  // Two populations of equal volume whose mean diameters d43 are as 1 : 2.
  const auto phi = [](double sigma_a, double sigma_b) {
    return predict_packing_fraction(*sizes_of({{1, 1, sigma_a}, {1, 2, sigma_b}}), 16000).phi;
  };
  EXPECT_NEAR(predict_packing_fraction(*sizes_of({{1, 1, 0}}), 16000).phi, 0.643, 0.5e-3);
  EXPECT_NEAR(predict_packing_fraction(*sizes_of({{1, 1, 0.3}}), 16000).phi, 0.671, 0.5e-3);
  EXPECT_NEAR(phi(0, 0), 0.676, 0.5e-3);
  EXPECT_NEAR(phi(0.3, 0), 0.702, 0.5e-3);
  EXPECT_NEAR(phi(0, 0.3), 0.674, 0.5e-3);
  EXPECT_NEAR(phi(0.3, 0.3), 0.699, 0.5e-3);
}

TEST(RodModel, ErrorBoundsWhatMoreRodsChange) {
  // Where the change happens to vanish, a few hundredths of one rod in 4,000 remain.
  std::mt19937_64 engine(3);
  for (int k = 0; k < 40; ++k) {
    const auto sizes = sizes_of(random_mixture(engine, 3));
    const Prediction coarse = predict_packing_fraction(*sizes, 4000);
    const double fine = predict_packing_fraction(*sizes, 256000).phi;
    EXPECT_LT(std::abs(fine - coarse.phi), 1.5 * coarse.error + 1e-5)
        << k << ": " << coarse.phi << ' ' << fine;
  }
}

TEST(RodModel, ErrorTellsOfSpheresTooFewForARod) {
  // Half of the volume in spheres that have a millionth of the chords: 16,000 rods know only the small ones.
  const auto sizes = sizes_of({{1, 1, 0}, {1, 1e6, 0}});
  const Prediction p = predict_packing_fraction(*sizes, 16000);
  EXPECT_NEAR(p.phi, 0.6435, 1e-4);
  EXPECT_NEAR(p.error, 0.5 * (1 - p.phi), 1e-3);
}

TEST(RodModel, StaysBelowTheLimitOfInfiniteRatio) {
  // 26.28 % of the volume small: large spheres at random close packing, their voids full of small ones.
  const auto sizes = make_classes({1, 1000}, {0.2628, 0.7372}, Basis::volume);
  const double phi = predict_packing_fraction(*sizes, 1000000).phi;
  EXPECT_NEAR(phi, 0.8595, 1e-4);
  EXPECT_GT(1 - std::pow(1 - 0.6434854, 2), phi + 0.013);
}

TEST(Fit, IsRightToThreeTenThousandths) {
  for (int k = 1; k <= 30; ++k) {
    const auto sizes = make_lognormal(1, 0.1 * k, Basis::number, 0, infinity);
    EXPECT_NEAR(fitted_packing_fraction(0.1 * k), predict_packing_fraction(*sizes, 64000).phi, 3e-4) << k;
  }
  EXPECT_NEAR(fitted_packing_fraction(0), 0.6435, 1e-12);
  for (const double sigma : {-0.1, 3.1, std::nan("")}) EXPECT_THROW(fitted_packing_fraction(sigma), Error);
}

TEST(Viscosity, OfKriegerAndDougherty) {
  EXPECT_EQ(relative_viscosity(0, 0.64), 1);
  EXPECT_NEAR(relative_viscosity(1e-6, 0.64), 1 + 2.5e-6, 1e-11);  // Einstein's law
  EXPECT_NEAR(relative_viscosity(0.32, 0.64), std::pow(2, 1.6), 1e-14);
  EXPECT_GT(relative_viscosity(0.64 * (1 - 1e-9), 0.64), 1e14);
  EXPECT_THROW(relative_viscosity(0.64, 0.64), Error);
  EXPECT_THROW(relative_viscosity(-0.1, 0.64), Error);
  EXPECT_THROW(relative_viscosity(std::nan(""), 0.64), Error);
}

}  // namespace rods_test
}  // namespace bernal

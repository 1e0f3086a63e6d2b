#include "bernal/predict/predict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include "bernal/core/error.hpp"
#include "predict/chord_table.hpp"
#include "predict/rods.hpp"

namespace bernal {
namespace predict_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::unique_ptr<SizeDistribution> lognormal(double sigma) {
  return make_lognormal(1, sigma, Basis::number, 0, infinity);
}

TEST(Predict, EqualSpheres) {
  // Farr 2013, table 1, where f was chosen so that this is random close packing.
  EXPECT_NEAR(predict_packing_fraction(*make_constant(3), 16000).phi, 0.6434855, 1e-7);
  EXPECT_NEAR(predict_packing_fraction(*make_constant(3), 64000).phi, 0.6434854, 1e-7);
}

TEST(Predict, LognormalSpheresAsPublished) {
  // Farr 2013, table 1, with an exact erfc; and the values at N = 16000 to the five digits known.
  EXPECT_NEAR(predict_packing_fraction(*lognormal(0.5), 16000).phi, 0.7072591, 1e-7);
  EXPECT_NEAR(predict_packing_fraction(*lognormal(0.5), 64000).phi, 0.7072627, 1e-7);
  EXPECT_NEAR(predict_packing_fraction(*lognormal(1.0), 16000).phi, 0.8013511, 1e-7);
  EXPECT_NEAR(predict_packing_fraction(*lognormal(1.0), 64000).phi, 0.8013799, 1e-7);
  const double table[][2] = {{0.1, 0.64692}, {0.2, 0.65683}, {0.3, 0.67131}, {0.4, 0.68851},
                             {0.5, 0.70726}, {0.6, 0.72671}, {0.8, 0.76536}, {1.0, 0.80135},
                             {1.2, 0.83344}, {1.5, 0.87374}, {2.0, 0.92218}};
  for (const auto& [sigma, phi] : table)
    EXPECT_NEAR(predict_packing_fraction(*lognormal(sigma), 16000).phi, phi, 0.6e-5) << "sigma " << sigma;
  EXPECT_NEAR(predict_packing_fraction(*make_lognormal_of_means(2, 0.5, 0, infinity), 16000).phi, 0.8300218,
              1e-7);
}

TEST(Predict, BidisperseSpheres) {
  // Volume share of the small spheres; rows are diameter ratios. Four digits are known.
  const double share[] = {.1, .2, .25, .3, .5, .7};
  const struct {
    double ratio, phi[6];
  } table[] = {{1.4, {.6484, .6513, .6521, .6527, .6526, .6500}},
               {2, {.6655, .6798, .6817, .6819, .6758, .6642}},
               {3, {.6914, .7281, .7290, .7257, .7048, .6802}},
               {5, {.7150, .7873, .7831, .7737, .7338, .6954}},
               {10, {.7150, .8044, .8267, .8147, .7579, .7077}}};
  for (const auto& row : table)
    for (int k = 0; k < 6; ++k) {
      const auto sizes = make_classes({1, row.ratio}, {share[k], 1 - share[k]}, Basis::volume);
      EXPECT_NEAR(predict_packing_fraction(*sizes, 4000).phi, row.phi[k], 0.6e-4)
          << "ratio " << row.ratio << ", share " << share[k];
    }
}

TEST(Predict, ScaleDoesNotMatterAndErrorShrinks) {
  const double unit = predict_packing_fraction(*make_lognormal(1, 0.7, Basis::volume, 0.1, 8), 4000).phi;
  EXPECT_NEAR(predict_packing_fraction(*make_lognormal(1e-6, 0.7, Basis::volume, 1e-7, 8e-6), 4000).phi, unit,
              1e-12);
  const Prediction coarse = predict_packing_fraction(*lognormal(0.7), 500);
  const Prediction fine = predict_packing_fraction(*lognormal(0.7), 32000);
  EXPECT_LT(fine.error, coarse.error);
  EXPECT_LT(std::abs(fine.phi - coarse.phi), 3 * coarse.error);
  EXPECT_THROW(predict_packing_fraction(*lognormal(0.7), 1), Error);
}

TEST(Predict, GapsBetweenRodsDecide) {
  const auto phi = [](const SizeDistribution& sizes, double f) {
    return predict_packing_fraction(sizes, 2000, f).phi;
  };
  for (const double sigma : {0.05, 0.3, 1.0}) {
    const auto sizes = lognormal(sigma);
    EXPECT_EQ(phi(*sizes, 0.7654), predict_packing_fraction(*sizes, 2000).phi);
    EXPECT_EQ(phi(*sizes, 0), 1);
    double last = 1;
    for (double f = 0.05; f < 3; f += 0.05) {
      const double here = phi(*sizes, f);
      EXPECT_LT(here, last) << sigma << ' ' << f;
      // A rod adds at most two gaps of f times its length.
      EXPECT_GT(here, 1 / (1 + 2 * f));
      last = here;
    }
  }
  for (const double f : {-0.1, std::nan(""), infinity}) EXPECT_THROW(phi(*make_constant(1), f), Error);
}

// Nothing shorter comes to fill their gaps.
TEST(Predict, EqualRodsHaveEqualGaps) {
  const std::vector<double> lengths(100, 2.5);
  for (const double f : {0.0, 0.1, 0.7654, 1.0, 7.0})
    EXPECT_NEAR(predict::covered_fraction(lengths, f), 1 / (1 + f), 1e-14);
}

TEST(Predict, NearlyEqualSpheresAreNearlyEqualSpheres) {
  const double equal = predict_packing_fraction(*make_constant(1), 1000).phi;
  EXPECT_NEAR(predict_packing_fraction(*lognormal(1e-9), 1000).phi, equal, 1e-8);
  EXPECT_NEAR(predict_packing_fraction(*make_uniform(1, 1 + 1e-12, Basis::number), 1000).phi, equal, 1e-8);
}

/// Every kind of distribution, to check what the rod lengths are made of.
std::vector<std::unique_ptr<SizeDistribution>> all_kinds() {
  std::vector<std::unique_ptr<SizeDistribution>> kinds;
  kinds.push_back(make_constant(2));
  kinds.push_back(make_classes({1, 2.5, 4}, {5, 3, 1}, Basis::number));
  kinds.push_back(make_uniform(1, 3, Basis::number));
  kinds.push_back(make_uniform(1, 30, Basis::volume));
  kinds.push_back(make_lognormal(1, 0.4, Basis::number, 0, infinity));
  kinds.push_back(make_lognormal(1, 1.5, Basis::volume, 0.01, 20));
  return kinds;
}

TEST(SizeDistributionLaw, MomentsAboveARadius) {
  for (const auto& d : all_kinds()) {
    SCOPED_TRACE(::testing::Message() << "radii from " << d->min() << " to " << d->max());
    const double above_all = std::min(d->max(), d->quantile(1 - 1e-12)) * 1.01;
    for (int k = -2; k <= 4; ++k) {
      const double all = d->moment(k);
      EXPECT_NEAR(d->moment_above(k, 0), all, 1e-13 * all);
      EXPECT_NEAR(d->moment_above(k, above_all), 0, 1e-3 * all);
      for (const double p : {0.1, 0.5, 0.9}) {
        const double a = d->quantile(p), b = d->quantile(p + 0.05);
        // By parts: the integral of r^k dC over (a, b] is b^k C(b) - a^k C(a) - ∫ k r^(k-1) C dr.
        const double inside = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
            [&](double r) { return k * std::pow(r, k - 1) * d->cumulative(r); }, a, b, 15, 1e-10);
        const double expected =
            std::pow(b, k) * d->cumulative(b) - std::pow(a, k) * d->cumulative(a) - inside;
        EXPECT_NEAR(d->moment_above(k, a) - d->moment_above(k, b), expected, 1e-8 * all) << k << ' ' << p;
      }
      EXPECT_NEAR(d->moment_above(0, d->quantile(0.3)), 1 - d->cumulative(d->quantile(0.3)), 1e-13);
    }
  }
}

TEST(Rods, AreQuantilesOfChordLengths) {
  constexpr int count = 200;
  for (const auto& d : all_kinds()) {
    SCOPED_TRACE(::testing::Message() << "radii from " << d->min() << " to " << d->max());
    const auto lengths = predict::ChordTable(*d, count).rod_lengths(count);
    EXPECT_TRUE(std::ranges::is_sorted(lengths, std::greater()));
    EXPECT_LE(lengths.front(), d->max());
    for (int i = 0; i < count; ++i) {
      const double l = lengths[static_cast<std::size_t>(i)];
      const double cumulative = 1 - (d->moment_above(2, l) - l * l * d->moment_above(0, l)) / d->moment(2);
      // A tenth of what is asked of pieces of twice the width; halving them gains more, except at jumps.
      EXPECT_NEAR(cumulative, 1 - (i + 0.5) / count, 1e-11);
    }
  }
}

TEST(Rods, ChordsOfEqualSpheresHaveALinearDensity) {
  // P(L) = 2 L / D², so F^-1(p) = D √p.
  const auto lengths = predict::ChordTable(*make_constant(2), 8).rod_lengths(8);
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR(lengths[static_cast<std::size_t>(i)], 2 * std::sqrt((7.5 - i) / 8), 1e-14);
}

TEST(Rods, PlacementByHand) {
  const double f = 0.7654;
  // One rod: the gap around it is f L.
  EXPECT_NEAR(predict::covered_fraction(std::vector{5.0}), 1 / (1 + f), 1e-15);
  // A rod of 1 does not fit the gap f with its own gaps: two gaps of f.
  EXPECT_NEAR(predict::covered_fraction(std::vector{1.0, 1.0}), 1 / (1 + f), 1e-15);
  // A rod of 0.1 fits: the gap f = 0.1 f + 0.1 + rest, and the line stays as long as it was.
  EXPECT_NEAR(predict::covered_fraction(std::vector{1.0, 0.1}), 1.1 / (1 + f), 1e-15);
}

}  // namespace predict_test
}  // namespace bernal

#include "bernal/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "core/philox.hpp"

namespace bernal {
namespace random_test {

// Known answers published with the authors' Random123 library (kat_vectors: philox4x32, 10 rounds).
TEST(Philox, KnownAnswers) {
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  constexpr std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  // The digits of pi.
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, LayoutOfCounterAndKey) {
  const std::uint64_t seed = 0x299f31d0a4093822, stream = 0x0370734413198a2e;
  Random random(seed, stream);
  for (std::uint32_t counter = 0; counter < 3; ++counter) {
    const auto bits = philox4x32({counter, 0, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0});
    EXPECT_EQ(random(), (std::uint64_t{bits[1]} << 32) | bits[0]);
    EXPECT_EQ(random(), (std::uint64_t{bits[3]} << 32) | bits[2]);
  }
}

TEST(Random, IsAUniformRandomBitGenerator) {
  static_assert(std::uniform_random_bit_generator<Random>);
  EXPECT_EQ(Random::max(), ~std::uint64_t{0});
}

TEST(Random, EqualSeedAndStreamGiveEqualNumbersAndNoOthersDo) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 30; ++seed)
    for (std::uint64_t s = 0; s < 30; ++s) {
      Random a(seed, s), b(seed, s);
      const std::uint64_t number = a();
      EXPECT_EQ(number, b());
      first.insert(number);
    }
  EXPECT_EQ(first.size(), 900u);
}

TEST(Random, StreamsOfDifferentPurposesDiffer) {
  EXPECT_NE(stream(Stream::insert, 7), stream(Stream::shake, 7));
  EXPECT_NE(stream(Stream::insert, 7), stream(Stream::insert, 8));
  EXPECT_EQ(stream(Stream::radii, 5) >> 56, 1u);
  EXPECT_EQ(stream(Stream::radii, 5) & 0xff, 5u);
}

// Chi-squared over 64 bins: mean 63, standard deviation sqrt(126); 5 standard deviations.
TEST(Random, UniformNumbersFillTheirBinsEvenly) {
  Random random(1, stream(Stream::test));
  constexpr int bins = 64, n = 64000;
  std::array<int, bins> count{};
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++count[static_cast<int>(u * bins)];
  }
  double chi2 = 0;
  for (const int k : count) chi2 += (k - n / bins) * (k - n / bins) / double(n / bins);
  EXPECT_NEAR(chi2, bins - 1, 5 * std::sqrt(2.0 * (bins - 1)));
}

// The correlation of n independent pairs has the standard deviation 1/sqrt(n).
TEST(Random, NeighbouringStreamsAndSeedsAreUncorrelated) {
  constexpr int n = 20000;
  const auto correlation = [](Random a, Random b) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
    return 12 * sum / n;
  };
  for (std::uint64_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(correlation({1, k}, {1, k + 1}), 0, 5 / std::sqrt(n)) << "streams from " << k;
    EXPECT_NEAR(correlation({k, 1}, {k + 1, 1}), 0, 5 / std::sqrt(n)) << "seeds from " << k;
  }
}

TEST(Random, PointsFillTheirBounds) {
  Random random(3, stream(Stream::test));
  const Bounds<3> bounds{{-1, 5, 0}, {1, 6, 1e-3}};
  Vector<3> mean = Vector<3>::Zero();
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    const Vector<3> p = uniform_point<3>(random, bounds);
    ASSERT_TRUE((p.array() >= bounds.lower.array()).all() && (p.array() <= bounds.upper.array()).all());
    mean += p / n;
  }
  // A uniform number on an interval of length s has the standard deviation s / sqrt(12).
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(mean[k], bounds.center()[k], 5 * bounds.size()[k] / std::sqrt(12.0 * n));
}

template <int D>
void expect_isotropic_directions() {
  Random random(4, stream(Stream::test, D));
  Vector<D> mean = Vector<D>::Zero(), mean_square = Vector<D>::Zero();
  constexpr int n = 10000;
  for (int i = 0; i < n; ++i) {
    const Vector<D> u = uniform_direction<D>(random);
    ASSERT_NEAR(u.norm(), 1, 4e-16);
    mean += u / n;
    mean_square += u.cwiseAbs2() / n;
  }
  // The square of a component has the mean 1/D and the variance 2 (D - 1) / (D² (D + 2)).
  for (int k = 0; k < D; ++k) {
    EXPECT_NEAR(mean[k], 0, 5 / std::sqrt(double(D) * n));
    EXPECT_NEAR(mean_square[k], 1.0 / D, 5 * std::sqrt(2.0 * (D - 1) / (D * D * (D + 2.0)) / n));
  }
}

TEST(Random, DirectionsAreIsotropic) {
  expect_isotropic_directions<2>();
  expect_isotropic_directions<3>();
  expect_isotropic_directions<5>();
}

}  // namespace random_test
}  // namespace bernal

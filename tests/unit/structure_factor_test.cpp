#include "bernal/measure/structure_factor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bernal/measure/radial_distribution.hpp"
#include "measure/wave_vectors.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace structure_factor_test {

using namespace testing;

StructureFactor factor_of(const Packing& packing, const StructureOptions& options = {}) {
  const auto found = structure_factor(packing.spheres, packing.domain, options);
  EXPECT_TRUE(found);
  return found.value();
}

/// Every bin within so many of its errors from 1, and the mean of all of them near.
template <int D>
void expect_ideal_gas(std::size_t n, const Vector<D>& edges) {
  const Packing packing = periodic_packing<D>(ideal_gas<D>(n, 0.05, 0.05, edges, 4), edges);
  const StructureFactor found = factor_of(packing, {.bin = 0.1, .reach = 5, .work = 2e7});
  ASSERT_GT(found.k.size(), 20u);
  double sum = 0, weight = 0;
  for (std::size_t b = 0; b < found.k.size(); ++b) {
    const double m = found.vectors[b];
    // The mean of m values that are distributed exponentially.
    EXPECT_NEAR(found.s[b], 1, 6 / std::sqrt(m)) << D << " " << found.k[b];
    sum += m * found.s[b];
    weight += m;
  }
  EXPECT_NEAR(sum / weight, 1, 5 / std::sqrt(weight)) << D;
}

TEST(StructureFactor, OfAnIdealGasIsOne) {
  expect_ideal_gas<1>(2000, Vector<1>(40));
  expect_ideal_gas<2>(3000, Vector<2>(3, 5));
  expect_ideal_gas<3>(3000, Vector<3>(1, 2, 1.5));
  expect_ideal_gas<5>(800, Vector<5>::Constant(1));
}

TEST(StructureFactor, OfAnIdealGasHasNoPeakThoughOneBinIsTheHighest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Vector<3> cube = Vector<3>::Ones(), rod(10, 0.5, 0.5);
    for (const Vector<3>& edges : {cube, rod})
      EXPECT_FALSE(factor_of(periodic_packing<3>(ideal_gas<3>(2000, 0.02, 0.02, edges, seed), edges)).peak());
    const Vector<1> line(500);
    EXPECT_FALSE(factor_of(periodic_packing<1>(ideal_gas<1>(500, 0.2, 0.2, line, seed), line)).peak());
  }
}

TEST(StructureFactor, IsTheSumOverAllPairs) {
  // S(k) of every single wave vector against Σ cos(k·(ci - cj)) / N, in boxes off the origin.
  const Vector<3> edges(2, 3, 1);
  Packing packing = periodic_packing<3>(ideal_gas<3>(37, 0.1, 0.2, edges, 9), edges);
  const StructureFactor found = factor_of(packing, {.bin = 0.02, .reach = 4});
  const auto vectors =
      wave_vectors<3>(Boundary<3>{edges}, found.bin_width, std::vector<std::size_t>(200, 400));
  std::size_t b = 0;
  for (const auto& bin : vectors) {
    if (bin.empty()) continue;
    double sum = 0;
    for (const auto& [n, length] : bin) {
      const Vector<3> k = 2 * std::numbers::pi * n.cast<double>().cwiseQuotient(edges);
      EXPECT_NEAR(k.norm(), length, 1e-12);
      for (std::size_t i = 0; i < packing.spheres.size(); ++i)
        for (std::size_t j = 0; j < packing.spheres.size(); ++j)
          sum += std::cos(k.dot(Vector<3>(packing.spheres.center(i) - packing.spheres.center(j))));
    }
    ASSERT_LT(b, found.s.size());
    EXPECT_NEAR(found.s[b], sum / 37 / static_cast<double>(bin.size()), 1e-10);
    EXPECT_EQ(found.vectors[b], bin.size());
    ++b;
  }
  EXPECT_EQ(b, found.s.size());
  EXPECT_GT(b, 20u);
}

TEST(StructureFactor, OfFccHasItsBraggPeaksAndNothingElse) {
  // S = N where all indices of the wave vector are multiples of the number of cells, and as such all even or
  // all odd; else 0.
  const int cells = 4;
  const Packing packing = face_centred(cells);
  const StructureFactor found = factor_of(packing, {.bin = 0.05, .reach = 9});
  const Vector<3> edges = Vector<3>::Constant(cells * std::sqrt(2.0));
  std::size_t b = 0, peaks = 0;
  for (const auto& bin :
       wave_vectors<3>(Boundary<3>{edges}, found.bin_width, std::vector<std::size_t>(180, 400))) {
    if (bin.empty()) continue;
    double bragg = 0;
    for (const auto& [n, length] : bin) {
      const auto odd = [&](int k) { return n[k] / cells % 2 != 0; };
      bragg +=
          n[0] % cells == 0 && n[1] % cells == 0 && n[2] % cells == 0 && odd(0) == odd(1) && odd(1) == odd(2);
    }
    peaks += bragg > 0;
    const double expected = 4 * cells * cells * cells * bragg / static_cast<double>(bin.size());
    EXPECT_NEAR(found.s.at(b++), expected, 1e-9);
  }
  EXPECT_EQ(b, found.s.size());
  EXPECT_EQ(peaks, 2u);  // 111 and 200
}

TEST(StructureFactor, IsTheFourierTransformOfGOfR) {
  // Hard spheres at random, where g is 1 beyond a few diameters: S = 1 + 4 π ρ ∫ (g - 1) r² sin(kr)/(kr) dr.
  const Vector<3> edges = Vector<3>::Constant(12);
  const Packing packing =
      periodic_packing<3>(scattered(1200, 0.4999, 0.5, Bounds<3>{Vector<3>::Zero(), edges}, 3), edges);
  ASSERT_GT(packing.spheres.size(), 800u);
  const StructureFactor found = factor_of(packing);
  const auto g = radial_distribution(packing.spheres, packing.domain, {.bin = 0.02, .reach = 5}).value();
  const double density = static_cast<double>(packing.spheres.size()) / edges.prod();
  double squares = 0, count = 0;
  for (std::size_t b = 0; b < found.k.size(); ++b) {
    const double k = found.k[b];
    if (k < 4 || k > 20) continue;
    double transform = 1;
    for (std::size_t r = 0; r < g.r.size(); ++r)
      transform +=
          4 * std::numbers::pi * density * (g.g[r] - 1) * g.r[r] * std::sin(k * g.r[r]) / k * g.bin_width;
    squares += (found.s[b] - transform) * (found.s[b] - transform);
    ++count;
  }
  ASSERT_GT(count, 50);
  EXPECT_LT(std::sqrt(squares / count), 0.06);
}

TEST(StructureFactor, HasEnoughWaveVectorsAtTheFirstPeakHoweverManySpheresThereAre) {
  const Vector<3> edges = Vector<3>::Constant(20);
  const Packing packing =
      periodic_packing<3>(scattered(5000, 0.4999, 0.5, Bounds<3>{Vector<3>::Zero(), edges}, 3), edges);
  const StructureFactor found = factor_of(packing, {.work = 1});
  for (std::size_t b = 0; b < found.k.size(); ++b) {
    const double k = found.k[b] * found.mean_diameter;
    if (k > 3) {
      EXPECT_EQ(found.vectors[b], k > 4 && k < 10 ? 200u : 24u) << k;
    }
  }
  const auto peak = found.peak(), precise = factor_of(packing, {.work = 1e9}).peak();
  ASSERT_TRUE(peak && precise);
  EXPECT_NEAR(peak->s, precise->s, 4 * peak->error);
  EXPECT_LT(peak->error, 0.12 * peak->s);
}

TEST(StructureFactor, OfBoxesLikeNeedlesAndOfFewSpheres) {
  Packing needle = periodic_packing<3>(ideal_gas<3>(500, 0.5, 0.5, {1, 1, 1e6}, 3), {1, 1, 1e6});
  const StructureFactor found = factor_of(needle, {.work = 1e6});
  EXPECT_GT(found.k.size(), 20u);
  for (const double s : found.s) EXPECT_TRUE(std::isfinite(s));
  Spheres<3> one;
  one.push_back({0, 0, 0}, 1);
  EXPECT_FALSE(structure_factor(one, periodic_box(Vector<3>(4, 4, 4))));
  one.push_back({2, 0, 0}, 1);
  EXPECT_TRUE(structure_factor(one, periodic_box(Vector<3>(4, 4, 4))));
  EXPECT_FALSE(structure_factor(one, Box{{-5, -5, -5}, {10, 10, 10}}));
}

}  // namespace structure_factor_test
}  // namespace bernal

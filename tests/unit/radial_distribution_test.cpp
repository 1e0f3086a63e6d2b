#include "bernal/measure/radial_distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "support/containers.hpp"
#include "support/measured.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace radial_distribution_test {

using testing::ideal_gas;
using testing::periodic_packing;

/// Mean number of neighbours in each bin: g times what chance would put there.
std::vector<double> neighbours(const Packing& packing, const RadialDistribution& radial) {
  const int dimension = packing.spheres.dimension();
  const double density = static_cast<double>(packing.spheres.size() - 1) / volume_of(packing.domain);
  std::vector<double> counts;
  for (std::size_t k = 0; k < radial.g.size(); ++k) {
    const double from = radial.r[k] - radial.bin_width / 2, to = radial.r[k] + radial.bin_width / 2;
    counts.push_back(radial.g[k] * density * (ball_volume(dimension, to) - ball_volume(dimension, from)));
  }
  return counts;
}

TEST(RadialDistribution, LatticesHaveTheirShells) {
  // Squared distances in squared diameters and how many neighbours lie there.
  using Shells = std::map<double, int>;
  const std::pair<Packing, Shells> known[] = {
      {testing::simple_cubic(8), {{1, 6}, {2, 12}, {3, 8}, {4, 6}, {5, 24}, {6, 24}}},
      {testing::body_centred(6), {{1, 8}, {4.0 / 3, 6}, {8.0 / 3, 12}, {11.0 / 3, 24}, {4, 8}}},
      {testing::face_centred(5), {{1, 12}, {2, 6}, {3, 24}, {4, 12}, {5, 24}}},
      {testing::hexagonal_discs(7), {{1, 6}, {3, 6}, {4, 6}, {7, 12}, {9, 6}}}};
  for (const auto& [packing, shells] : known) {
    const auto radial = radial_distribution(packing);
    ASSERT_TRUE(radial);
    EXPECT_DOUBLE_EQ(radial->mean_diameter, 1);
    EXPECT_EQ(radial->references, packing.spheres.size());
    std::vector<double> found = neighbours(packing, *radial);
    const double far = std::sqrt(shells.rbegin()->first) + 0.01;
    for (const auto& [squared, count] : shells) {
      const auto bin = static_cast<std::size_t>(std::sqrt(squared) / radial->bin_width + 1e-6);
      EXPECT_NEAR(found.at(bin), count, 1e-6) << squared;
      found[bin] = 0;
    }
    for (std::size_t k = 0; radial->r[k] < far; ++k) EXPECT_EQ(found[k], 0) << radial->r[k];
  }
}

TEST(RadialDistribution, OfAnIdealGasIsOneWithinItsError) {
  // The sum over bins of ((g - 1) / error)² is chi-squared: its mean is the number of bins, its standard
  // deviation √(2 bins); bins that expect fewer than ten pairs are left out.
  const auto check = [](const Packing& packing, double work) {
    const auto radial = radial_distribution(packing, {.work = work});
    ASSERT_TRUE(radial);
    double chi_squared = 0, bins = 0;
    const double n = static_cast<double>(packing.spheres.size());
    const std::vector<double> found = neighbours(packing, *radial);
    for (std::size_t k = 0; k < radial->g.size(); ++k) {
      if (found[k] * static_cast<double>(radial->references) < 20) continue;
      // The expected error: that of the count which chance would give.
      const double expected = found[k] / radial->g[k] * static_cast<double>(radial->references);
      const double distinct = 1 - 0.5 * static_cast<double>(radial->references) / n;
      chi_squared += std::pow(radial->g[k] - 1, 2) * expected * distinct;
      bins += 1;
      EXPECT_NEAR(radial->error[k], 1 / std::sqrt(expected * distinct), 0.5 / std::sqrt(expected * distinct));
    }
    EXPECT_GT(bins, 20);
    EXPECT_NEAR(chi_squared, bins, 4 * std::sqrt(2 * bins)) << packing.spheres.dimension();
  };
  check(periodic_packing<1>(ideal_gas<1>(3000, 1, 1, Vector<1>(30000), 1), Vector<1>(30000)), 1e9);
  check(periodic_packing<2>(ideal_gas<2>(3000, 1, 1, {300, 200}, 2), {300, 200}), 1e9);
  check(periodic_packing<3>(ideal_gas<3>(5000, 1, 1, {30, 40, 50}, 3), {30, 40, 50}), 1e9);
  check(periodic_packing<3>(ideal_gas<3>(20000, 1, 1, {60, 70, 80}, 3), {60, 70, 80}), 5e4);  // sampled
  check(periodic_packing<3>(ideal_gas<3>(2000, 1, 1, {12, 12, 12}, 4), {12, 12, 12}), 1e9);   // no cells
  check(periodic_packing<5>(ideal_gas<5>(3000, 1, 1, Vector<5>::Constant(11), 5), Vector<5>::Constant(11)),
        1e9);
}

TEST(RadialDistribution, SaysWhereTheSecondPeakSplits) {
  // Every sphere of a close-packed layer has six neighbours at √3 and six at 2 diameters.
  const auto radial = radial_distribution(testing::hexagonal_discs(10));
  ASSERT_TRUE(radial);
  ASSERT_EQ(radial->peaks.size(), 3u);
  EXPECT_NEAR(radial->peaks[0].r, 1, 0.011);
  EXPECT_NEAR(radial->peaks[1].r, std::sqrt(3.0), 0.011);
  EXPECT_NEAR(radial->peaks[2].r, 2, 0.011);

  const Vector<3> edges = Vector<3>::Constant(20);
  const auto spread = radial_distribution(periodic_packing<3>(ideal_gas<3>(1000, 0.3, 0.7, edges, 1), edges));
  EXPECT_GT(spread->radius_spread, 0.2);
  EXPECT_TRUE(spread->peaks.empty());
}

TEST(RadialDistribution, IsOnlyThereWhereItMeansSomething) {
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};
  EXPECT_TRUE(
      radial_distribution(testing::packing_of(testing::scattered(50, 0.5, 1, bounds_of(box), 1), box)));
  Spheres<dynamic> discs(2);
  discs.push_back(Vector<2>(1, 1), 1);
  discs.push_back(Vector<2>(3, 1), 1);
  EXPECT_FALSE(radial_distribution(discs, Box{Vector<2>::Zero(), Vector<2>(4, 4)}));
  const Vector<2> edges(10, 10);
  EXPECT_FALSE(radial_distribution(periodic_packing<2>({}, edges)));
  EXPECT_FALSE(radial_distribution(periodic_packing<2>(ideal_gas<2>(1, 1, 1, edges, 1), edges)));
  const auto two = radial_distribution(periodic_packing<2>(ideal_gas<2>(2, 1, 1, edges, 1), edges));
  ASSERT_TRUE(two);
  EXPECT_NEAR(two->bin_width * static_cast<double>(two->g.size()), 5, 1e-9);  // half the edge
}

/// Places at random where a sphere of that radius lies inside, and below a height.
Spheres<3> gas_inside(const Domain& domain, double r, std::size_t n, double below) {
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, {});
  Random random(5, stream(Stream::test));
  Spheres<3> spheres;
  while (spheres.size() < n) {
    const Vector<3> p = uniform_point(random, bounds_of(domain));
    if (p[2] <= below && container->clearance(frame.to_local(p)) >= r / frame.scale) spheres.push_back(p, r);
  }
  return spheres;
}

TEST(RadialDistribution, OfAnIdealGasBetweenWallsIsOne) {
  const double r = 0.2;
  const std::pair<const char*, Domain> domains[] = {
      {"box", Box{{1, 2, 3}, {4, 5, 3}}},
      {"between two walls", Box{{0, 0, 0}, {5, 4, 3}, {true, true, false}}},
      {"cylinder", Cylinder{.base = {1, 0, 0}, .radius = 2, .height = 5}},
      {"ball", Sphere{.center = {1, 1, 1}, .radius = 2.5}},
      {"mesh", Domain(test::box_mesh({0, 0, 0}, {4, 4, 3}))}};
  for (const auto& [name, domain] : domains) {
    SCOPED_TRACE(name);
    const double top = bounds_of(domain).upper[2];
    for (const bool is_bed : {false, true}) {
      RadialOptions options{.bin = 0.25};
      if (is_bed) options.below = LowerPart{-Vector<3>::UnitZ(), top - 0.9};
      const Spheres<3> gas = gas_inside(domain, r, 1500, is_bed ? top - 0.9 : top);
      const auto found = radial_distribution(gas, domain, options);
      ASSERT_TRUE(found);
      ASSERT_GT(found->g.size(), 10u);
      ASSERT_EQ(found->share.size(), found->g.size());
      for (std::size_t k = 1; k < found->g.size(); ++k)
        EXPECT_NEAR(found->g[k], 1, 5 * found->error[k] + 0.01) << found->r[k];
      EXPECT_NEAR(found->share.front(), 1, 0.1);
      EXPECT_LT(found->share.back(), 0.9);
    }
  }
}

// Nearer than the smallest spheres can come nothing is left to chance, which is else that of one pair.
TEST(RadialDistribution, IsKnownBelowContact) {
  const Vector<3> edges = Vector<3>::Constant(12);
  const Packing apart = testing::simple_cubic(8);
  const auto hard = radial_distribution(apart);
  ASSERT_TRUE(hard);
  for (std::size_t k = 0; k < hard->g.size(); ++k)
    EXPECT_EQ(hard->error[k] == 0, hard->r[k] < hard->mean_diameter) << hard->r[k];

  Spheres<3> sizes;  // 1 and 2 across: two small ones come as near as 1, of a mean of 1.5
  for (int k = 0; k < 8; ++k) sizes.push_back({3.0 * (k % 4), 3.0 * (k / 4), 0}, k % 2 == 0 ? 0.5 : 1.0);
  const auto mixed = radial_distribution(periodic_packing<3>(sizes, edges));
  ASSERT_TRUE(mixed);
  for (std::size_t k = 0; k < mixed->g.size(); ++k)
    EXPECT_EQ(mixed->error[k] == 0, mixed->r[k] + mixed->bin_width / 2 < 1 + 1e-9) << mixed->r[k];

  Packing overlapping = apart;
  overlapping.spheres.set_center(0, overlapping.spheres.center(1) + Vector<3>(0.5, 0, 0));
  const auto soft = radial_distribution(overlapping);
  ASSERT_TRUE(soft);
  for (const double error : soft->error) EXPECT_GT(error, 0);
}

TEST(RadialDistribution, OfSpheresAboveTheLevelCountsNone) {
  Spheres<3> spheres;
  spheres.push_back({2, 2, 2}, 0.5);
  spheres.push_back({3, 2, 2}, 0.5);
  spheres.push_back({2, 3, 6}, 0.5);
  spheres.push_back({3, 3, 6}, 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>(6, 6, 9)};
  const auto pairs = [&](const RadialDistribution& found) {
    double sum = 0;
    for (const double g : found.g) sum += g > 0;
    return sum;
  };
  const auto all = radial_distribution(spheres, box),
             bed = radial_distribution(spheres, box, {.below = LowerPart{-Vector<3>::UnitZ(), 4}});
  ASSERT_TRUE(all && bed);
  EXPECT_EQ(pairs(*all), 3);  // at 1, and from one pair to the other at 4.123 and 4.243
  EXPECT_EQ(pairs(*bed), 1);
}

}  // namespace radial_distribution_test
}  // namespace bernal

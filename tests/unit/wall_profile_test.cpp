#include "bernal/measure/wall_profile.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>

#include "support/containers.hpp"
#include "support/measured.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace wall_profile_test {

using testing::packing_of;

Packing packing_in(Spheres<3> spheres, const Domain& shape) {
  Packing packing = packing_of(std::move(spheres), Box{});
  packing.domain = shape;
  packing.volume = volume_of(packing.domain);
  return packing;
}

WallProfile profile_of(const Packing& packing, double work = 1e6) {
  return wall_profile(packing, {.work = work}).value();
}

/// Simple cubic, n spheres of diameter 1 along every edge of a box that they just fill.
Packing cubic(int n) {
  Spheres<3> spheres;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) spheres.push_back(Vector<3>(i + 0.5, j + 0.5, k + 0.5), 0.5);
  return packing_of(spheres, {Vector<3>::Zero(), Vector<3>::Constant(n)});
}

double integral_of(const WallProfile& profile) {
  return std::accumulate(profile.layers.begin(), profile.layers.end(), 0.0,
                         [](double sum, const auto& layer) { return sum + layer.share * layer.porosity; });
}

TEST(WallProfile, OfOneSphereOnTheFloorIsThatOfItsSlices) {
  // Radius 1/2 on the floor of a box of edge 10: z is the height, and the slice there has the area π z (1 -
  // z). The layer from a to b is what the box of edge 10 - 2a has more than that of edge 10 - 2b.
  Spheres<3> spheres;
  spheres.push_back({5, 5, 0.5}, 0.5);
  const WallProfile profile = profile_of(packing_of(spheres, {Vector<3>::Zero(), Vector<3>::Constant(10)}));
  EXPECT_EQ(profile.mean_diameter, 1);
  EXPECT_TRUE(profile.has_core);
  ASSERT_EQ(profile.layers.size(), 40u);  // deeper than 3.9 there is 1 % of the box left, (1 - 3.9 / 5)^3
  EXPECT_DOUBLE_EQ(profile.layers.back().to, 5);
  const auto slices = [](double z) { return std::numbers::pi * z * z * (0.5 - z / 3); };
  for (const auto& layer : profile.layers) {
    const double share = (std::pow(10 - 2 * layer.from, 3) - std::pow(10 - 2 * layer.to, 3)) / 1000;
    EXPECT_NEAR(layer.share, share, 1e-14) << layer.from;
    const double solid = slices(std::min(1.0, layer.to)) - slices(std::min(1.0, layer.from));
    EXPECT_NEAR(1 - layer.porosity, solid / (1000 * share), 5 * layer.error) << layer.from;
  }
  EXPECT_NEAR(profile.near_wall_packing_fraction, std::numbers::pi / 6 / (1000 - 512), 1e-12);
  EXPECT_EQ(profile.core_packing_fraction, 0);
}

TEST(WallProfile, OfConcentricSpheresIsThatOfTheirShells) {
  Spheres<3> spheres;
  spheres.push_back({1, 2, 3}, 0.5);
  const WallProfile profile = profile_of(packing_in(spheres, Sphere{{1, 2, 3}, 3}));
  ASSERT_EQ(profile.layers.size(), 24u);  // deeper than 2.3 there is 1 % left
  for (const auto& layer : profile.layers) {
    const double share = (std::pow(3 - layer.from, 3) - std::pow(3 - layer.to, 3)) / 27;
    EXPECT_NEAR(layer.share, share, 1e-14);
    const double solid =
        std::pow(std::min(0.5, 3 - layer.from), 3) - std::pow(std::min(0.5, 3 - layer.to), 3);
    EXPECT_NEAR(1 - layer.porosity, solid / (27 * share), 1e-12) << layer.from;
  }
  EXPECT_FALSE(profile.has_core);
  EXPECT_DOUBLE_EQ(profile.core_from, 1.5);
  EXPECT_NEAR(profile.core_packing_fraction, std::pow(0.5 / 1.5, 3), 1e-12);
}

TEST(WallProfile, OfACylinderAgreesWithDenseSampling) {
  // One sphere where side and floor are equally near.
  const Cylinder cylinder{{0, 0, 0}, {0, 0, 1}, 4, 9};
  Spheres<3> spheres;
  spheres.push_back({3, 0, 1}, 1);
  const WallProfile profile = profile_of(packing_in(spheres, cylinder));
  Random random(5, stream(Stream::test));
  std::vector<double> inside(profile.layers.size(), 0);
  constexpr int points = 200'000;
  for (int found = 0; found < points;) {
    const Vector<3> u = uniform_point<3>(random, {-Vector<3>::Ones(), Vector<3>::Ones()});
    if (u.norm() > 1) continue;
    ++found;
    const Vector<3> p = spheres.center(0) + u;
    const double z = std::min({p[2], 9 - p[2], 4 - std::hypot(p[0], p[1])});
    for (std::size_t k = 0; k < inside.size(); ++k)
      inside[k] += z >= profile.layers[k].from && (z < profile.layers[k].to || k + 1 == inside.size());
  }
  const double volume = 4 * std::numbers::pi / 3;
  for (std::size_t k = 0; k < inside.size(); ++k) {
    const auto& layer = profile.layers[k];
    const double solid = volume * inside[k] / points / (layer.share * volume_of(Domain(cylinder)));
    EXPECT_NEAR(1 - layer.porosity, solid, 5 * layer.error + 0.01 * solid) << layer.from;
  }
}

TEST(WallProfile, AddsUpToTheContainerAndToTheMeanPorosity) {
  for (const auto& tested : test::containers_under_test()) {
    const std::unique_ptr<Container> container = tested.container();
    Random random(3, stream(Stream::test));
    const double size = container->bounds().size().norm();
    Spheres<3> spheres;  // that overlap, which does not matter here
    for (int i = 0; i < 2000; ++i) {
      const Vector<3> c = uniform_point(random, container->bounds());
      const double r = random.uniform(0.005, 0.02) * size;
      if (container->contains(c, r)) spheres.push_back(c, r);
    }
    ASSERT_GT(spheres.size(), 5u) << tested.name;
    const Packing packing = packing_in(spheres, tested.shape);
    const WallProfile profile = profile_of(packing, 1e5);
    double share = 0, from = 0;
    for (const auto& layer : profile.layers) {
      share += layer.share;
      EXPECT_EQ(layer.from, from) << tested.name;
      EXPECT_GT(layer.share, 0) << tested.name;
      from = layer.to;
    }
    EXPECT_NEAR(share, 1, 1e-12) << tested.name;
    EXPECT_NEAR(integral_of(profile), profile.mean_porosity, 1e-9) << tested.name;
    EXPECT_NEAR(profile.mean_porosity, 1 - packing.packing_fraction(), 1e-15) << tested.name;
  }
}

// 50 layers of 0.3 end at a rounding more than 15, to which it was looked.
TEST(WallProfile, WhatIsDeeperThanWasLookedLiesInTheLastLayer) {
  Spheres<3> spheres;
  for (int i = -9; i <= 9; ++i)
    for (int j = -9; j <= 9; ++j)
      for (int k = 0; k < 10; ++k)
        if (std::hypot(3 * i, 3 * j) < 28) spheres.push_back(Vector<3>(3 * i, 3 * j, 1.5 + 3 * k), 1.5);
  for (const double height : {30.0, 60.0, 100.0}) {
    const WallProfile profile = profile_of(packing_in(spheres, Cylinder{.radius = 30, .height = height}));
    for (const WallProfile::Layer& layer : profile.layers) {
      EXPECT_GT(layer.porosity, 0) << layer.from;
      EXPECT_LE(layer.porosity, 1 + 1e-9) << layer.from;
    }
    EXPECT_LT(profile.layers.back().porosity, 0.99);
  }
}

TEST(WallProfile, OfAMeshIsThatOfTheSameBox) {
  const Vector<3> size(8, 9, 10);
  const Spheres<3> spheres = testing::scattered(800, 0.3, 0.5, {Vector<3>::Zero(), size}, 5, true);
  const WallProfile box = profile_of(packing_of(spheres, {Vector<3>::Zero(), size}));
  const WallProfile mesh = profile_of(packing_in(spheres, test::box_mesh({0, 0, 0}, size)));
  ASSERT_EQ(mesh.layers.size(), box.layers.size());
  for (std::size_t k = 0; k < box.layers.size(); ++k) {
    EXPECT_NEAR(mesh.layers[k].porosity, box.layers[k].porosity, 5 * mesh.layers[k].error) << k;
    EXPECT_NEAR(mesh.layers[k].share, box.layers[k].share, 5e-3) << k;
  }
  EXPECT_NEAR(mesh.core_packing_fraction, box.core_packing_fraction,
              5 * std::hypot(mesh.core_packing_error, box.core_packing_error));
  EXPECT_EQ(mesh.regions, box.regions);
}

TEST(WallProfile, FirstMinimumIsHalfADiameterFromTheWall) {
  const WallProfile profile = profile_of(cubic(10));
  ASSERT_TRUE(profile.first_minimum);
  EXPECT_NEAR(profile.first_minimum->z, 0.5, 0.02);
  // Away from edges a slice through the centres has the area π/4 in every square.
  EXPECT_NEAR(profile.first_minimum->porosity, 1 - std::numbers::pi / 4, 0.05);
  EXPECT_NEAR(profile.core_packing_fraction, std::numbers::pi / 6, 1e-12);
}

TEST(WallProfile, HasTheSameBitsForAnyNumberOfThreads) {
  const Packing packing = packing_in(cubic(8).spheres.in<3>(), test::box_mesh({0, 0, 0}, {8, 8, 8}));
  const auto with = [&](std::size_t threads) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    return profile_of(packing, 1e5);
  };
  const WallProfile one = with(1), many = with(4);
  for (std::size_t k = 0; k < one.layers.size(); ++k) {
    EXPECT_EQ(one.layers[k].share, many.layers[k].share);
    EXPECT_EQ(one.layers[k].porosity, many.layers[k].porosity);
    EXPECT_EQ(one.layers[k].error, many.layers[k].error);
  }
}

TEST(WallProfile, OfASphereThatFillsItsContainerHasNoPores) {
  Spheres<3> spheres;
  spheres.push_back({0, 0, 0}, 2);
  const WallProfile profile = profile_of(packing_in(spheres, Sphere{{0, 0, 0}, 2}));
  EXPECT_NEAR(profile.mean_porosity, 0, 1e-14);
  EXPECT_NEAR(integral_of(profile), 0, 1e-14);
  EXPECT_NEAR(profile.near_wall_packing_fraction, 1, 1e-12);
  EXPECT_FALSE(profile.has_core);
  EXPECT_EQ(profile.regions, std::vector{Region::near_wall});
  EXPECT_EQ(profile.segregation->volume_ratio, 1);
  EXPECT_EQ(profile.segregation->error, 0);
}

TEST(WallProfile, OfAContainerThinnerThanALayerOfSpheresHasNoCore) {
  Spheres<3> spheres;
  for (int i = 0; i < 5; ++i) spheres.push_back({2.0 * i + 1, 1, 0.55}, 0.5);
  const Packing packing = packing_of(spheres, {Vector<3>::Zero(), {10, 2, 1.1}});
  const WallProfile profile = profile_of(packing);
  EXPECT_FALSE(profile.has_core);
  EXPECT_DOUBLE_EQ(profile.core_from, 0.275);
  EXPECT_NEAR(profile.near_wall_packing_fraction, packing.packing_fraction(), 1e-12);
  EXPECT_NEAR(integral_of(profile), profile.mean_porosity, 1e-12);
  EXPECT_DOUBLE_EQ(profile.layers.back().to, 0.55);

  // Even one that is thinner than its first layer: spheres so large can only overlap its walls.
  Packing thin = packing;
  thin.domain = Box{{0, 0, 0.5}, {10, 2, 0.05}};
  thin.volume = volume_of(thin.domain);
  EXPECT_EQ(profile_of(thin).layers.size(), 1u);
  EXPECT_NEAR(profile_of(thin).layers[0].porosity, 1 - thin.packing_fraction(), 1e-12);
}

TEST(WallProfile, SegregationComparesTheSpheresNearTheWall) {
  // 3 of radius 1 at the floor, 5 of radius 2 far from all walls: the mean diameter is 3.25.
  Spheres<3> spheres;
  for (int i = 0; i < 3; ++i) spheres.push_back({14.0 + 4 * i, 20, 1}, 1);
  for (int i = 0; i < 5; ++i) spheres.push_back({14.0 + 4 * i, 20, 20}, 2);
  const WallProfile profile = profile_of(packing_of(spheres, {Vector<3>::Zero(), Vector<3>::Constant(40)}));
  ASSERT_TRUE(profile.segregation);
  EXPECT_EQ(profile.segregation->spheres, 3u);
  const double mean = (3 * 1.0 + 5 * 8.0) / 8;
  EXPECT_NEAR(profile.segregation->volume_ratio, 1 / mean, 1e-12);
  const double variance = (3 * std::pow(1 - mean, 2) + 5 * std::pow(8 - mean, 2)) / 7;
  EXPECT_NEAR(profile.segregation->error, std::sqrt(variance / 3 * (1 - 3.0 / 8)) / mean, 1e-12);
  EXPECT_EQ(profile.regions.front(), Region::near_wall);
  EXPECT_EQ(profile.regions.back(), Region::core);
}

TEST(WallProfile, LayersTellTheSizesOfTheSpheresWhoseSurfaceIsThere) {
  const Bounds<3> room{Vector<3>::Zero(), Vector<3>::Constant(10)};
  const Packing packing =
      packing_of(testing::scattered(400, 0.3, 0.7, room, 5, true), {Vector<3>::Zero(), room.upper});
  const WallProfile profile = profile_of(packing);
  const Spheres<3> spheres = packing.spheres.in<3>();
  double all = 0;
  for (const double r : spheres.r) all += r * r * r / static_cast<double>(spheres.size());
  std::uint64_t found = 0;
  double volume = 0;
  for (const WallProfile::Layer& layer : profile.layers) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Vector<3> c = spheres.center(i);
      const double gap = std::min(c.minCoeff(), (room.upper - c).minCoeff()) - spheres.r[i];
      if (std::max(gap, 0.0) < layer.from || gap >= layer.to) continue;
      sum += std::pow(spheres.r[i], 3);
      ++count;
    }
    ASSERT_EQ(layer.segregation.has_value(), count > 0) << layer.from;
    if (count == 0) continue;
    EXPECT_EQ(static_cast<double>(layer.segregation->spheres), count) << layer.from;
    EXPECT_NEAR(layer.segregation->volume_ratio, sum / count / all, 1e-9) << layer.from;
    found += layer.segregation->spheres;
    volume += count * layer.segregation->volume_ratio;
  }
  EXPECT_EQ(found, spheres.size());
  EXPECT_NEAR(volume, static_cast<double>(spheres.size()), 1e-9 * volume);
  EXPECT_GT(profile.layers.front().segregation->spheres, 10u);  // those that touch
}

TEST(WallProfile, IsAbsentWithoutSpheresOrWalls) {
  EXPECT_FALSE(wall_profile(packing_of({}, {Vector<3>::Zero(), Vector<3>::Ones()})));
  Spheres<3> spheres;
  spheres.push_back({1, 1, 1}, 1);
  EXPECT_FALSE(wall_profile(testing::periodic_packing<3>(spheres, Vector<3>::Constant(2))));
}

}  // namespace wall_profile_test
}  // namespace bernal

#include "bernal/measure/column_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/containers.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace column_profile_test {

double area_of_slices(double z) {
  return std::numbers::pi * z * z * (0.5 - z / 3);
}  // of a ball of radius 1/2

TEST(ColumnProfile, OfOneSphereOnTheFloorIsThatOfItsSlices) {
  Spheres<3> spheres;
  spheres.push_back({2, 2, 0.5}, 0.5);
  for (const bool is_box : {true, false}) {
    const Domain domain = is_box ? Domain(Box{Vector<3>::Zero(), Vector<3>(4, 4, 9)})
                                 : Domain(Cylinder{.base = {2, 2, 0}, .radius = 2, .height = 9});
    const double area = is_box ? 16 : std::numbers::pi * 4;
    const auto profile = column_profile(spheres, domain);
    ASSERT_TRUE(profile);
    EXPECT_TRUE(profile->has_lid);
    EXPECT_DOUBLE_EQ(profile->top, 9);
    ASSERT_EQ(profile->along.size(), 90u);
    for (const auto& layer : profile->along) {
      const double solid =
          area_of_slices(std::min(1.0, layer.to)) - area_of_slices(std::min(1.0, layer.from));
      EXPECT_NEAR(layer.porosity, 1 - solid / (0.1 * area), 1e-9) << layer.from;
    }
    ASSERT_TRUE(profile->side);
    EXPECT_DOUBLE_EQ(profile->side->from, 2.25);  // a quarter of the height
    EXPECT_DOUBLE_EQ(profile->side->to, 6.75);
    EXPECT_NEAR(profile->side->profile.mean_porosity, 1, 1e-12);  // the sphere is at the end
  }
}

/// One layer of spheres on the floor, another at the lid, and one sphere at the side in between.
TEST(ColumnProfile, TellsSideFloorAndLidApart) {
  Spheres<3> spheres;
  for (const double z : {0.5, 19.5})
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j) spheres.push_back({i + 0.5, j + 0.5, z}, 0.5);
  spheres.push_back({0.5, 4, 10}, 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>(8, 8, 20)};
  const auto profile = column_profile(spheres, box);
  ASSERT_TRUE(profile && profile->side && profile->floor_minimum && profile->lid_minimum);
  EXPECT_NEAR(profile->floor_minimum->z, 0.5, 0.01);
  EXPECT_NEAR(profile->lid_minimum->z, 0.5, 0.01);
  EXPECT_NEAR(profile->floor_minimum->porosity, 1 - std::numbers::pi / 4, 0.01);
  const WallProfile& side = profile->side->profile;
  EXPECT_DOUBLE_EQ(profile->side->from, 3);
  EXPECT_DOUBLE_EQ(profile->side->to, 17);
  EXPECT_NEAR(side.mean_porosity, 1 - std::numbers::pi / 6 / (64 * 14), 1e-9);
  // All that is solid between the ends is within a diameter of the side.
  double solid = 0;
  for (const auto& layer : side.layers) {
    const double own = layer.share * (1 - layer.porosity) * 64 * 14;
    EXPECT_NEAR(layer.share,
                (std::pow(8 - 2 * layer.from, 2) - std::pow(8 - 2 * std::min(layer.to, 4.0), 2)) / 64, 1e-9);
    if (layer.from >= 1) {
      EXPECT_NEAR(own, 0, 1e-12);
    }
    solid += own;
  }
  EXPECT_NEAR(solid, std::numbers::pi / 6, 1e-9);
}

/// The axis of a cylinder that lies, and of one that leans; of a bed the level is the top.
TEST(ColumnProfile, FollowsTheAxis) {
  Spheres<3> spheres;
  spheres.push_back({5, 0, 1.5}, 0.5);
  const Cylinder lies{.base = {0, 0, 0}, .axis = {1, 0, 0}, .radius = 2, .height = 10};
  const auto lying = column_profile(spheres, lies);
  ASSERT_TRUE(lying && lying->side);
  EXPECT_NEAR((lying->axis - Vector<3>::UnitX()).norm(), 0, 1e-15);
  // It touches the side in the middle of the length.
  double near_side = 0;
  for (const auto& layer : lying->side->profile.layers)
    if (layer.to < 1.05) near_side += layer.share * (1 - layer.porosity);
  EXPECT_NEAR(near_side * std::numbers::pi * 4 * 5, std::numbers::pi / 6, 1e-6);
  const Cylinder leans{.base = {0, 0, 0}, .axis = {1, 0, 1}, .radius = 3, .height = 10};
  const Vector<3> along = Vector<3>(1, 0, 1).normalized();
  Spheres<3> in_leaning;
  in_leaning.push_back(5 * along, 0.5);
  const auto leaning = column_profile(in_leaning, leans);
  ASSERT_TRUE(leaning && leaning->side);
  EXPECT_NEAR((leaning->axis - along).norm(), 0, 1e-12);
  EXPECT_NEAR(leaning->side->profile.mean_porosity, 1 - 1.0 / 6 / (9 * 5), 1e-4);
  const Box box{Vector<3>::Zero(), Vector<3>(4, 4, 9)};
  const auto bed = column_profile(spheres, box, {.level = 6.0});
  ASSERT_TRUE(bed);
  EXPECT_FALSE(bed->has_lid);
  EXPECT_DOUBLE_EQ(bed->top, 6);
  EXPECT_FALSE(bed->lid_minimum);
}

TEST(ColumnProfile, OfAnyContainerAddsUpToItsSpheres) {
  for (const auto& tested : test::containers_under_test()) {
    SCOPED_TRACE(tested.name);
    const Bounds<3> bounds = bounds_of(tested.shape);
    Spheres<3> spheres;
    spheres.push_back(bounds.center(), 0.05 * bounds.size().minCoeff());
    const auto profile = column_profile(spheres, tested.shape);
    const Vector<3> periods = boundary_of<3>(tested.shape).edges;
    if (!profile) {
      EXPECT_FALSE(periods.isZero(0));
      continue;
    }
    for (const auto& layer : profile->along) EXPECT_LE(layer.porosity, 1 + 1e-9);
    EXPECT_LT(std::ranges::min_element(profile->along, {}, &ColumnProfile::Layer::porosity)->porosity, 1);
  }
  EXPECT_FALSE(column_profile(Spheres<dynamic>(3), Box{}));
  Spheres<3> one;
  one.push_back({0.5, 0.5, 0.5}, 0.1);
  EXPECT_FALSE(column_profile(one, periodic_box(Vector<3>(1, 1, 1))));
}

}  // namespace column_profile_test
}  // namespace bernal

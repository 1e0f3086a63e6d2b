#include "bernal/measure/bed_profile.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "bernal/core/dimension.hpp"
#include "bernal/measure/measure.hpp"
#include "support/meshes.hpp"

// Height, roughness, porosity and layers of beds whose geometry is known.
namespace bernal {
namespace bed_profile_test {

using std::numbers::pi;
const Vector<3> down(0, 0, -1);

/// Simple cubic layers of spheres of diameter 1, m across and `layers` high.
Spheres<dynamic> cubic(int m, int layers) {
  Spheres<3> spheres;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < layers; ++k) spheres.push_back(Vector<3>(i + 0.5, j + 0.5, k + 0.5), 0.5);
  return Spheres<dynamic>(std::move(spheres));
}

TEST(BedProfile, OfCubicLayersInABox) {
  const auto bed = bed_profile(cubic(6, 9), Box{Vector<3>::Zero(), Vector<3>(6, 6, 20)});
  ASSERT_TRUE(bed);
  EXPECT_NEAR(bed->height, 9, 1e-9);
  EXPECT_NEAR(bed->highest, 9, 1e-9);
  EXPECT_NEAR(bed->roughness, 0, 1e-9);
  EXPECT_EQ(bed->covered, 1);
  EXPECT_NEAR(bed->porosity, 1 - pi / 6, 1e-9);
  EXPECT_NEAR(bed->porosity_error, 0, 1e-9);
  ASSERT_TRUE(bed->core);
  EXPECT_NEAR(bed->core->from, 3, 1e-9);
  EXPECT_NEAR(bed->core->to, 6, 1e-9);
  EXPECT_NEAR(bed->core->porosity, 1 - pi / 6, 1e-9);
  EXPECT_NEAR(bed->level.value(), 9, 1e-9);
  EXPECT_EQ(bed->rest.unsettled, 0u);
  ASSERT_EQ(bed->layers.size(), 90u);
  for (std::size_t k = 0; k < bed->layers.size(); ++k) {
    const auto slice = [](double z) { return pi * z * z * (0.5 - z / 3); };
    const double z = 0.1 * static_cast<double>(k % 10);
    EXPECT_NEAR(bed->layers[k].packing_fraction, (slice(z + 0.1) - slice(z)) / 0.1, 1e-9) << k;
  }
}

/// What every bed must hold: its layers are its spheres, and its numbers are where they can be.
void expect_sound(const BedProfile& bed, const Spheres<dynamic>& spheres, const Domain& prism, double area) {
  double filled = 0, all = 0;
  for (const auto& layer : bed.layers) filled += layer.packing_fraction * area * (layer.to - layer.from);
  for (const double r : spheres.r) all += ball_volume(spheres.dimension(), r);
  EXPECT_NEAR(filled, all, 1e-9 * all) << name_of(prism);
  EXPECT_NEAR(bed.layers.back().to, bed.highest, 1e-9 * bed.highest);
  EXPECT_LE(bed.height, bed.highest * (1 + 1e-12));
}

TEST(BedProfile, OfAStepHasItsMeanHeightAndRoughness) {
  Spheres<dynamic> spheres = cubic(6, 4);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 4; k < 8; ++k)
        spheres.push_back(Vector<dynamic>(Vector<3>(i + 0.5, j + 0.5, k + 0.5)), 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>(6, 6, 20)};
  const auto bed = bed_profile(spheres, box).value();
  EXPECT_NEAR(bed.height, 6, 1e-9);
  EXPECT_NEAR(bed.roughness, 2, 1e-9);
  EXPECT_NEAR(bed.level.value(), 4, 1e-9);  // up to there it is everywhere
  EXPECT_FALSE(bed.core);
  EXPECT_GT(bed.porosity_error, 0);
  EXPECT_NEAR(bed.porosity, 1 - pi / 6, 4 * bed.porosity_error);
  expect_sound(bed, spheres, box, 36);
}

TEST(BedProfile, IsTheSameTheOtherWayRoundAndInAnotherUnit) {
  // Turned upside down, to the side, and a thousand times as large, far away.
  const Spheres<dynamic> spheres = cubic(4, 6);
  const Domain box = Box{Vector<3>::Zero(), Vector<3>(4, 4, 12)};
  const auto upright = bed_profile(spheres, box).value();
  Spheres<dynamic> other = spheres, aside = spheres, far = spheres;
  const Vector<3> away(1e6, -2e6, 3e6);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> c = spheres.center(i);
    other.set_center(i, Vector<dynamic>(Vector<3>(c[0], c[1], 12 - c[2])));
    aside.set_center(i, Vector<dynamic>(Vector<3>(c[2], c[0], c[1])));
    far.set_center(i, Vector<dynamic>(Vector<3>(away + 1000 * c)));
    far.r[i] *= 1000;
  }
  const auto hung = bed_profile(other, box, {.direction = Vector<3>(0, 0, 2)}).value();
  const auto lying =
      bed_profile(aside, Box{Vector<3>::Zero(), Vector<3>(12, 4, 4)}, {.direction = Vector<3>(-1, 0, 0)})
          .value();
  const auto large = bed_profile(far, Box{away, Vector<3>(4000, 4000, 12000)}).value();
  for (const auto& [bed, unit] : {std::pair(hung, 1.0), {lying, 1.0}, {large, 1000.0}}) {
    EXPECT_NEAR(bed.height, unit * upright.height, 1e-9 * unit);
    EXPECT_NEAR(bed.highest, unit * upright.highest, 1e-9 * unit);
    EXPECT_NEAR(bed.level.value(), unit * upright.level.value(), 1e-9 * unit);
    EXPECT_NEAR(bed.porosity, upright.porosity, 1e-9);
    ASSERT_EQ(bed.layers.size(), upright.layers.size());
    for (std::size_t k = 0; k < bed.layers.size(); ++k)
      EXPECT_NEAR(bed.layers[k].packing_fraction, upright.layers[k].packing_fraction, 1e-8) << k;
  }
  EXPECT_EQ(large.below_level()->height_of(away + Vector<3>(0, 0, 5000)), away[2] + 5000);
}

TEST(BedProfile, OfAMeshIsThatOfTheShapeAlsoWhereBothLean) {
  const Spheres<dynamic> spheres = cubic(4, 6);
  const auto exact = bed_profile(spheres, Box{Vector<3>::Zero(), Vector<3>(4, 4, 12)}).value();
  const Mesh mesh = test::box_mesh({0, 0, 0}, {4, 4, 12});
  const auto same = bed_profile(spheres, mesh).value();
  EXPECT_NEAR(same.height, exact.height, 1e-9);
  EXPECT_NEAR(same.porosity, exact.porosity, 1e-9);
  EXPECT_NEAR(same.core ? same.core->porosity : 0, exact.core ? exact.core->porosity : 0, 1e-9);
  // Both turned, gravity with them: the cells of the surface lie otherwise over the spheres.
  const Vector<3> up = Vector<3>(0.4, -0.3, 0.8).normalized();
  Mesh points{{}, {}};
  for (std::size_t i = 0; i < spheres.size(); ++i) points.vertices.push_back(spheres.center(i));
  points = test::turned(points, up);
  Spheres<dynamic> leaning = spheres;
  for (std::size_t i = 0; i < spheres.size(); ++i) leaning.set_center(i, Vector<dynamic>(points.vertices[i]));
  const auto bed = bed_profile(leaning, test::turned(mesh, up), {.direction = Vector<3>(-up)}).value();
  EXPECT_NEAR(bed.highest, 6, 1e-9);
  EXPECT_NEAR(bed.height, 6, 0.1);
  EXPECT_LT(bed.height, 6);
  ASSERT_EQ(bed.layers.size(), exact.layers.size());
  for (std::size_t k = 0; k < bed.layers.size(); ++k)
    EXPECT_NEAR(bed.layers[k].packing_fraction, exact.layers[k].packing_fraction, 1e-8) << k;
  EXPECT_EQ(bed.rest.unsettled, 0u);
}

TEST(BedProfile, OfDiscsIsThatOfTheirAreas) {
  Spheres<dynamic> discs(2);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 8; ++j) discs.push_back(Vector<dynamic>(Vector<2>(i + 0.5, j + 0.5)), 0.5);
  const Domain box = Box{Vector<2>::Zero(), Vector<2>(5, 14)};
  const Domain polygon = Polygon{.loops = {{{0, 0}, {5, 0}, {5, 14}, {0, 14}}}};
  for (const Domain& domain : {box, polygon}) {
    const auto bed = bed_profile(discs, domain).value();
    EXPECT_NEAR(bed.height, 8, 1e-9);
    EXPECT_NEAR(bed.roughness, 0, 1e-9);
    EXPECT_NEAR(bed.porosity, 1 - pi / 4, 1e-9);
    EXPECT_NEAR(bed.core.value().porosity, 1 - pi / 4, 1e-9);
    expect_sound(bed, discs, domain, 5);
    EXPECT_EQ(bed.rest.unsettled, 0u);
  }
}

TEST(BedProfile, TilesAnAxisThatRepeatsItself) {
  // A layer over the ends of a box that repeats itself sideways: none of the surface is missing.
  Spheres<dynamic> spheres = cubic(5, 3);
  const Box box{Vector<3>::Zero(), Vector<3>(5, 5, 9), {true, true, false}};
  for (std::size_t i = 0; i < spheres.size(); ++i)
    spheres.set_center(i, Vector<dynamic>(Vector<3>(spheres.center(i) - Vector<3>(0.5, 0.5, 0))));
  const auto bed = bed_profile(spheres, box).value();
  EXPECT_NEAR(bed.height, 3, 1e-9);
  EXPECT_EQ(bed.covered, 1);
  EXPECT_NEAR(bed.porosity, 1 - pi / 6, 1e-9);
}

TEST(BedProfile, OfAHeapIsOfWhatIsCovered) {
  Spheres<3> few;
  for (int i = 0; i < 3; ++i) few.push_back(Vector<3>(i + 0.5, 0.5, 0.5), 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>(6, 6, 20)};
  const auto bed = bed_profile(Spheres<dynamic>(std::move(few)), box).value();
  EXPECT_NEAR(bed.covered, 3.0 / 36, 1e-9);
  EXPECT_NEAR(bed.height, 1, 1e-9);
  EXPECT_NEAR(bed.porosity, 1 - pi / 6, 0.02);
  EXPECT_FALSE(bed.level);
  EXPECT_FALSE(bed.core);
}

TEST(BedProfile, IsNoneWhereSpheresAreNoBed) {
  const Spheres<dynamic> spheres = cubic(4, 4);
  const auto is_bed = [&](const Domain& domain, BedOptions options = {}) {
    return bed_profile(spheres, domain, options).has_value();
  };
  EXPECT_FALSE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 4)}));    // full
  EXPECT_FALSE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 4.9)}));  // but for less than a diameter
  EXPECT_TRUE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 5.5)}));
  EXPECT_TRUE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 4)}, {.is_bed = true}));
  EXPECT_FALSE(bed_profile(cubic(4, 1), Box{Vector<3>(0, 0, -3), Vector<3>(4, 4, 12)}));  // they hang
  EXPECT_FALSE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 12), {false, false, true}}, {.is_bed = true}));
  EXPECT_FALSE(is_bed(Box{Vector<3>::Zero(), Vector<3>(4, 4, 12), {true, true, true}}));
  EXPECT_FALSE(bed_profile(Spheres<dynamic>(3), Box{}).has_value());
  const auto full = bed_profile(spheres, Box{Vector<3>::Zero(), Vector<3>(4, 4, 4)}, {.is_bed = true});
  EXPECT_NEAR(full->porosity, 1 - pi / 6, 1e-9);
  EXPECT_FALSE(full->level);  // walls and pores are those of the whole
}

TEST(BedProfile, KeepsTheEmptyPartOutOfWallsAndPores) {
  const Spheres<dynamic> spheres = cubic(8, 9);
  for (const Domain& domain :
       {Domain(Box{Vector<3>::Zero(), Vector<3>(8, 8, 40)}), Domain(test::box_mesh({0, 0, 0}, {8, 8, 40}))}) {
    const Measurements measured = measure(spheres, domain);
    EXPECT_NEAR(measured.packing_fraction, pi / 6 * 9 / 40, 1e-9);
    ASSERT_TRUE(measured.bed && measured.bed->level);
    const WallProfile& walls = measured.walls.value();
    EXPECT_NEAR(walls.mean_porosity, 1 - pi / 6, 1e-9);
    double share = 0, mean = 0;
    for (const auto& layer : walls.layers) {
      share += layer.share;
      mean += layer.share * layer.porosity;
    }
    EXPECT_NEAR(share, 1, 1e-9);
    EXPECT_NEAR(mean, walls.mean_porosity, 1e-9);
    // Deeper than z is a box without a lid.
    const auto deeper = [](double z) { return (8 - 2 * z) * (8 - 2 * z) * (9 - z) / (64 * 9); };
    EXPECT_NEAR(walls.layers[0].share, 1 - deeper(0.1), 0.003) << name_of(domain);
    EXPECT_NEAR(walls.layers[20].share, deeper(2) - deeper(2.1), 0.003);
    EXPECT_NEAR(measured.pores.value().porosity, 1 - pi / 6, 4 * measured.pores->porosity_error);
  }
}

}  // namespace bed_profile_test
}  // namespace bernal

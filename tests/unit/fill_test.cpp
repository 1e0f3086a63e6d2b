#include "fly/fill_by_classes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bernal/core/error.hpp"
#include "support/fill_work.hpp"
#include "support/nearest_images.hpp"

// What filling a box promises: the radii and the box that were asked for, to the last bit, and no overlap;
// or, where that is too much, as many of the spheres as are free of overlap.
namespace bernal {
namespace fill_test {

using testing::box_filled_to;
using testing::cube_filled_to;
using testing::FillCase;

std::vector<double> lognormal_radii(std::size_t n, double sigma) {
  Random random(3, stream(Stream::test));
  std::vector<double> radii(n);
  for (double& r : radii) {  // the sum of uniform numbers is normal enough
    double normal = -6;
    for (int k = 0; k < 12; ++k) normal += random.uniform();
    r = std::exp(sigma * normal);
  }
  return radii;
}

/// In exact arithmetic, over all pairs.
void expect_free_of_overlap(const SpheresInBox& in_box) {
  ASSERT_EQ(in_box.edges, *in_box.task.target_edges);
  with_dimension(in_box.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = decltype(dimension)::value;
    const Spheres<D> spheres = in_box.spheres.in<D>();
    const Vector<D> edges = in_box.edges;
    for (std::size_t i = 0; i < spheres.size(); ++i)
      for (int k = 0; k < D; ++k) {
        EXPECT_GE(spheres.center(i)[k], 0);
        EXPECT_LT(spheres.center(i)[k], edges[k]);
      }
    EXPECT_EQ(oracle::overlapping_pairs<D>(spheres, edges), 0u);
  });
}

void expect_filled(const FillCase& filled, StageEnd end, const std::vector<double>& radii) {
  EXPECT_EQ(end, StageEnd::converged);
  EXPECT_EQ(filled.in_box.spheres.r, radii);
  EXPECT_TRUE(filled.in_box.placed);
  expect_free_of_overlap(filled.in_box);
}

/// `part` is in the order of `all`, of which some may be missing.
bool is_subsequence(const std::vector<double>& part, const std::vector<double>& all) {
  auto next = all.begin();
  for (const double r : part) {
    next = std::find(next, all.end(), r);
    if (next++ == all.end()) return false;
  }
  return true;
}

// ---- relaxation

/// What the default protocol is asked for in each dimension.
constexpr double dense[] = {0.98, 0.82, 0.62, 0.435, 0.29, 0.187, 0.11, 0.065};

class FillDimensions : public ::testing::TestWithParam<int> {};

TEST_P(FillDimensions, EqualSpheresFillACubeDensely) {
  const int dimension = GetParam();
  const std::vector<double> radii(300, 1.0);
  // A few hundred spheres do not come as close as many.
  FillCase filled(radii, cube_filled_to(0.97 * dense[dimension - 1], radii, dimension));
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
}

TEST_P(FillDimensions, MixedSpheresFillAnOblongBox) {
  const int dimension = GetParam();
  const std::vector<double> radii = lognormal_radii(150, 0.2);
  Vector<dynamic> proportions = Vector<dynamic>::Ones(dimension);
  proportions[dimension - 1] = 1.7;
  FillCase filled(radii, box_filled_to(0.85 * dense[dimension - 1], radii, proportions));
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
}

TEST_P(FillDimensions, ANarrowBoxHoldsSpheresThatMeetInSeveralImages) {
  const int dimension = GetParam();
  Vector<dynamic> edges = Vector<dynamic>::Constant(dimension, 2.05);  // of a diameter of 2
  edges[dimension - 1] = 4.2;
  const std::vector<double> radii{1, 1};
  FillCase filled(radii, edges);
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
}

TEST_P(FillDimensions, ASphereMayTouchItsOwnImage) {
  const std::vector<double> radii{0.5};
  FillCase filled(radii, Vector<dynamic>::Ones(GetParam()));
  ASSERT_TRUE(fits_box(filled.in_box));
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
}

TEST_P(FillDimensions, ASphereThatOverlapsItselfIsRefused) {
  FillCase filled({0.5}, Vector<dynamic>::Constant(GetParam(), std::nextafter(1.0, 0.0)));
  EXPECT_FALSE(fits_box(filled.in_box));
  EXPECT_THROW(fill_by_relaxation(filled.in_box, filled.report, {}), Error);
  EXPECT_THROW(fill_by_classes(filled.in_box, filled.report, {}), Error);
}

TEST_P(FillDimensions, WhatDoesNotFitIsLeftOutAndTheRestIsFree) {
  const int dimension = GetParam();
  const std::vector<double> radii = lognormal_radii(dimension < 6 ? 100 : 40, 0.1);
  FillCase filled(radii, cube_filled_to(dimension == 1 ? 1.1 : 1.5 * dense[dimension - 1], radii, dimension));
  EXPECT_EQ(fill_by_relaxation(filled.in_box, filled.report, {}), StageEnd::full);
  EXPECT_LT(filled.in_box.spheres.size(), radii.size());
  EXPECT_GT(filled.in_box.spheres.size(), radii.size() / 3);
  EXPECT_TRUE(is_subsequence(filled.in_box.spheres.r, radii));
  expect_free_of_overlap(filled.in_box);
}

TEST_P(FillDimensions, EqualSpheresComeByInsertionToo) {
  const int dimension = GetParam();
  const std::vector<double> radii(100, 1.0);
  FillCase filled(radii, cube_filled_to(0.7 * dense[dimension - 1], radii, dimension));
  expect_filled(filled, fill_by_classes(filled.in_box, filled.report, {}), radii);
}

INSTANTIATE_TEST_SUITE_P(All, FillDimensions, ::testing::Range(1, 9));

TEST(Fill, TheSameSeedGivesTheSameBitsAndAnotherDoesNot) {
  for (const int dimension : {2, 3, 5}) {
    const std::vector<double> radii = lognormal_radii(200, 0.2);
    const Vector<dynamic> box = cube_filled_to(0.9 * dense[dimension - 1], radii, dimension);
    for (const auto fill : {fill_by_relaxation, fill_by_classes}) {
      FillCase one(radii, box), again(radii, box), other(radii, box, 2);
      fill(one.in_box, one.report, {});
      fill(again.in_box, again.report, {});
      fill(other.in_box, other.report, {});
      EXPECT_EQ(one.in_box.spheres, again.in_box.spheres);
      EXPECT_NE(one.in_box.spheres, other.in_box.spheres);
    }
  }
}

TEST(Fill, RodsFillALineWhoseLengthIsHardlyMore) {
  const std::vector<double> radii = lognormal_radii(1000, 0.3);
  FillCase filled(radii, cube_filled_to(1 - 1e-6, radii, 1));
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
}

TEST(Fill, NoSpheresAreAllThere) {
  FillCase filled({}, Vector<dynamic>::Ones(3));
  EXPECT_EQ(fill_by_relaxation(filled.in_box, filled.report, {}), StageEnd::converged);
  EXPECT_EQ(fill_by_classes(filled.in_box, filled.report, {}), StageEnd::converged);
}

TEST(Fill, OverlapThatIsAllowedMakesRoom) {
  const std::vector<double> radii(200, 1.0);
  FillCase filled(radii, cube_filled_to(0.68, radii, 3));
  filled.task.allowed_overlap = 0.05;
  EXPECT_EQ(fill_by_relaxation(filled.in_box, filled.report, {}), StageEnd::converged);
  EXPECT_EQ(filled.in_box.spheres.r, radii);
  for (double& r : filled.in_box.spheres.r) r *= 1 - 0.05 - 1e-12;
  expect_free_of_overlap(filled.in_box);
}

TEST(Fill, SpheresStartWhereTheyAre) {
  const std::vector<double> radii(27, 0.45);
  FillCase filled(radii, Vector<dynamic>::Constant(3, 3.0));
  filled.in_box.edges = Vector<dynamic>::Constant(3, 6.0);
  filled.in_box.placed = true;
  for (std::size_t i = 0; i < 27; ++i)
    filled.in_box.spheres.set_center(
        i, Vector<3>(1 + 2.0 * static_cast<double>(i % 3), 1 + 2.0 * static_cast<double>(i / 3 % 3),
                     1 + 2.0 * static_cast<double>(i / 9)));
  const Spheres<dynamic> before = filled.in_box.spheres;
  expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
  for (std::size_t i = 0; i < 27; ++i)
    EXPECT_LT((filled.in_box.spheres.center(i) - 0.5 * before.center(i)).norm(), 1e-5);
}

TEST(Fill, SpheresInOnePlaceComeApart) {
  const std::vector<double> radii(50, 1.0);
  for (const int dimension : {2, 3, 4}) {
    FillCase filled(radii, cube_filled_to(0.5 * dense[dimension - 1], radii, dimension));
    filled.in_box.placed = true;
    expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
  }
}

TEST(Fill, TheLimitOnSweepsEndsIt) {
  const std::vector<double> radii(300, 1.0);
  FillCase filled(radii, cube_filled_to(0.62, radii, 3));
  EXPECT_EQ(fill_by_relaxation(filled.in_box, filled.report, {.sweeps = 30}), StageEnd::hit_limit);
  EXPECT_LT(filled.in_box.spheres.size(), radii.size());
  EXPECT_FALSE(filled.in_box.spheres.empty());
  expect_free_of_overlap(filled.in_box);
}

TEST(Fill, CancelledItLeavesWhatIsFree) {
  const std::vector<double> radii(300, 1.0);
  for (const auto fill : {fill_by_relaxation, fill_by_classes}) {
    FillCase filled(radii, cube_filled_to(0.62, radii, 3));
    int asked = 0;
    filled.monitor.cancelled = [&] { return ++asked > 5; };
    EXPECT_EQ(fill(filled.in_box, filled.report, {}), StageEnd::cancelled);
    EXPECT_FALSE(filled.in_box.spheres.empty());
    expect_free_of_overlap(filled.in_box);
  }
}

// ---- classes

TEST(FillByRelaxation, KeepsWholeSpheresBetweenWalls) {
  const double reached[] = {0.9, 0.72, 0.5, 0.25, 0.11, 0.045, 0.015, 0.005};
  for (int dimension = 1; dimension <= 8; ++dimension) {
    SCOPED_TRACE(dimension);
    const std::vector<double> radii = lognormal_radii(200, 0.1);
    FillCase filled(radii, cube_filled_to(reached[dimension - 1], radii, dimension));
    filled.task.walls.assign(static_cast<std::size_t>(dimension), true);
    filled.task.walls.back() = dimension == 1;  // one axis is periodic where there are several
    expect_filled(filled, fill_by_relaxation(filled.in_box, filled.report, {}), radii);
    for (int k = 0; k < dimension; ++k) {
      if (!filled.task.has_wall(k)) continue;
      const std::vector<double>& x = filled.in_box.spheres.x[static_cast<std::size_t>(k)];
      for (std::size_t i = 0; i < radii.size(); ++i) {
        EXPECT_GE(x[i], radii[i]);
        EXPECT_LE(x[i] + radii[i], filled.in_box.edges[k]);
      }
    }
  }
}

TEST(FillByRelaxation, ABoxAskedToHoldManyTimesItsFillIsFilledNevertheless) {
  const std::vector<double> radii(1000, 1.0);
  FillCase filled(radii, cube_filled_to(4, radii, 3));
  EXPECT_EQ(fill_by_relaxation(filled.in_box, filled.report, {}), StageEnd::full);
  expect_free_of_overlap(filled.in_box);
  EXPECT_GT(filled.in_box.spheres.size(), 120u);  // 0.48 of the box, well above what random places reach
}

TEST(FillByClasses, WidelyDifferentSizesFillABox) {
  const std::vector<double> radii = testing::three_classes(1000);
  FillCase filled(radii, cube_filled_to(0.65, radii, 3));
  expect_filled(filled, fill_by_classes(filled.in_box, filled.report, {}), radii);
}

TEST(FillByClasses, LooseSpheresNeedNoRelaxation) {
  const std::vector<double> radii = testing::three_classes(1000);
  FillCase filled(radii, cube_filled_to(0.45, radii, 3));
  expect_filled(filled, fill_by_classes(filled.in_box, filled.report, {}), radii);
  for (const Effect& effect : filled.effects.all()) EXPECT_NE(effect.name, "relaxation");
}

TEST(FillByClasses, SpheresThatHavePlacesKeepThem) {
  const std::vector<double> radii(50, 1.0);
  FillCase filled(radii, cube_filled_to(0.3, radii, 3));
  ASSERT_EQ(fill_by_classes(filled.in_box, filled.report, {}), StageEnd::converged);
  const Spheres<dynamic> before = filled.in_box.spheres;
  ASSERT_EQ(fill_by_classes(filled.in_box, filled.report, {}), StageEnd::converged);
  EXPECT_EQ(filled.in_box.spheres, before);
}

}  // namespace fill_test
}  // namespace bernal

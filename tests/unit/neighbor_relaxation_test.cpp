#include "soft/neighbor_relaxation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bernal/core/boundary.hpp"
#include "bernal/core/dimension.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace neighbor_relaxation_test {

/// With omega = 0 nothing moves: a measuring sweep finds the overlaps and forces that a look at all images of
/// all pairs finds, with the grid or without it.
template <int D>
void expect_same_overlaps(std::size_t n, const Vector<D>& edges, double r_max) {
  const Spheres<D> spheres = testing::ideal_gas<D>(n, 0.5 * r_max, r_max, edges, 5);
  NeighborRelaxation<D> relaxation(spheres, edges);
  const double largest = relaxation.sweep_and_measure(0);
  const std::vector<float> squeeze = relaxation.squeeze(), forces = relaxation.forces();

  const Boundary<D> boundary{edges};
  double largest_expected = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double expected = 0, force = 0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i) continue;
      const double reach = spheres.r[i] + spheres.r[j];
      boundary.for_each_image(spheres.center(i) - spheres.center(j), reach, [&](const Vector<D>& d) {
        const double ratio = std::max(0.0, 1 - d.norm() / reach);
        expected += ratio * ratio;
        force += 2 * spheres.r[i] * spheres.r[j] * ratio;
        largest_expected = std::max(largest_expected, ratio);
      });
    }
    // Single precision: each ratio is good to 1e-6.
    EXPECT_NEAR(squeeze[i], expected, 1e-5 * std::max(1.0, expected)) << i;
    EXPECT_NEAR(forces[i], force, 1e-5 * std::max(r_max * r_max, force)) << i;
  }
  EXPECT_NEAR(largest, largest_expected, 1e-6);
}

template <class T>
class NeighborRelaxationTest : public ::testing::Test {};
template <int D>
using Int = std::integral_constant<int, D>;
using Dimensions = ::testing::Types<Int<1>, Int<2>, Int<3>, Int<4>, Int<5>, Int<6>, Int<7>, Int<8>>;
TYPED_TEST_SUITE(NeighborRelaxationTest, Dimensions);

TYPED_TEST(NeighborRelaxationTest, FindsAllOverlaps) {
  constexpr int D = TypeParam::value;
  // Some ten neighbours each, in a box of many, some and hardly more than one diameter across.
  const double volume = 10 / std::exp2(D) / ball_volume(D, 1.0);
  for (const std::size_t n : {50u, 1000u}) {
    Vector<D> edges = Vector<D>::Ones();
    edges[0] = D > 1 ? 1.5 : 1;
    const double r_max = std::min(0.49, std::pow(volume / static_cast<double>(n), 1.0 / D));
    expect_same_overlaps<D>(n, edges, r_max);
  }
  expect_same_overlaps<D>(10, Vector<D>::Ones(), 0.49);
}

TYPED_TEST(NeighborRelaxationTest, TwoThatOverlapComeToTouchInOneSweep) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(10);
  Spheres<D> spheres;
  Vector<D> c = Vector<D>::Constant(9.9), d = c;
  d[D - 1] = 0.4;  // across the face: a distance of 0.5
  spheres.push_back(c, 1);
  spheres.push_back(d, 1);
  NeighborRelaxation<D> relaxation(spheres, edges);
  EXPECT_NEAR(relaxation.sweep_and_measure(1), 0.75, 1e-6);
  EXPECT_LT(relaxation.sweep_and_measure(1), 1e-6);
  Vector<D> after;
  relaxation.write_to(spheres, after);
  EXPECT_EQ(after, edges);
  const Boundary<D> boundary{edges};
  EXPECT_NEAR(boundary.minimum_image(spheres.center(0) - spheres.center(1)).norm(), 2, 1e-6);
}

TYPED_TEST(NeighborRelaxationTest, AGrowingBoxKeepsCentresInProportion) {
  constexpr int D = TypeParam::value;
  const Vector<D> edges = Vector<D>::Constant(10);
  const Spheres<D> before = testing::ideal_gas<D>(20, 0.5, 1, edges, 2);
  NeighborRelaxation<D> relaxation(before, edges);
  relaxation.grow(1.5);
  Spheres<D> after = before;
  Vector<D> larger;
  relaxation.write_to(after, larger);
  EXPECT_NEAR(larger[0], 15, 1e-12);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((after.center(i) - 1.5 * before.center(i)).norm(), 1e-7);
  EXPECT_EQ(after.r, before.r);
}

}  // namespace neighbor_relaxation_test
}  // namespace bernal

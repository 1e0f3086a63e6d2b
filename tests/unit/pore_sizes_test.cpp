#include "bernal/measure/pore_sizes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bernal/core/random.hpp"
#include "near/sphere_tree.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace pore_sizes_test {

using namespace testing;

TEST(SphereTree, FindsWhatBruteForceFinds) {
  Random random(5, stream(Stream::test));
  for (const bool periodic : {false, true}) {
    const Vector<3> edges(1, 0.3, 2);
    const Boundary<3> boundary{periodic ? Vector<3>(1, 0, 2) : Vector<3>::Zero(), {-0.5, 0, 0}};
    Spheres<3> spheres;
    for (int i = 0; i < 300; ++i)
      spheres.push_back(uniform_point<3>(random, {-edges, 2 * edges}),
                        0.005 * std::pow(100, random.uniform()));
    const SphereTree<3> tree(spheres, boundary);
    for (int q = 0; q < 500; ++q) {
      const Vector<3> p = uniform_point<3>(random, {-2 * edges, 2 * edges});
      double gap = 1e9;
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double d = boundary.minimum_image(spheres.center(i) - p).norm();
        gap = std::min(gap, d - spheres.r[i]);
      }
      const auto nearest = tree.nearest(p);
      EXPECT_NEAR(nearest.gap, gap, 1e-12);
      EXPECT_NEAR((nearest.center - p).norm() - tree.radius(nearest.place), gap, 1e-12);
    }
  }
}

TEST(PoreSizes, OfTheSimpleCubicLatticeAreInClosedForm) {
  // Spheres of radius 1/2 at the corners of the unit cube. Below 1/√2 - 1/2 what is nearer than d are shells
  // cut by the faces of their cubes; below 1/2 of spheres of radius R = 1/2 + d they are balls with six caps
  // off.
  const PoreSizes pores = pore_sizes(simple_cubic(3).spheres, simple_cubic(3).domain).value();
  const double pi = std::numbers::pi, porosity = 1 - pi / 6;
  EXPECT_NEAR(pores.porosity, porosity, 4 * pores.porosity_error);
  EXPECT_NEAR(pores.largest, std::sqrt(3.0) / 2 - 0.5, 0.02);
  const auto nearer = [&](double d) {
    const double R = 0.5 + d, h = R - 0.5;
    return (4 * pi / 3 * R * R * R - 6 * pi * h * h * (3 * R - h) / 3 - pi / 6) / porosity;
  };
  double below = 0;
  for (std::size_t k = 0; k < pores.d.size(); ++k) {
    const double to = pores.d[k] + 0.5 * pores.bin_width;
    if (to > std::sqrt(0.5) - 0.5) break;
    below += pores.density[k] * pores.bin_width;
    EXPECT_NEAR(below, nearer(to), 5 * std::sqrt(0.25 / static_cast<double>(pores.in_pores))) << to;
  }
  EXPECT_GT(below, 0.7);
}

TEST(PoreSizes, BeginWithTheSurfaceOverTheVolume) {
  // In a box: P(0) is the surface of spheres and walls over the volume of the pores.
  const Box box{{1e4, 0, 0}, {4, 4, 4}};
  Spheres<3> spheres;
  spheres.push_back({1e4 + 2, 2, 2}, 1);
  const PoreSizes pores = pore_sizes(spheres, box, {.bin = 0.005}).value();
  const double pi = std::numbers::pi, volume = 64 - 4 * pi / 3;
  EXPECT_NEAR(pores.porosity, volume / 64, 4 * pores.porosity_error);
  // Some of it at a distance d: walls shrink, spheres grow.
  const auto surface = [&](double d) { return 6 * (4 - 2 * d) * (4 - 2 * d) + 4 * pi * (1 + d) * (1 + d); };
  for (std::size_t k = 0; k < 20; ++k)
    EXPECT_NEAR(pores.density[k], surface(pores.d[k]) / volume, 5 * pores.error[k]) << pores.d[k];
  double sum = 0;
  for (const double p : pores.density) sum += p * pores.bin_width;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(PoreSizes, OfADiscBetweenWallsAndOfOneInABox) {
  Spheres<2> disc;
  disc.push_back({0.5, 0.5}, 0.5);
  const PoreSizes held = pore_sizes(disc, Box{{0, 0}, {1, 1}}).value();
  EXPECT_NEAR(held.porosity, 1 - std::numbers::pi / 4, 4 * held.porosity_error);
  EXPECT_LT(held.largest, 0.09);  // a disc in the corner: (3 - 2√2) / 2
  EXPECT_GT(held.largest, 0.08);
  const PoreSizes repeated = pore_sizes(disc, periodic_box(Vector<2>(1, 1))).value();
  EXPECT_NEAR(repeated.largest, std::sqrt(0.5) - 0.5, 0.01);
}

TEST(PoreSizes, AreThereInManyDimensionsAndAbsentWhereNothingIs) {
  const Vector<5> edges = Vector<5>::Constant(3);
  const PoreSizes pores =
      pore_sizes(ideal_gas<5>(100, 0.3, 0.5, edges, 1), periodic_box(edges), {.points = 2000}).value();
  EXPECT_GT(pores.mean, 0);
  EXPECT_GE(pores.second_moment, pores.mean * pores.mean);
  EXPECT_FALSE(pore_sizes(Spheres<3>{}, periodic_box(Vector<3>(1, 1, 1))));
  Spheres<3> all;  // no pore at all
  all.push_back({0, 0, 0}, 1);
  const PoreSizes none = pore_sizes(all, periodic_box(Vector<3>(1, 1, 1))).value();
  EXPECT_EQ(none.porosity, 0);
  EXPECT_EQ(none.mean, 0);
}

}  // namespace pore_sizes_test
}  // namespace bernal

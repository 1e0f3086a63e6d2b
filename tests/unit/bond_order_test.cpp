#include "bernal/measure/bond_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bernal/run/run.hpp"
#include "measure/harmonics.hpp"
#include "support/measured.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace bond_order_test {

using testing::face_centred;
using testing::lattice;
using testing::packing_of;

/// A triangular layer of n x n touching spheres of radius 1 on the floor z = 0.
Spheres<3> layer_on_the_floor(int n) {
  Spheres<3> spheres;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) spheres.push_back({2.0 * i + (j % 2), std::sqrt(3.0) * j, 1}, 1);
  return spheres;
}

/// 2,000 equal spheres at random close packing: relaxed for no longer than that takes, as more sweeps order
/// them, by default 1.4 % of them.
const Packing& random_packing() {
  static const Packing packing = run(testing::plan_of(
      "unit = \"mm\"\n[container]\nkind = \"periodic\"\n[spheres]\ncount = 2000\nradius = 1.0\n"
      "[[stage]]\ndo = \"relax\"\nalpha = 2\n"));
  return packing;
}

TEST(BondOrder, HarmonicsObeyTheAdditionTheorem) {
  Random random(1, stream(Stream::test));
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector<3> a = uniform_direction<3>(random), b = uniform_direction<3>(random);
    const double t = a.dot(b), t2 = t * t;
    EXPECT_NEAR(harmonics6(a).dot(harmonics6(b)), (231 * t2 * t2 * t2 - 315 * t2 * t2 + 105 * t2 - 5) / 16,
                1e-13);
  }
}

TEST(BondOrder, CrystalsAreCrystalline) {
  // Hexagonal layers at the distance √(8/3) r, every other one over the first.
  const Packing hcp = lattice<3>({{0, 0, 0}, {.5, .5, 0}, {.5, .5 / 3, .5}, {0, .5 + .5 / 3, .5}},
                                 {1, std::sqrt(3.0), std::sqrt(8.0 / 3)}, {6, 4, 4}, 0.5);
  for (const Packing& packing : {face_centred(4), hcp}) {
    const BondOrder order = bond_order(packing).value();
    EXPECT_EQ(order.all.spheres, packing.spheres.size());
    EXPECT_EQ(order.all.crystalline, order.all.spheres);
    EXPECT_FALSE(order.near_wall);
  }
}

TEST(BondOrder, MeanQ6IsThatOfSteinhardt) {
  // Steinhardt, Nelson & Ronchetti (1983), table I: fcc and hcp, twelve neighbours each.
  const BondOrder fcc = bond_order(face_centred(4)).value();
  EXPECT_NEAR(fcc.mean_q6, 0.57452, 1e-5);
  EXPECT_NEAR(fcc.q6_error, 0, 1e-6);
  // By the definition with P6 of the angles between bonds, all pairs of spheres.
  const Packing& packing = random_packing();
  const Spheres<3> spheres = packing.spheres.in<3>();
  const Boundary<3> box = boundary_of<3>(packing.domain);
  double sum = 0;
  constexpr std::size_t looked_from = 40;
  std::vector<double> all;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    if (i == looked_from) break;
    std::vector<Vector<3>> bonds;
    for (std::size_t j = 0; j < spheres.size(); ++j) {
      const Vector<3> d = box.minimum_image(spheres.center(j) - spheres.center(i));
      if (j != i && d.norm() < (1 + BondOrder::widest_gap) * (spheres.r[i] + spheres.r[j]))
        bonds.push_back(d.normalized());
    }
    double squared = 0;
    for (const Vector<3>& a : bonds)
      for (const Vector<3>& b : bonds) {
        const double t = a.dot(b), t2 = t * t;
        squared += (231 * t2 * t2 * t2 - 315 * t2 * t2 + 105 * t2 - 5) / 16;
      }
    all.push_back(std::sqrt(squared) / static_cast<double>(bonds.size()));
    sum += all.back();
  }
  // So few of the spheres have a mean within its own error, of which the standard deviation is known.
  const BondOrder order = bond_order(packing).value();
  const double deviation = order.q6_error * std::sqrt(static_cast<double>(spheres.size()));
  EXPECT_NEAR(sum / looked_from, order.mean_q6, 4 * deviation / std::sqrt(1.0 * looked_from));
  EXPECT_LT(order.mean_q6, 0.45);
  EXPECT_GT(order.mean_q6, 0.3);
}

TEST(BondOrder, RandomPackingsAreNot) {
  // Some surroundings look ordered by chance: of 24 such packings 0.6 %, with a deviation of 0.35 %.
  EXPECT_LT(bond_order(random_packing())->all.fraction(), 0.02);
  const Packing gas = testing::periodic_packing<3>(
      testing::ideal_gas<3>(2000, 0.5, 0.5, Vector<3>::Constant(12), 1), Vector<3>::Constant(12));
  EXPECT_LT(bond_order(gas)->all.fraction(), 0.02);
}

TEST(BondOrder, SeesALayerThatAWallHasOrderedUnderARandomPacking) {
  Spheres<3> spheres = layer_on_the_floor(14);
  const Vector<3> size(28, 14 * std::sqrt(3.0), 24);
  const Packing& above = random_packing();
  std::uint64_t inner = 12 * 12, in_layer = spheres.size();
  for (std::size_t i = 0; i < above.spheres.size(); ++i) {
    const Vector<3> p = above.spheres.center(i);
    if (p[2] > 2.75 && p[2] < size[2] - 1 && p[0] < size[0] && p[1] < size[1])
      spheres.push_back(p, above.spheres.r[i]);
  }
  std::vector<Region> regions(spheres.size(), Region::core);
  std::fill_n(regions.begin(), in_layer, Region::near_wall);
  const BondOrder order =
      bond_order(packing_of(spheres, {{-1, -1, 0}, size + Vector<3>(2, 2, 0)}), regions).value();
  EXPECT_EQ(order.near_wall->spheres, in_layer);
  EXPECT_GT(order.near_wall->crystalline, 9 * inner / 10);
  // By chance 0.6 %, and of those that lie on the layer more.
  EXPECT_LT(order.core->fraction(), 0.03);
  EXPECT_EQ(order.all.spheres, spheres.size());
}

TEST(BondOrder, OfLooseSpheresIsNone) {
  // One or two bonds are always alike, which makes no crystal.
  Spheres<3> spheres;
  EXPECT_EQ(bond_order(packing_of(spheres, Box{}))->all.fraction(), 0);
  for (int i = 0; i < 4; ++i) {
    spheres.push_back({2.0 * i + 1, 1, 1}, 1);
    EXPECT_EQ(bond_order(packing_of(spheres, {Vector<3>::Zero(), Vector<3>::Constant(9)}))->all.crystalline,
              0u);
  }
}

TEST(BondOrder, DoesNotDependOnOrientationOrUnit) {
  Packing packing = random_packing();
  const std::uint64_t crystalline = bond_order(packing)->all.crystalline;
  EXPECT_GT(crystalline, 0u);
  std::swap(packing.spheres.x[0], packing.spheres.x[2]);
  for (double& x : packing.spheres.x[1]) x = std::get<Box>(packing.domain).size[1] - x;
  EXPECT_EQ(bond_order(packing)->all.crystalline, crystalline);
}

TEST(BondOrder, IsOfThreeDimensions) {
  EXPECT_FALSE(bond_order(testing::lattice<2>({{.5, .5}}, {2, 2}, {3, 3}, 1)));
}

}  // namespace bond_order_test
}  // namespace bernal

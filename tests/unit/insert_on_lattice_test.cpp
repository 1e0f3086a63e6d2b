#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace insert_on_lattice_test {

using testing::plan_of;

Packing packed(const std::string& toml) { return run(plan_of(toml), {.threads = 1}); }
Packing packed(const std::string& toml, const Domain& domain) {
  return run(plan_of(toml, domain), {.threads = 1});
}

const std::string box = "[container]\nkind = \"box\"\nsize = [10.0, 10.0, 10.0]\n";
std::string lattice(double packing_fraction) {
  return "[[stage]]\ndo = \"insert\"\nlayout = \"lattice\"\npacking_fraction = " +
         std::to_string(packing_fraction) + "\n";
}

/// The distance from every sphere to the nearest other.
std::vector<double> nearest(const Packing& packing) {
  const Spheres<dynamic>& s = packing.spheres;
  std::vector<double> distances(s.size(), 1e300);
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = 0; j < s.size(); ++j)
      if (i != j) distances[i] = std::min(distances[i], (s.center(i) - s.center(j)).norm());
  return distances;
}

void expect_certified(const Packing& packing) {
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
}

TEST(InsertOnLattice, PutsEqualSpheresOnFaceCentredSites) {
  const Packing packing = packed(box + "[spheres]\nfill = true\nradius = 0.5\n" + lattice(0.3));
  expect_certified(packing);
  EXPECT_GE(packing.packing_fraction(), 0.3);
  EXPECT_LT(packing.packing_fraction(), 0.3 + 2 * 0.5236 / 1000);  // no more than one sphere beyond
  for (int k = 0; k < 3; ++k) {  // a few planes across each axis, at equal distances, and no centre elsewhere
    std::set<long> planes;
    for (const double x : packing.spheres.x[static_cast<std::size_t>(k)]) planes.insert(std::lround(1e6 * x));
    EXPECT_LE(planes.size(), 15u);
    const long step = *std::next(planes.begin()) - *planes.begin();
    for (const long x : planes) EXPECT_NEAR(std::remainder(double(x - *planes.begin()), double(step)), 0, 20);
  }
}

/// The densest lattice in a cube of 10 diameters is 8 x 14 x 14 half-steps of sqrt(1/2): 0.74 less the
/// walls'.
TEST(InsertOnLattice, IsAsDenseAsTheLatticeAndNoDenser) {
  const Packing packing = packed(box + "[spheres]\nfill = true\nradius = 0.5\n" + lattice(0.9));
  expect_certified(packing);
  // 13 planes across each axis of the 9 diameters that centres have: 13³ / 2 sites, rounded up.
  EXPECT_EQ(packing.spheres.size(), (13u * 13u * 13u + 1) / 2);
  for (const double d : nearest(packing)) EXPECT_NEAR(d, 1, 1e-6);
}

TEST(InsertOnLattice, SpreadsFewSpheresOverTheContainer) {
  for (const int count : {1, 2, 8, 100}) {
    const Packing packing =
        packed(box + "[spheres]\ncount = " + std::to_string(count) + "\nradius = 0.5\n" + lattice(0.3));
    expect_certified(packing);
    ASSERT_EQ(packing.spheres.size(), static_cast<std::size_t>(count));
    EXPECT_EQ(packing.outcome, Outcome::converged);
    // As far apart as a lattice of that density would be in free space, or nearly.
    const double free = std::cbrt(std::sqrt(2) * 1000 / count);
    if (count == 1) continue;
    for (const double d : nearest(packing)) EXPECT_GT(d, 0.6 * free) << count;
  }
}

TEST(InsertOnLattice, DividesThePeriodsEvenly) {
  const Packing column = packed(
      "[container]\nkind = \"cylinder\"\nradius = 4.0\nheight = 9.3\nperiodic = true\n"
      "[spheres]\nfill = true\nradius = 0.5\n" +
      lattice(0.9));
  expect_certified(column);
  // 0.74, less where the period is no multiple of the cell, over the cross-section that centres have.
  EXPECT_GT(column.packing_fraction(), 0.8 * 0.74 * 0.875 * 0.875);
  const Packing slab = packed(
      "[container]\nkind = \"periodic\"\nsize = [7.7, 8.3, 4.0]\nwalls = [2]\n"
      "[spheres]\nfill = true\nradius = 0.5\n" +
      lattice(0.9));
  expect_certified(slab);
  EXPECT_GT(slab.packing_fraction(), 0.5);
}

TEST(InsertOnLattice, PutsSmallSpheresBetweenLargeOnes) {
  const std::string wide =
      "[spheres]\nfill = true\nradius = { distribution = \"classes\", values = [0.2, 0.6], shares = [0.9, "
      "0.1] }\n";
  const Packing packing = packed(box + wide + lattice(0.3));
  expect_certified(packing);
  // The sites of a lattice on which the largest touch would give all of them 0.74 (0.1 + 0.9 / 27) = 0.1.
  EXPECT_GT(packing.packing_fraction(), 0.15);
}

TEST(InsertOnLattice, LeavesWhatStandsThereAndSaysWhatItLacks) {
  const Packing again = packed(box + "[spheres]\nfill = true\nradius = 0.5\n" + lattice(0.2) + lattice(0.4));
  expect_certified(again);
  EXPECT_GT(again.packing_fraction(), 0.2);
  const Packing too_many = packed(box + "[spheres]\ncount = 1300\nradius = 0.5\n" + lattice(0.9));
  expect_certified(too_many);
  EXPECT_EQ(too_many.outcome, Outcome::full);
  EXPECT_EQ(too_many.spheres.size(), (13u * 13u * 13u + 1) / 2);
}

TEST(InsertOnLattice, OfHardlyAnySpheresInMuchRoomCostsNothing) {
  const Packing packing = packed(box + "[spheres]\ncount = 3\nradius = 0.0001\n" + lattice(0.3));
  EXPECT_EQ(packing.spheres.size(), 3u);
  EXPECT_LT(packing.seconds, 5);
}

/// The largest of many are far larger than the mean: a lattice on which they touch would hold next to
/// nothing.
TEST(InsertOnLattice, HoldsSizesWithATailNoLooserThanRandomPlaces) {
  const std::string tail =
      "[spheres]\nfill = true\ndiameter = { distribution = \"lognormal\", median = 0.5, sigma = 0.5 }\n";
  const Packing regular = packed(box + tail + lattice(0.3));
  expect_certified(regular);
  const Packing random = packed(box + tail + "[[stage]]\ndo = \"insert\"\n");
  EXPECT_GT(regular.packing_fraction(), random.packing_fraction());
}

TEST(InsertOnLattice, PlacesTheOneThatFitsExactly) {
  const std::string diameter = "[spheres]\nfill = true\nradius = 0.5\n";
  const Packing slab =
      packed("[container]\nkind = \"box\"\nsize = [10.0, 10.0, 1.0]\n" + diameter + lattice(0.9));
  expect_certified(slab);
  EXPECT_GT(slab.spheres.size(), 40u);
  const Packing ball = packed("[container]\nkind = \"sphere\"\nradius = 1.0\n" + diameter + lattice(0.9));
  expect_certified(ball);
  EXPECT_GE(ball.spheres.size(), 1u);
}

}  // namespace insert_on_lattice_test
}  // namespace bernal

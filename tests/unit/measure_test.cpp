#include "bernal/measure/measure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bernal/core/error.hpp"
#include "support/measured.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace measure_test {

using testing::packing_of;
using testing::scattered;

const Box far_walls{Vector<3>::Constant(-500), Vector<3>::Constant(1000)};

/// n x n x n cubic cells of the face-centred lattice whose spheres of radius 1 touch, the first one at zero.
Spheres<3> fcc_block(int n) {
  Spheres<3> spheres;
  const double a = 2 * std::sqrt(2.0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Vector<3> corner(i, j, k);
        for (const Vector<3>& site :
             {Vector<3>(0, 0, 0), Vector<3>(0, .5, .5), Vector<3>(.5, 0, .5), Vector<3>(.5, .5, 0)}) {
          spheres.push_back(a * (corner + site), 1);
        }
      }
    }
  }
  return spheres;
}

TEST(Contacts, AnEmptyPackingHasNone) {
  const Contacts contacts = measure_contacts(packing_of({}, far_walls));
  EXPECT_EQ(contacts.pairs, 0u);
  EXPECT_EQ(contacts.walls, 0u);
  EXPECT_EQ(contacts.rattlers, 0u);
  EXPECT_EQ(contacts.coordination, 0);
}

TEST(Contacts, OfThousandsInOnePlaceAreRefused) {
  Spheres<3> spheres;
  for (int i = 0; i < 20'000; ++i) spheres.push_back({0, 0, 0}, 1);
  EXPECT_THROW(measure_contacts(packing_of(spheres, far_walls)), Error);
}

TEST(Contacts, TwoSpheresTouchBelowTheGapAndNotAboveIt) {
  for (const auto& [gap, touching] : {std::pair{0.0019, 1u}, std::pair{0.0021, 0u}, std::pair{-0.1, 1u}}) {
    Spheres<3> spheres;
    spheres.push_back({0, 0, 0}, 1);
    spheres.push_back({0, (1 + gap) * 1.25, 0}, 0.25);
    const Contacts contacts = measure_contacts(packing_of(spheres, far_walls));
    EXPECT_EQ(contacts.pairs, touching) << gap;
    EXPECT_EQ(contacts.coordination, touching) << gap;
    EXPECT_EQ(contacts.rattlers, 2u) << gap;
  }
}

TEST(Contacts, FccHasTwelveNeighboursLessWhatTheSurfaceTakes) {
  // In half-cells the sites are the triples in [0, 2n - 1]^3 with an even sum, and the twelve neighbours are
  // (0, +-1, +-1) and its permutations: six directions, in each of which n (2n - 1)^2 bonds have both ends.
  for (const int n : {1, 2, 5}) {
    const Contacts contacts = measure_contacts(packing_of(fcc_block(n), far_walls));
    const double bonds = 6.0 * n * (2 * n - 1) * (2 * n - 1);
    EXPECT_EQ(contacts.pairs, bonds);
    EXPECT_DOUBLE_EQ(contacts.coordination, 2 * bonds / (4 * n * n * n));
  }
}

TEST(Contacts, RattlersAreTakenOutUntilNoneIsLeft) {
  // A tetrahedron of four spheres: three contacts each are too few, two walls more are enough.
  Spheres<3> spheres;
  const double h = 1 / std::sqrt(2.0);
  for (const Vector<3>& c :
       {Vector<3>(1, 0, -h), Vector<3>(-1, 0, -h), Vector<3>(0, 1, h), Vector<3>(0, -1, h)}) {
    spheres.push_back(c, 1);
  }
  EXPECT_EQ(measure_contacts(packing_of(spheres, far_walls)).rattlers, 4u);

  const Box tight{{-2, -2, -h - 1}, {4, 4, 2 * h + 2}};
  const Contacts held = measure_contacts(packing_of(spheres, tight));
  EXPECT_EQ(held.pairs, 6u);
  EXPECT_EQ(held.walls, 8u);  // each: one side, and floor or ceiling
  EXPECT_EQ(held.rattlers, 0u);
}

TEST(Contacts, AChainFallsApartFromItsEnd) {
  // In a tube as wide as the spheres each one touches four walls and is held; in a wider one each has at most
  // two neighbours, so the ends go first and then everyone.
  Spheres<3> spheres;
  for (int i = 0; i < 50; ++i) spheres.push_back({0, 0, 2.0 * i}, 1);
  const Box tube{{-1, -1, -1}, {2, 2, 100}}, hall{{-5, -5, -1}, {10, 10, 100}};
  EXPECT_EQ(measure_contacts(packing_of(spheres, tube)).rattlers, 0u);
  EXPECT_EQ(measure_contacts(packing_of(spheres, tube)).walls, 202u);
  EXPECT_EQ(measure_contacts(packing_of(spheres, hall)).rattlers, 50u);
}

TEST(Contacts, AgreeWithBruteForceHoweverWideTheSizes) {
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};
  for (const double r_min : {0.02, 0.2, 0.45}) {
    for (const double gap : {0.002, 0.2, 1.0}) {
      const Spheres<3> spheres = scattered(700, r_min, 1, bounds_of(box), 7, true);
      std::uint64_t pairs = 0, walls = 0;
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Vector<3> c = spheres.center(i);
        for (std::size_t j = 0; j < i; ++j) {
          const double sum = spheres.r[i] + spheres.r[j];
          pairs += (c - spheres.center(j)).norm() < (1 + gap) * sum;
        }
        for (int k = 0; k < 3; ++k) {
          walls += c[k] < (1 + gap) * spheres.r[i];
          walls += 10 - c[k] < (1 + gap) * spheres.r[i];
        }
      }
      const Contacts contacts = measure_contacts(packing_of(spheres, box), gap);
      ASSERT_GT(pairs, 100u);
      EXPECT_EQ(contacts.pairs, pairs) << r_min << " " << gap;
      EXPECT_EQ(contacts.walls, walls) << r_min << " " << gap;
    }
  }
}

TEST(Contacts, DoNotDependOnWhereTheSceneStandsOrItsUnit) {
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};
  const Spheres<3> spheres = scattered(400, 0.2, 1, bounds_of(box), 3, true);
  const Contacts here = measure_contacts(packing_of(spheres, box));
  for (const double scale : {1e-6, 1e6}) {
    const Vector<3> shift = Vector<3>(1e4, -3e4, 2e4) * scale;
    Spheres<3> moved;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      moved.push_back(scale * spheres.center(i) + shift, scale * spheres.r[i]);
    }
    const Contacts there = measure_contacts(packing_of(moved, {shift, scale * box.size}));
    EXPECT_EQ(there.pairs, here.pairs);
    EXPECT_EQ(there.walls, here.walls);
    EXPECT_EQ(there.rattlers, here.rattlers);
  }
}

TEST(Hash, IsPinnedAndSeesEveryBitAndTheOrder) {
  EXPECT_EQ(hash_of(Spheres<3>{}), "cbf29ce484222325");  // FNV-1a of nothing
  Spheres<3> spheres;
  spheres.push_back({1, 2, 3}, 0.5);
  spheres.push_back({-1, 0.1, 1e-300}, 2);
  const std::string pinned = hash_of(spheres);
  EXPECT_EQ(pinned, "6799d4be37db0a1c");

  Spheres<3> swapped;
  swapped.push_back(spheres.center(1), spheres.r[1]);
  swapped.push_back(spheres.center(0), spheres.r[0]);
  EXPECT_NE(hash_of(swapped), pinned);
  for (int k = 0; k < 3; ++k) {
    Spheres<3> changed = spheres;
    changed.x[k][1] = std::nextafter(changed.x[k][1], 10);
    EXPECT_NE(hash_of(changed), pinned) << k;
  }
  Spheres<3> changed = spheres;
  changed.r[0] = std::nextafter(0.5, 1);
  EXPECT_NE(hash_of(changed), pinned);
}

}  // namespace measure_test
}  // namespace bernal

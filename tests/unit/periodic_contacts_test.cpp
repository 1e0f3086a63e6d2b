#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "bernal/measure/contacts.hpp"
#include "near/point_grid.hpp"
#include "support/measured.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace periodic_contacts_test {

using testing::ideal_gas;
using testing::periodic_packing;

/// Every shift of the box by up to `turns` edges on each axis.
template <int D>
std::vector<Vector<D>> shifts(const Vector<D>& edges, int turns) {
  std::vector<Vector<D>> all = {Vector<D>::Zero()};
  for (int k = 0; k < D; ++k) {
    const std::size_t before = all.size();
    for (int turn = -turns; turn <= turns; ++turn) {
      for (std::size_t i = 0; turn != 0 && i < before; ++i) {
        all.push_back(all[i]);
        all.back()[k] += turn * edges[k];
      }
    }
  }
  return all;
}

TEST(PeriodicContacts, LatticesHaveTheNeighboursThatTheirNamesPromise) {
  // Down to boxes of one cell, in which a sphere touches several images of its neighbour, or its own.
  for (const int n : {1, 2, 3, 5}) {
    SCOPED_TRACE(n);
    const std::pair<Packing, double> known[] = {{testing::simple_cubic(n), 6},
                                                {testing::body_centred(n), 8},
                                                {testing::face_centred(n), 12},
                                                {testing::hexagonal_discs(n), 6}};
    for (const auto& [packing, coordination] : known) {
      const Contacts contacts = measure_contacts(packing, 1e-9);
      EXPECT_EQ(contacts.coordination, coordination);
      EXPECT_EQ(contacts.pairs, coordination / 2 * static_cast<double>(packing.spheres.size()));
      EXPECT_EQ(contacts.walls, 0u);
    }
  }
}

TEST(PeriodicContacts, ALatticeIsItsOwnBackbone) {
  const Contacts contacts = measure_contacts(testing::face_centred(4), 1e-9);
  EXPECT_EQ(contacts.rattlers, 0u);
  EXPECT_EQ(contacts.backbone, 256u);
  EXPECT_EQ(contacts.backbone_pairs, contacts.pairs);
  EXPECT_EQ(contacts.backbone_coordination, 12);
  EXPECT_EQ(contacts.isostatic, 3u * 255 + 1);
}

TEST(PeriodicContacts, ASphereIsNotHeldByItsOwnImage) {
  const Contacts alone = measure_contacts(testing::simple_cubic(1), 1e-9);
  EXPECT_EQ(alone.pairs, 3u);
  EXPECT_EQ(alone.rattlers, 1u);
  EXPECT_EQ(alone.backbone_pairs, 0u);
  EXPECT_FALSE(alone.isostatic);
}

TEST(PeriodicContacts, ARattlerInItsCageIsTakenOutAndTheCageStays) {
  // A small sphere in the middle of each cell of the simple cubic lattice, which it does not touch.
  const Packing packing = testing::simple_cubic(3);
  auto spheres = packing.spheres.in<3>();
  for (std::size_t i = 0; i < 27; ++i) spheres.push_back(spheres.center(i) + Vector<3>::Constant(0.5), 0.3);
  const Contacts contacts = measure_contacts(periodic_packing<3>(spheres, Vector<3>::Constant(3)), 1e-9);
  EXPECT_EQ(contacts.rattlers, 27u);
  EXPECT_EQ(contacts.backbone, 27u);
  EXPECT_EQ(contacts.backbone_pairs, 81u);
  EXPECT_EQ(contacts.backbone_coordination, 6);
  EXPECT_EQ(contacts.isostatic, 3u * 26 + 1);
}

/// Returns how many contacts were compared at the widest gap.
template <int D>
std::uint64_t agree_with_brute_force(std::size_t n, double r_min, double r_max, const Vector<D>& edges,
                                     int turns, std::uint64_t seed) {
  const Spheres<D> spheres = ideal_gas<D>(n, r_min, r_max, edges, seed);
  const std::vector<double> gaps = {-0.3, 0.002, 0.2};
  std::vector<std::uint64_t> pairs(gaps.size(), 0);
  for (const Vector<D>& shift : shifts<D>(edges, turns)) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j && shift.isZero()) continue;
        const double d = (spheres.center(i) - spheres.center(j) + shift).norm();
        for (std::size_t g = 0; g < gaps.size(); ++g)
          pairs[g] += d < (1 + gaps[g]) * (spheres.r[i] + spheres.r[j]);
      }
    }
  }
  const std::vector<Contacts> contacts = measure_contacts(periodic_packing<D>(spheres, edges), gaps);
  for (std::size_t g = 0; g < gaps.size(); ++g)
    EXPECT_EQ(contacts[g].pairs, pairs[g] / 2) << D << " dimensions, gap " << gaps[g];
  return contacts.back().pairs;
}

TEST(PeriodicContacts, AgreeWithBruteForceOverAllImages) {
  EXPECT_GT(agree_with_brute_force<1>(300, 0.001, 0.1, Vector<1>(10), 1, 1), 10u);
  EXPECT_GT(agree_with_brute_force<2>(500, 0.02, 0.4, {10, 7}, 1, 2), 10u);
  EXPECT_GT(agree_with_brute_force<3>(500, 0.04, 0.8, {10, 8, 9}, 1, 3), 10u);
  EXPECT_GT(agree_with_brute_force<4>(300, 0.1, 0.8, {5, 4, 6, 5}, 1, 4), 10u);
  EXPECT_GT(agree_with_brute_force<5>(60, 0.3, 0.6, Vector<5>::Constant(3), 1, 5), 10u);
  EXPECT_GT(agree_with_brute_force<8>(24, 0.8, 0.9, Vector<8>::Constant(3.5), 1, 6), 10u);
}

TEST(PeriodicContacts, AgreeWithBruteForceInBoxesSmallerThanASphere) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    agree_with_brute_force<2>(1 + seed % 5, 0.1, 1.2, {1, 1.7}, 4, seed);
    agree_with_brute_force<3>(1 + seed % 5, 0.1, 0.9, {1.1, 2.3, 0.8}, 4, seed);
    agree_with_brute_force<4>(1 + seed % 3, 0.2, 0.7, {1.5, 1.2, 2, 3}, 3, seed);
  }
}

TEST(PeriodicContacts, DoNotDependOnWhichImageOfACentreIsGiven) {
  const Vector<3> edges(4, 5, 6);
  Spheres<3> spheres = ideal_gas<3>(200, 0.1, 0.5, edges, 9);
  const Contacts inside = measure_contacts(periodic_packing<3>(spheres, edges));
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<3> turns(i % 3, i % 5, i % 2);
    spheres.set_center(i, spheres.center(i) + (turns - Vector<3>(1, 2, 1)).cwiseProduct(edges));
  }
  const Contacts shifted = measure_contacts(periodic_packing<3>(spheres, edges));
  EXPECT_EQ(shifted.pairs, inside.pairs);
  EXPECT_EQ(shifted.rattlers, inside.rattlers);
}

TEST(PointGrid, VisitsEveryImageOnce) {
  const Vector<3> edges(3, 1, 2);
  const Spheres<3> points = ideal_gas<3>(40, 0, 0, edges, 5);
  std::vector<std::uint32_t> ids(points.size());
  for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
  for (const bool open : {false, true}) {
    // An open axis has no images.
    const Boundary<3> boundary{open ? Vector<3>(3, 0, 2) : edges};
    for (const double reach : {0.05, 0.4, 1.5, 4.0}) {
      const PointGrid<3> grid(points, ids, boundary, reach);
      const Vector<3> c(0.1, 0.9, 1.0);
      std::multiset<std::uint32_t> found, expected;
      grid.for_each_near(c, reach, [&](std::uint32_t id, const Vector<3>& d) {
        if (d.norm() >= reach) return;
        found.insert(id);
        const Vector<3> turns = (points.center(id) - c - d).cwiseQuotient(edges);
        EXPECT_LT((turns - turns.array().round().matrix()).norm(), 1e-12);
      });
      for (const Vector<3>& shift : shifts<3>(edges, 5)) {
        if (open && shift[1] != 0) continue;
        for (const std::uint32_t id : ids)
          if ((points.center(id) - c + shift).norm() < reach) expected.insert(id);
      }
      EXPECT_EQ(found, expected) << reach << open;
    }
  }
}

}  // namespace periodic_contacts_test
}  // namespace bernal

#include "bernal/measure/contact_list.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <tuple>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/measure/contacts.hpp"
#include "support/containers.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace contact_list_test {

using testing::ideal_gas;
using testing::periodic_packing;

template <int D>
struct Expected {
  std::int64_t i, j;
  double gap;
  Vector<D> normal, place;
};

/// All pairs in all images of up to two periods, and all pairs of a sphere with its own image once.
template <int D>
std::vector<Expected<D>> by_brute_force(const Spheres<D>& spheres, const Vector<D>& edges, double ratio) {
  std::vector<Expected<D>> all;
  const auto n = static_cast<std::int64_t>(spheres.size());
  std::vector<Vector<D>> shifts = {Vector<D>::Zero()};
  for (int k = 0; k < D; ++k) {
    const std::size_t before = shifts.size();
    for (const int turn : {-2, -1, 1, 2})
      for (std::size_t s = 0; s < before; ++s) {
        shifts.push_back(shifts[s]);
        shifts.back()[k] += turn * edges[k];
      }
  }
  for (std::int64_t i = 0; i < n; ++i)
    for (std::int64_t j = i; j < n; ++j)
      for (const Vector<D>& shift : shifts) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const Vector<D> d = spheres.center(b) + shift - spheres.center(a);
        const double sum = spheres.r[a] + spheres.r[b], distance = d.norm();
        if (i == j && !(distance > 0)) continue;
        if (!(distance < (1 + ratio) * sum)) continue;
        const Vector<D> normal = d / distance;
        all.push_back({i, j, distance - sum, normal,
                       spheres.center(a) + (spheres.r[a] + 0.5 * (distance - sum)) * normal});
      }
  return all;
}

template <int D>
Vector<D> row(const std::vector<std::vector<double>>& columns, std::size_t c) {
  Vector<D> v;
  for (int k = 0; k < D; ++k) v[k] = columns[static_cast<std::size_t>(k)][c];
  return v;
}

/// Every contact of the list is one expected, and there are as many; of a pair of a sphere and its own image
/// either direction may stand there.
template <int D>
std::size_t same_as_brute_force(std::size_t n, double r_min, double r_max, const Vector<D>& edges,
                                std::uint64_t seed, double ratio) {
  const Spheres<D> spheres = ideal_gas<D>(n, r_min, r_max, edges, seed);
  const auto packing = periodic_packing<D>(spheres, edges);
  const ContactList list = contact_list(packing.spheres, packing.domain, {.contact_gap = ratio});
  std::vector<Expected<D>> expected = by_brute_force<D>(spheres, edges, ratio);
  std::size_t own = 0;
  for (const auto& e : expected) own += e.i == e.j;
  EXPECT_EQ(list.size(), expected.size() - own / 2);
  EXPECT_EQ(list.size(), measure_contacts(packing.spheres, packing.domain, ratio).pairs);
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (c > 0) {
      EXPECT_LE(std::tuple(list.i[c - 1], list.j[c - 1]), std::tuple(list.i[c], list.j[c]));
    }
    const auto found = std::ranges::find_if(expected, [&](const Expected<D>& e) {
      return e.i == list.i[c] && e.j == list.j[c] && std::abs(e.gap - list.gap[c]) < 1e-12 &&
             (e.normal - row<D>(list.normal, c)).norm() < 1e-9 &&
             (e.place - row<D>(list.place, c)).norm() < 1e-9;
    });
    if (found == expected.end()) {
      ADD_FAILURE() << list.i[c] << " " << list.j[c] << " gap " << list.gap[c];
      continue;
    }
    expected.erase(found);
  }
  EXPECT_EQ(expected.size(), own / 2);
  return list.size();
}

TEST(ContactList, IsThatOfAllPairsInAllImages) {
  EXPECT_GT(same_as_brute_force<1>(60, 0.01, 0.1, Vector<1>(10), 1, 0.1), 10u);
  EXPECT_GT(same_as_brute_force<2>(100, 0.02, 0.6, {10, 7}, 2, 0.002), 10u);
  EXPECT_GT(same_as_brute_force<3>(150, 0.04, 0.9, {10, 8, 9}, 3, 0.05), 10u);
  EXPECT_GT(same_as_brute_force<3>(150, 0.01, 1.5, {10, 8, 9}, 4, -0.1), 10u);
  EXPECT_GT(same_as_brute_force<5>(30, 0.3, 0.6, Vector<5>::Constant(3), 5, 0.01), 5u);
}

TEST(ContactList, HasASphereAndItsOwnImageOnce) {
  const auto one = testing::simple_cubic(1);
  const ContactList list = contact_list(one.spheres, one.domain);
  ASSERT_EQ(list.size(), 3u);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(list.i[c], list.j[c]);
  const ContactSums sums = contact_sums(one.spheres, one.domain);
  EXPECT_EQ(sums.coordination, std::vector<std::uint32_t>{6});
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    same_as_brute_force<3>(4, 0.1, 0.9, {1.4, 2.3, 1.2}, seed, 0.002);
}

TEST(ContactList, OfWallsHasTheirNormalsAndPlaces) {
  // One sphere in a corner of a box, with a gap at one of its walls, and another that it touches.
  Spheres<3> spheres;
  spheres.push_back({1, 1.001, 1}, 1);
  spheres.push_back({1, 1.001, 2.5}, 0.5);
  const Box box{Vector<3>::Zero(), Vector<3>(5, 5, 5)};
  const ContactList list = contact_list(spheres, box);
  ASSERT_EQ(list.size(), 4u);
  Vector<3> sum = Vector<3>::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(list.i[c], 0);
    EXPECT_EQ(list.j[c], ContactList::wall);
    const Vector<3> normal = row<3>(list.normal, c), place = row<3>(list.place, c);
    EXPECT_NEAR((place - spheres.center(0)).norm(), 1 + 0.5 * list.gap[c], 1e-12);
    EXPECT_NEAR(list.gap[c], normal[1] < -0.5 ? 0.001 : 0, 1e-12);
    sum += normal;
  }
  EXPECT_NEAR((sum - Vector<3>(-1, -1, -1)).norm(), 0, 1e-12);
  EXPECT_EQ(list.j[3], 1);
  EXPECT_NEAR((row<3>(list.normal, 3) - Vector<3>::UnitZ()).norm(), 0, 1e-12);
  EXPECT_NEAR((row<3>(list.place, 3) - Vector<3>(1, 1.001, 2)).norm(), 0, 1e-12);
}

TEST(ContactList, OfARoundWallPointsOutwards) {
  const Cylinder cylinder{.base = {2, 3, 4}, .radius = 2, .height = 10};
  Spheres<3> spheres;
  spheres.push_back({2 + 1.5 * 0.6, 3 + 1.5 * 0.8, 9}, 0.5);
  const ContactList list = contact_list(spheres, cylinder);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NEAR((row<3>(list.normal, 0) - Vector<3>(0.6, 0.8, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((row<3>(list.place, 0) - Vector<3>(2 + 2 * 0.6, 3 + 2 * 0.8, 9)).norm(), 0, 1e-12);
}

TEST(ContactList, OfSpheresThatKeepAGapHasTheirRealDistance) {
  Spheres<3> spheres;
  spheres.push_back({1.2, 3, 3}, 1);
  spheres.push_back({3.3, 3, 3}, 1);
  const Box box{Vector<3>::Zero(), Vector<3>(6, 6, 6)};
  EXPECT_EQ(contact_list(spheres, box).size(), 0u);
  const ContactList list = contact_list(spheres, box, {.gap = 0.1, .wall_gap = 0.2});
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list.j[0], ContactList::wall);
  EXPECT_NEAR(list.gap[0], 0.2, 1e-12);
  EXPECT_NEAR(list.place[0][0], 0.1, 1e-12);
  EXPECT_EQ(list.j[1], 1);
  EXPECT_NEAR(list.gap[1], 0.1, 1e-12);
  EXPECT_NEAR(list.place[0][1], 2.25, 1e-12);
}

TEST(ContactList, HasAsManyAsAreCountedInEveryContainer) {
  for (const auto& tested : test::containers_under_test()) {
    const Domain& domain = tested.shape;
    SCOPED_TRACE(tested.name);
    Spheres<3> spheres = testing::scattered(200, 0.02 * bounds_of(domain).diagonal(),
                                            0.1 * bounds_of(domain).diagonal(), bounds_of(domain), 7, true);
    const Contacts counted = measure_contacts(spheres, domain, 0.05);
    const ContactList list = contact_list(spheres, domain, {.contact_gap = 0.05});
    EXPECT_EQ(static_cast<std::uint64_t>(std::ranges::count(list.j, ContactList::wall)), counted.walls);
    EXPECT_EQ(list.size(), counted.pairs + counted.walls);
    const ContactSums sums = contact_sums(spheres, domain, {.contact_gap = 0.05});
    EXPECT_EQ(std::accumulate(sums.coordination.begin(), sums.coordination.end(), std::uint64_t{0}),
              2 * counted.pairs);
  }
}

TEST(ContactSums, CountTheNeighboursOfEverySphereAndTheirDirections) {
  for (const int n : {1, 2, 4}) {
    for (const auto& [packing, coordination] :
         {std::pair{testing::simple_cubic(n), 6U}, std::pair{testing::body_centred(n), 8U},
          std::pair{testing::face_centred(n), 12U}}) {
      const ContactSums sums = contact_sums(packing.spheres, packing.domain, {.contact_gap = 1e-9});
      for (const std::uint32_t own : sums.coordination) EXPECT_EQ(own, coordination);
      EXPECT_EQ(sums.spheres_by_contacts().size(), coordination + 1);
      EXPECT_EQ(sums.spheres_by_contacts().back(), packing.spheres.size());
      ASSERT_EQ(sums.fabric.size(), 3u);
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) EXPECT_NEAR(sums.fabric[a][b], a == b ? 1.0 / 3 : 0, 1e-12);
    }
  }
}

TEST(ContactSums, AreThoseOfTheList) {
  const Vector<3> edges(5, 7, 6);
  const Packing packing = periodic_packing<3>(ideal_gas<3>(300, 0.1, 0.8, edges, 11), edges);
  const ContactList list = contact_list(packing.spheres, packing.domain, {.contact_gap = 0.1});
  const ContactSums sums = contact_sums(packing.spheres, packing.domain, {.contact_gap = 0.1});
  std::vector<std::uint32_t> ends(packing.spheres.size(), 0);
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();
  for (std::size_t c = 0; c < list.size(); ++c) {
    ++ends[static_cast<std::size_t>(list.i[c])];
    ++ends[static_cast<std::size_t>(list.j[c])];
    const Vector<3> n = row<3>(list.normal, c);
    fabric += n * n.transpose() / static_cast<double>(list.size());
  }
  EXPECT_EQ(sums.coordination, ends);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      EXPECT_NEAR(sums.fabric[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)], fabric(a, b), 1e-12);
  EXPECT_TRUE(contact_sums(Spheres<dynamic>(3), packing.domain).fabric.empty());
  EXPECT_THROW(contact_list(packing.spheres, packing.domain, {.contact_gap = 2}), Error);
}

}  // namespace contact_list_test
}  // namespace bernal

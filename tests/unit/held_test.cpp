#include "jam/held.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

// What holds spheres is counted from where they lie, in lattices whose contacts are known.
namespace bernal {
namespace held_test {

constexpr double gap = 1e-9;

/// Discs of radius 1/2 at these places of a cell, in so many cells along each axis.
template <int D>
struct Lattice {
  Spheres<D> spheres;
  Vector<D> edges;
};
template <int D>
Lattice<D> lattice(const std::vector<Vector<D>>& places, const Vector<D>& cell, int cells) {
  Lattice<D> made{{}, cell * cells};
  std::array<int, D> at{};
  for (int k = 0; k < D;) {
    Vector<D> corner;
    for (int j = 0; j < D; ++j) corner[j] = at[j] * cell[j];
    for (const Vector<D>& place : places) made.spheres.push_back(corner + place, 0.5);
    for (k = 0; k < D && ++at[k] == cells; ++k) at[k] = 0;
  }
  return made;
}

template <int D>
std::optional<std::string> open_in(const Lattice<D>& made, double at = gap) {
  return what_is_open(at, D, made.spheres.size(), D,
                      contacts_at<D>(at, made.spheres, made.edges, std::vector<bool>{}));
}

const double root = std::sqrt(3.0);

TEST(Held, IsATriangularLatticeOfDiscs) {
  const auto made = lattice<2>({{0, 0}, {0.5, 0.5 * root}}, {1, root}, 3);
  EXPECT_EQ(contacts_at<2>(gap, made.spheres, made.edges, {}).size(), 3 * made.spheres.size());
  EXPECT_FALSE(open_in(made));
}

TEST(Held, IsAFaceCentredLatticeOfSpheres) {
  const double a = std::sqrt(2.0), h = 0.5 * a;
  const auto made = lattice<3>({{0, 0, 0}, {h, h, 0}, {h, 0, h}, {0, h, h}}, {a, a, a}, 2);
  EXPECT_EQ(contacts_at<3>(gap, made.spheres, made.edges, {}).size(), 6 * made.spheres.size());
  EXPECT_FALSE(open_in(made));
}

/// Every disc has the three contacts that hold it, and together they are too few.
TEST(Held, IsNoHoneycomb) {
  const auto made = lattice<2>({{0, 0}, {1, 0}, {1.5, 0.5 * root}, {2.5, 0.5 * root}}, {3, root}, 2);
  const std::size_t n = made.spheres.size();
  EXPECT_EQ(contacts_at<2>(gap, made.spheres, made.edges, {}).size(), 3 * n / 2);
  const auto open = open_in(made);
  ASSERT_TRUE(open);
  EXPECT_NE(open->find("7 of the 31 contacts that just hold 16 spheres are open"), std::string::npos)
      << *open;
}

TEST(Held, IsNothingThatIsApart) {
  auto made = lattice<2>({{0, 0}, {0.5, 0.5 * root}}, {1, root}, 3);
  for (double& r : made.spheres.r) r *= 1 - 1e-6;
  const auto open = open_in(made, 1e-7);
  ASSERT_TRUE(open);
  EXPECT_NE(open->find("no sphere is held"), std::string::npos) << *open;
  EXPECT_FALSE(open_in(made, 1e-5));
}

/// One sphere that touches its cube all around: 6 contacts, where 3 - 0 + 1 would do. A column holds it on
/// four sides only, of a box that repeats itself along the third.
TEST(Held, IsASphereBetweenWalls) {
  Spheres<3> one;
  one.push_back({0.5, 0.5, 0.5}, 0.5);
  const Vector<3> cube = Vector<3>::Ones();
  const std::vector<bool> all{true, true, true};
  const auto contacts = contacts_at<3>(gap, one, cube, all);
  EXPECT_EQ(contacts.size(), 6u);
  EXPECT_FALSE(what_is_open(gap, 3, 1, 0, contacts));
  const std::vector<bool> two{true, true, false};
  EXPECT_EQ(contacts_at<3>(gap, one, {1, 1, 2}, two).size(), 4u);
  EXPECT_FALSE(what_is_open(gap, 3, 1, 1, contacts_at<3>(gap, one, {1, 1, 2}, two)));
  EXPECT_TRUE(what_is_open(gap, 3, 1, 0, contacts_at<3>(gap, one, {1, 1, 2}, {true, false, false})));
}

/// A rattler has contacts and counts for nothing.
TEST(Held, LeavesRattlersOut) {
  const std::vector<Hold> ring{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}, {3, 4}, {4, Hold::wall}};
  const Backbone backbone = backbone_of(2, 5, ring);
  EXPECT_EQ(backbone.spheres, 4u);
  EXPECT_EQ(backbone.holds, 6u);
  EXPECT_EQ(backbone.has[4], 0);
}

}  // namespace held_test
}  // namespace bernal

#include "work/holes.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace bernal {
namespace holes_test {

constexpr double r = 0.1;  // of the spheres that are there

std::unique_ptr<Container> box_of(const Vector<3>& size) {
  return make_analytic_container(Box{Vector<3>::Zero(), size}, WallArithmetic::plain, 0x1p-50);
}

/// Simple cubic, five spheres along each edge of a box that they just fill, but those for which `missing`.
template <class Missing>
Spheres<3> cubic(Missing missing) {
  Spheres<3> spheres;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 5; ++k)
        if (!missing(i, j, k)) spheres.push_back(r * Vector<3>(2 * i + 1, 2 * j + 1, 2 * k + 1), r);
  return spheres;
}

/// By definition, and no more than the largest radius.
double room_at(const Vector<3>& p, const Spheres<3>& spheres) {
  double room = std::ranges::max(spheres.r);
  for (std::size_t i = 0; i < spheres.size(); ++i)
    room = std::min(room, (spheres.center(i) - p).norm() - spheres.r[i]);
  return room;
}

std::vector<Hole> holes_in(const Container& container, const Spheres<3>& spheres,
                           const std::vector<double>& radii, std::size_t probes) {
  const Places places(container);
  Random random(5, stream(Stream::test));
  return holes_for(radii, container, places, spheres, probes, random);
}

Spheres<3> random_crowd(const Container& container, std::size_t n, double smallest, double largest) {
  Random random(6, stream(Stream::test));
  Spheres<3> spheres;
  while (spheres.size() < n)
    spheres.push_back(uniform_point(random, container.bounds()), random.uniform(smallest, largest));
  return spheres;
}

TEST(Holes, AreFoundWhereASphereIsMissing) {
  // The gaps between eight spheres have a room of (√3 - 1) r; what lies nearer than (2 - √3) r to the place
  // that is empty has more. Of 10^6 probes 80 fall there, of which an eighth clears the wall in the corner:
  // none does with a probability of 4e-5. Nearer to the corner there is as much room, but not for a sphere.
  const auto container = box_of({1, 1, 1});
  for (const auto& [i, j, k] : {std::array{2, 2, 2}, std::array{0, 4, 2}, std::array{0, 0, 0}}) {
    const Spheres<3> spheres = cubic([&](int a, int b, int c) { return a == i && b == j && c == k; });
    const Vector<3> missing = r * Vector<3>(2 * i + 1, 2 * j + 1, 2 * k + 1);
    const std::vector<Hole> holes = holes_in(*container, spheres, {r}, 1000000);
    ASSERT_EQ(holes.size(), 1u);
    EXPECT_GE(holes[0].clearance, r);
    EXPECT_LT((holes[0].place - missing).norm(), (2 - std::numbers::sqrt3) * r);
  }
}

TEST(Holes, KnowTheirRoomAndClearance) {
  const auto container = box_of({1, 2, 1});
  const Spheres<3> spheres = random_crowd(*container, 400, 0.02, 0.2);
  const std::vector<double> radii{0.1, 0.1, 0.08, 0.08, 0.05, 0.05, 0.05, 0.02};
  const std::vector<Hole> holes = holes_in(*container, spheres, radii, 2000);
  ASSERT_EQ(holes.size(), radii.size());
  for (const Hole& hole : holes) {
    EXPECT_DOUBLE_EQ(hole.room, room_at(hole.place, spheres));
    EXPECT_DOUBLE_EQ(hole.clearance, container->clearance_within(hole.place, radii.front()));
  }
}

/// All probes, again: the same stream of random places.
TEST(Holes, AreTheRoomiestOfThePlacesThatClearTheWall) {
  const auto container = box_of({1, 1, 1});
  const Places places(*container);
  const Spheres<3> spheres = random_crowd(*container, 300, 0.05, 0.15);
  Random random(5, stream(Stream::test));
  double roomiest = -1;
  for (int n = 0; n < 3000; ++n) {
    const Vector<3> p = places.draw(random);
    if (container->clearance(p) >= 0.1) roomiest = std::max(roomiest, room_at(p, spheres));
  }
  const std::vector<Hole> holes = holes_in(*container, spheres, std::vector<double>(8, 0.1), 3000);
  ASSERT_EQ(holes.size(), 8u);
  EXPECT_DOUBLE_EQ(holes[0].room, roomiest);
  for (std::size_t k = 1; k < holes.size(); ++k) EXPECT_LE(holes[k].room, holes[k - 1].room);
}

TEST(Holes, ClearTheWallAndEachOther) {
  const auto container = box_of({1, 1, 1});
  const Spheres<3> spheres = random_crowd(*container, 200, 0.05, 0.1);
  std::vector<double> radii;
  for (int k = 0; k < 60; ++k) radii.push_back(0.2 - 0.0025 * k);
  const std::vector<Hole> holes = holes_in(*container, spheres, radii, 20000);
  ASSERT_EQ(holes.size(), radii.size());
  for (std::size_t k = 0; k < holes.size(); ++k) {
    EXPECT_GE(holes[k].clearance, radii[k]) << k;
    for (std::size_t j = 0; j < k; ++j)
      EXPECT_GE((holes[k].place - holes[j].place).norm(), 0.5 * (radii[k] + 0.05)) << j << " " << k;
  }
}

TEST(Holes, InAPartThatIsTooThinAreItsMiddle) {
  // None clears the wall: the clearance is 0.06 at most. Places nearer to the wall than half a radius do not
  // count.
  const auto container = box_of({1, 1, 0.12});
  const Spheres<3> spheres = random_crowd(*container, 10, 0.05, 0.1);
  const std::vector<Hole> holes = holes_in(*container, spheres, std::vector<double>(5, 0.1), 5000);
  ASSERT_EQ(holes.size(), 5u);
  for (const Hole& hole : holes) EXPECT_GE(hole.clearance, 0.05);
  EXPECT_TRUE(holes_in(*container, spheres, {0.13}, 5000).empty());
}

TEST(Holes, AreFoundAcrossASeam) {
  // Only half of the hole is on either side; the lattice goes on there, and so do spheres.
  const auto container =
      make_analytic_container(Box{{0, 0, 0}, {1, 1, 1}, {false, true, true}}, WallArithmetic::plain, 0x1p-50);
  Spheres<3> spheres;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 5; ++k)
        if (i != 2 || j != 0 || k != 0) spheres.push_back(r * Vector<3>(2 * i + 1, 2 * j, 2 * k), r);
  const std::vector<Hole> holes = holes_in(*container, spheres, {r}, 1000000);
  ASSERT_EQ(holes.size(), 1u);
  const Vector<3> from_missing = container->boundary().minimum_image(holes[0].place - Vector<3>(0.5, 0, 0));
  EXPECT_LT(from_missing.norm(), (2 - std::numbers::sqrt3) * r);
  double room = r;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    room = std::min(
        room, container->boundary().minimum_image(spheres.center(i) - holes[0].place).norm() - spheres.r[i]);
  EXPECT_DOUBLE_EQ(holes[0].room, room);
}

TEST(Holes, AreFewerWhereThereAreNotSoMany) {
  const auto container = box_of({1, 1, 1});
  const Spheres<3> spheres = random_crowd(*container, 10, 0.05, 0.1);
  EXPECT_LE(holes_in(*container, spheres, std::vector<double>(10, 0.05), 4).size(), 4u);
  // No two places that clear the wall of the cube by half of this radius are half of it and more apart.
  EXPECT_EQ(holes_in(*container, spheres, std::vector<double>(10, 0.8), 2000).size(), 1u);
}

}  // namespace holes_test
}  // namespace bernal

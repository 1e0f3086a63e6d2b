#include "work/bed.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bernal/core/random.hpp"

namespace bernal {
namespace bed_test {

/// What two beds of the same size make of spheres: all at once, and one after the other.
struct Both {
  bool together = true, apart = true;
  std::size_t left = 0;  // in the bed after all at once
};

Both put(const Container& container, const Spheres<3>& spheres) {
  EffectLog effects;
  const auto [least, most] = std::ranges::minmax(spheres.r);
  Bed together(container, least, most, spheres.size(), effects),
      apart(container, least, most, spheres.size(), effects);
  Both both;
  both.together = together.insert_if_all_fit(spheres);
  both.left = together.size();
  for (std::uint32_t i = 0; i < spheres.size() && both.apart; ++i) {
    both.apart = apart.fits(spheres.center(i), spheres.r[i]);
    if (both.apart) apart.insert(spheres.center(i), spheres.r[i], i);
  }
  if (!both.together) return both;
  EXPECT_EQ(together.spheres().x, apart.spheres().x);
  EXPECT_EQ(together.packing_fraction(), apart.packing_fraction());
  for (Bed::Id i = 0; i < together.size(); ++i) EXPECT_EQ(together.tag(i), i);
  return both;
}

/// Simple cubic, `n` along each edge of the unit cube; they fill this share of their cells' edges.
Spheres<3> cubic(int n, double share) {
  Spheres<3> spheres;
  const double cell = 1.0 / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        spheres.push_back(cell * Vector<3>(i + 0.5, j + 0.5, k + 0.5), 0.5 * share * cell);
  return spheres;
}

TEST(Bed, TakesAllAtOnceAsOneAfterTheOther) {
  const auto cube = make_analytic_container(Box{{0, 0, 0}, {1, 1, 1}}, WallArithmetic::filtered, 0x1p-50);
  const auto column = make_analytic_container(Box{{0, 0, 0}, {1, 1, 1}, {true, false, false}},
                                              WallArithmetic::filtered, 0x1p-50);
  for (const Container* container : {cube.get(), column.get()}) {
    EXPECT_TRUE(put(*container, cubic(16, 0.999)).together);
    // One that is too large, that is too near to another, and that is in the wall: the last of all, or the
    // first.
    for (const std::size_t changed : {std::size_t{0}, std::size_t{2000}, std::size_t{4095}}) {
      for (const auto& change : {+[](Spheres<3>&s, std::size_t i) { s.r[i] *= 1.01; },
                                 +[](Spheres<3>&s, std::size_t i) { s.set_center(i, s.center(1)); },
                                 +[](Spheres<3>&s, std::size_t i) { s.x[1][i] = 0.01; }}) {
        Spheres<3> spheres = cubic(16, 0.999);
        change(spheres, changed);
        const Both both = put(*container, spheres);
        EXPECT_FALSE(both.together);
        EXPECT_FALSE(both.apart);
        EXPECT_EQ(both.left, 0u);
      }
    }
  }
}

/// Across the seam of a column its ends are neighbours.
TEST(Bed, TakesNoneThatMeetAcrossASeam) {
  const auto column = make_analytic_container(Box{{0, 0, 0}, {1, 1, 1}, {true, false, false}},
                                              WallArithmetic::filtered, 0x1p-50);
  Spheres<3> spheres;
  spheres.push_back({0.05, 0.5, 0.5}, 0.1);
  spheres.push_back({0.9, 0.5, 0.5}, 0.1);
  EXPECT_FALSE(put(*column, spheres).together);
  spheres.set_center(1, {0.84, 0.5, 0.5});
  EXPECT_TRUE(put(*column, spheres).together);
}

/// Walls that decide exactly are asked one by one, by the same effect.
TEST(Bed, LeavesExactWallsToOneAfterTheOther) {
  const auto cube = make_analytic_container(Box{{0, 0, 0}, {1, 1, 1}}, WallArithmetic::exact, 0x1p-50);
  EXPECT_FALSE(put(*cube, cubic(2, 0.9)).together);
}

}  // namespace bed_test
}  // namespace bernal

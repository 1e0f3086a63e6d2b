#include "domain/without_rod.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bernal/domain/domain.hpp"

namespace bernal {
namespace {

using Profile = std::vector<Vector<2>>;

const Profile can = {{0, 0}, {3, 0}, {3, 5}, {0, 5}};
const Profile funnel = {{0, -2}, {0.5, -2}, {0.5, 0}, {3, 2}, {3, 5}, {0, 5}};

/// By the parity of edges to the right of it.
bool is_in(const Profile& profile, const Vector<2>& p) {
  bool in = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Vector<2>&a = profile[i], &b = profile[(i + 1) % profile.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]))
      in = !in;
  }
  return in;
}

void expect_without(const Profile& profile, double radius, double from, double to) {
  Profile clockwise = profile;
  std::ranges::reverse(clockwise);
  for (const Profile& given : {profile, clockwise}) {
    const Profile rest = without_rod(given, radius, from, to);
    ASSERT_GE(rest.size(), 4u);
    EXPECT_NO_THROW(require_profile(Revolved{Vector<3>::Zero(), Vector<3>::UnitZ(), rest}));
    for (double r = 0.007; r < 3.5; r += 0.0301) {
      for (double z = -2.493; z < 6; z += 0.0307) {
        const bool expected = is_in(given, {r, z}) && !(r < radius && z > from && z < to);
        ASSERT_EQ(is_in(rest, {r, z}), expected) << r << ' ' << z;
      }
    }
  }
}

TEST(WithoutRod, IsWhatPointsSayThatItIs) {
  for (const Profile& profile : {can, funnel}) {
    for (const double radius : {0.2, 0.5, 1.7}) {
      expect_without(profile, radius, -3, 6);   // from end to end
      expect_without(profile, radius, -3, 4);   // from beneath the floor
      expect_without(profile, radius, 3, 5);    // hanging from the lid, its end in its plane
      expect_without(profile, radius, 2.5, 4);  // afloat
    }
  }
  expect_without(can, 1, 0, 2);  // standing on the floor
  EXPECT_EQ(without_rod(can, 1, 0, 2).size(), 6u);
}

TEST(WithoutRod, IsNothingWhereARodMissesOrFillsOrParts) {
  EXPECT_TRUE(without_rod(can, 1, 5, 7).empty());
  EXPECT_TRUE(without_rod(can, 3, -1, 6).empty());
  EXPECT_TRUE(without_rod(can, 4, 1, 2).empty());
}

}  // namespace
}  // namespace bernal

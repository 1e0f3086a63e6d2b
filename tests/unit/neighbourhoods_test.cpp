#include "measure/neighbourhoods.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "bernal/measure/contacts.hpp"
#include "support/packings.hpp"

namespace bernal {
namespace neighbourhoods_test {

using testing::scattered;

std::vector<std::uint32_t> all_of(std::size_t n) {
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

/// Over all pairs and all images up to `rings` periods away.
std::vector<double> gaps_by_force(const Spheres<3>& spheres, const Vector<3>& periods, int rings) {
  std::vector<double> gaps(spheres.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j < spheres.size(); ++j)
      for (int image = 0; image < (2 * rings + 1) * (2 * rings + 1) * (2 * rings + 1); ++image) {
        const int n = 2 * rings + 1;
        const Vector<3> step(image % n - rings, image / n % n - rings, image / (n * n) - rings);
        if ((i == j && step.isZero()) || (step.array() != 0 && periods.array() == 0).any()) continue;
        const Vector<3> d = spheres.center(j) - spheres.center(i) + step.cwiseProduct(periods);
        gaps[i] = std::min(gaps[i], d.norm() - spheres.r[i] - spheres.r[j]);
      }
  return gaps;
}

void expect_as_by_force(const Spheres<3>& spheres, const Domain& domain, int rings) {
  const Vector<3> periods = boundary_of<3>(domain).edges;
  const std::vector<double> expected = gaps_by_force(spheres, periods, rings);
  for (const double contact_gap : {1e-9, 0.002, 0.3}) {
    const Neighbourhoods found = neighbourhoods(spheres, domain, all_of(spheres.size()), 0, contact_gap);
    for (std::size_t i = 0; i < spheres.size(); ++i)
      if (std::isfinite(expected[i]))
        EXPECT_NEAR(found.gaps[i], expected[i], 1e-12 * (1 + std::abs(expected[i]))) << i;
      else
        EXPECT_EQ(found.gaps[i], expected[i]) << i;
    const auto sum = std::accumulate(found.contacts.begin(), found.contacts.end(), std::uint64_t{0});
    EXPECT_EQ(sum, 2 * measure_contacts(spheres, domain, contact_gap).pairs) << contact_gap;
  }
}

TEST(Neighbourhoods, AreThoseOfAllPairs) {
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};
  for (const bool touch : {false, true})
    expect_as_by_force(scattered(300, 0.05, 1.5, bounds_of(box), 5, touch), box, 0);
}

TEST(Neighbourhoods, FindWhatIsFarAndSizesOfAllKinds) {
  // From a grain of dust the next thing may be a thousand radii away, and it may be a giant.
  Spheres<3> spheres;
  spheres.push_back({-400, 0, 0}, 399.5);
  spheres.push_back({0, 0, 0}, 0.001);
  spheres.push_back({3, 4, 0}, 0.002);
  spheres.push_back({900, 0, 0}, 100);
  const Box box{Vector<3>::Constant(-1000), Vector<3>::Constant(2000)};
  expect_as_by_force(spheres, box, 0);
  expect_as_by_force(spheres, periodic_box(Vector<3>(2000, 1700, 1800)), 1);
}

TEST(Neighbourhoods, HaveImagesWherePeriodsAreShort) {
  Spheres<3> spheres;
  spheres.push_back({0.1, 0.2, 0.3}, 0.4);
  expect_as_by_force(spheres, periodic_box(Vector<3>(0.9, 3, 0.5)), 4);
  spheres.push_back({0.1, 1.2, 0.1}, 0.25);
  expect_as_by_force(spheres, periodic_box(Vector<3>(0.9, 3, 0.5)), 4);
  expect_as_by_force(spheres, periodic_box(Vector<3>(2, 3, 1), {true, true, false}), 3);
}

TEST(Neighbourhoods, CountContactsAcrossAGap) {
  const Box box{Vector<3>::Zero(), Vector<3>::Constant(10)};
  const Spheres<3> spheres = scattered(300, 0.3, 0.8, bounds_of(box), 8);
  const double gap = 0.05, contact_gap = 0.01;
  const Neighbourhoods found = neighbourhoods(spheres, box, all_of(spheres.size()), gap, contact_gap);
  const auto sum = std::accumulate(found.contacts.begin(), found.contacts.end(), std::uint64_t{0});
  ASSERT_GT(sum, 0u);
  EXPECT_EQ(sum, 2 * measure_contacts_across(gap, 0, spheres, box, {&contact_gap, 1}).front().pairs);
}

TEST(WallGaps, AreClearanceLessRadius) {
  const Box box{Vector<3>(1e6, 0, 0), Vector<3>(2, 3, 4)};
  Spheres<3> spheres;
  spheres.push_back({1e6 + 1, 1.5, 2}, 0.25);
  spheres.push_back({1e6 + 0.5, 1.5, 2}, 0.5);
  EXPECT_EQ(wall_gaps(spheres, box, all_of(2), nullptr), (std::vector<double>{0.75, 0}));
  const Cylinder column{Vector<3>::Zero(), Vector<3>::UnitZ(), 2, 1, true};
  Spheres<3> in_column;
  in_column.push_back({0, 1, 0.01}, 0.5);
  EXPECT_NEAR(wall_gaps(in_column, column, all_of(1), nullptr).at(0), 0.5, 1e-12);
}

}  // namespace neighbourhoods_test
}  // namespace bernal

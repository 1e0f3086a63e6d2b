#include "settle/roller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/measure/rest.hpp"
#include "support/plain_check.hpp"

// Where single spheres come to rest, in closed form; and that whole beds do, judged by a search that shares
// nothing with what moves them.
namespace bernal {
namespace roller_test {

const Vector<3> down(0, 0, -1);
const Box box{Vector<3>::Zero(), Vector<3>(10, 10, 20)};

/// A bed whose spheres roll, from the first to the last, until none moves.
Spheres<3> rolled(const Domain& domain, const Spheres<3>& spheres) {
  const auto container = make_analytic_container(domain, WallArithmetic::filtered, 0x1p-48);
  EffectLog effects;
  Bed bed(*container, std::ranges::min(spheres.r), std::ranges::max(spheres.r), spheres.size(), effects);
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    EXPECT_TRUE(bed.fits(spheres.center(i), spheres.r[i])) << i;
    bed.insert(spheres.center(i), spheres.r[i], i);
  }
  bool moves = true;
  for (int k = 0; k < 1000 && moves; ++k) {
    bed.enclose(0.5);
    Roller roller(bed, down);
    moves = false;
    for (Bed::Id i = 0; i < bed.size(); ++i) moves |= roller.roll(i) > 1e-8;
  }
  EXPECT_FALSE(moves);
  const Spheres<3> result = bed.spheres();
  EXPECT_EQ(testing::plain_objection(Spheres<dynamic>(result), domain, 0), "");
  EXPECT_EQ(measure_rest(Spheres<dynamic>(result), domain, down).unsettled, 0u);
  return result;
}

Spheres<3> of_unit_radius(std::initializer_list<Vector<3>> centers) {
  Spheres<3> spheres;
  for (const Vector<3>& c : centers) spheres.push_back(c, 1);
  return spheres;
}

constexpr double closed = 1e-8;

/// By trying all: down itself, in the plane of each contact, along the line of every two.
double steepest_of_all(const std::vector<Vector<3>>& normals) {
  double best = 0;
  const auto offer = [&](const Vector<3>& way) {
    if (way.norm() < 1e-9) return;
    const Vector<3> u = way.normalized();
    if (std::ranges::all_of(normals, [&](const Vector<3>& n) { return n.dot(u) > -1e-9; }))
      best = std::max(best, u.dot(down));
  };
  offer(down);
  for (const Vector<3>& a : normals) {
    offer(down - down.dot(a) * a);
    for (const Vector<3>& b : normals) offer(a.cross(b));
  }
  return best;
}

TEST(SteepestWay, IsTheSteepestOfAllThatLeadIntoNoContact) {
  Random random(3, 0);
  int held = 0;
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<Vector<3>> normals(1 + trial % 9);
    for (Vector<3>& n : normals) {
      do {
        for (int k = 0; k < 3; ++k) n[k] = 2 * random.uniform() - 1;
      } while (n.norm() > 1 || n.norm() < 0.1);
      n.normalize();
    }
    const SteepestWay found = steepest_way(down, normals);
    EXPECT_NEAR(found.way.norm(), steepest_of_all(normals), 1e-9) << trial;
    for (int k = 0; k < found.count; ++k)
      EXPECT_NEAR(normals[found.held_by[static_cast<std::size_t>(k)]].dot(found.way), 0, 1e-12) << trial;
    held += found.way.isZero(0);
  }
  EXPECT_GT(held, 500);
}

TEST(Roller, FallsToTheFloor) { EXPECT_NEAR(rolled(box, of_unit_radius({{5, 5, 17}})).x[2][0], 1, closed); }

TEST(Roller, RollsOffASphereAndStaysInItsMeridian) {
  const Vector<3> low(5, 5, 1 + 2e-9), high(5.03, 5.04, 12);
  const Vector<3> end = rolled(box, of_unit_radius({low, high})).center(1);
  EXPECT_NEAR(end[2], 1, closed);
  // It leaves where the other is beside it, and falls along that.
  EXPECT_NEAR(end[0], 5 + 2 * 0.6, 1e-6);
  EXPECT_NEAR(end[1], 5 + 2 * 0.8, 1e-6);
}

TEST(Roller, ComesToRestOnThree) {
  const double a = 2 / std::sqrt(3.0) + 1e-3;
  const Vector<3> middle(5, 5, 1 + 2e-9);
  Spheres<3> spheres = of_unit_radius({middle + Vector<3>(a, 0, 0),
                                       middle + Vector<3>(-0.5 * a, 0.5 * std::sqrt(3.0) * a, 0),
                                       middle + Vector<3>(-0.5 * a, -0.5 * std::sqrt(3.0) * a, 0),
                                       {5.2, 4.7, 9}});
  const Vector<3> end = rolled(box, spheres).center(3);
  EXPECT_NEAR(end[0], 5, 1e-6);
  EXPECT_NEAR(end[1], 5, 1e-6);
  EXPECT_NEAR(end[2], 1 + std::sqrt(4 - a * a), 1e-6);
}

TEST(Roller, ComesToRestAtTheBottomOfRoundWalls) {
  const Sphere ball{.radius = 5};
  const Vector<3> end = rolled(ball, of_unit_radius({{2.1, -1.3, 1.7}})).center(0);
  EXPECT_NEAR(end[2], -4, closed);
  EXPECT_LT(std::hypot(end[0], end[1]), 4 * 2e-6);
  const Cylinder lying{.axis = {1, 0, 0}, .radius = 3, .height = 9};
  const Vector<3> in_trough = rolled(lying, of_unit_radius({{4, 1.5, 0.4}})).center(0);
  EXPECT_NEAR(in_trough[2], -2, closed);
}

TEST(Roller, RollsAlongAValleyOfTwo) {
  // On two that touch walls, between which there is a hollow as long as the box: down to the third.
  const Spheres<3> ends =
      rolled(box, of_unit_radius({{4, 1.5, 1.1}, {6.1, 1.5, 1.1}, {5, 4.5, 1.1}, {5, 2.5, 7}}));
  EXPECT_LT(ends.x[2][3], 3);
}

TEST(Roller, BringsAnyBedToRest) {
  Random random(7, 0);
  for (const Domain& domain :
       {Domain(box), Domain(Sphere{.radius = 5}), Domain(Cylinder{.radius = 4, .height = 14}),
        Domain(Cylinder{.axis = {1, 2, 2}, .radius = 4, .height = 12})}) {
    const auto container = make_analytic_container(domain, WallArithmetic::filtered, 0x1p-48);
    const Bounds<3> bounds = container->bounds();
    Spheres<3> spheres;
    for (int trial = 0; trial < 3000; ++trial) {
      const double r = 0.3 + 0.6 * random.uniform();
      Vector<3> c;
      for (int k = 0; k < 3; ++k) c[k] = bounds.lower[k] + bounds.size()[k] * random.uniform();
      bool free = container->contains(c, r + 1e-6);
      for (std::size_t j = 0; j < spheres.size() && free; ++j)
        free = (spheres.center(j) - c).norm() > r + spheres.r[j] + 1e-6;
      if (free) spheres.push_back(c, r);
    }
    ASSERT_GT(spheres.size(), 60u);
    rolled(domain, spheres);
  }
}

TEST(Roller, StopsWhereFrictionHolds) {
  const auto place_after = [](double degrees, double friction) {
    const double angle = degrees * std::acos(-1.0) / 180;
    const auto container = make_analytic_container(box, WallArithmetic::filtered, 0x1p-48);
    EffectLog effects;
    Bed bed(*container, 1, 1, 2, effects);
    bed.insert({5, 5, 1}, 1, 0);
    bed.insert({5 + 2.001 * std::sin(angle), 5, 1 + 2.001 * std::cos(angle)}, 1, 1);
    for (int k = 0; k < 20; ++k) {
      bed.enclose(0.5);
      Roller(bed, down, friction).roll(1);
    }
    return bed[1].center;
  };
  const Vector<3> held = place_after(20, 25), rolled_off = place_after(20, 15), free = place_after(20, 0);
  EXPECT_NEAR(held[2], 1 + 2 * std::cos(20 * std::acos(-1.0) / 180), 0.01);
  EXPECT_NEAR((held - Vector<3>(5, 5, 1)).norm(), 2, 1e-6);  // it has fallen until it touches
  EXPECT_NEAR(rolled_off[2], 1, 1e-6);
  EXPECT_NEAR(free[2], 1, 1e-6);
}

}  // namespace roller_test
}  // namespace bernal

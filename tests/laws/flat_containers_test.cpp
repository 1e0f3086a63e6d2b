// What every container of two dimensions must keep. A new one joins in tests/support/polygons.hpp.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bernal/core/random.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/container.hpp"
#include "domain/places.hpp"
#include "support/polygons.hpp"
#include "work/room.hpp"

namespace bernal {
namespace flat_containers_test {

class FlatContainerLaws : public ::testing::TestWithParam<std::pair<std::string, Domain>> {
 protected:
  FlatContainerLaws() : frame(frame_of(GetParam().second)), shape(to_local(GetParam().second, frame)) {
    container = make_analytic_container(shape, WallArithmetic::filtered, frame.resolution);
    const Bounds<3> in_space = bounds_of(shape);
    bounds = {in_space.lower.head<2>(), in_space.upper.head<2>()};
  }

  double rounding() const { return 8 * std::max(frame.resolution, 4.5e-16); }
  double precise(const Vector<3>& p) const {
    return static_cast<double>(test::precise_clearance_flat(shape, p.head<2>()));
  }
  Vector<3> random_point(double enlarged = 1) {
    const Vector<2> half = 0.5 * enlarged * bounds.size();
    const Vector<2> p = uniform_point<2>(random, {bounds.center() - half, bounds.center() + half});
    return {p[0], p[1], 0};
  }
  Vector<3> random_direction() {
    const Vector<2> u = uniform_direction<2>(random);
    return {u[0], u[1], 0};
  }
  double random_radius() {
    if (roomiest_ == 0)
      for (int i = 0; i < 3000; ++i) roomiest_ = std::max(roomiest_, container->clearance(random_point()));
    return std::pow(10, random.uniform(-3, -0.1)) * roomiest_;
  }
  double skin(double r) const { return tolerance::skin(r, frame.resolution); }

  Frame frame;
  Domain shape;
  std::unique_ptr<Container> container;
  Bounds<2> bounds;
  Random random{1, stream(Stream::test)};

 private:
  double roomiest_ = 0;
};

TEST_P(FlatContainerLaws, ClearanceIsTheSignedDistance) {
  EXPECT_EQ(container->dimension(), 2);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> p = random_point(1.5);
    const double clearance = container->clearance(p);
    ASSERT_NEAR(clearance, precise(p), rounding()) << p.transpose();
    const double reach = random.uniform(-0.1, 0.3);
    ASSERT_EQ(container->clearance_within(p, reach), std::min(clearance, reach));
    inside += clearance > 0;
  }
  EXPECT_GT(inside, 200);
  EXPECT_LT(inside, 1800);
}

TEST_P(FlatContainerLaws, ClearanceIsOneLipschitz) {
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> p = random_point(1.5), q = p + std::pow(10, random.uniform(-6, 0)) * random_direction();
    EXPECT_LE(std::abs(container->clearance(p) - container->clearance(q)), (p - q).norm() + 2 * rounding());
  }
}

TEST_P(FlatContainerLaws, AreaByMonteCarlo) {
  constexpr int trials = 20'000;
  int inside = 0;
  for (int i = 0; i < trials; ++i) inside += container->clearance(random_point()) > 0;
  const double share = container->volume() / bounds.size().prod();
  EXPECT_NEAR(inside, trials * share, 1 + 5 * std::sqrt(trials * share * (1 - share)));
  EXPECT_NEAR(container->volume() * frame.scale * frame.scale, volume_of(GetParam().second),
              1e-9 * volume_of(GetParam().second));
}

/// By small steps and bisection: the way until the clearance of the centre has fallen to r + skin.
TEST_P(FlatContainerLaws, FirstContactAgainstBisection) {
  int stopped = 0;
  for (int i = 0; i < 300; ++i) {
    const double r = random_radius(), s = skin(r);
    Vector<3> c = random_point();
    while (!(container->clearance(c) >= r + s)) c = random_point();
    const Vector<3> u = random_direction();
    const double limit = random.uniform(0, 2);
    const double way = container->first_contact(c, r, u, limit);
    ASSERT_GE(way, 0);
    ASSERT_LE(way, limit);
    const auto gap = [&](double t) { return precise(c + t * u) - r; };
    constexpr int steps = 400;
    for (int k = 0; k <= steps; ++k) ASSERT_GE(gap(way * k / steps), 0.5 * s - rounding()) << r;
    if (way == limit) continue;
    ++stopped;
    EXPECT_LE(gap(way), s + 0.02 * s + rounding()) << "stopped too early";
  }
  EXPECT_GT(stopped, 50);
}

TEST_P(FlatContainerLaws, ContainsIsTheSameInEveryArithmeticAndExact) {
  const auto exact = make_analytic_container(shape, WallArithmetic::exact, frame.resolution);
  const auto plain = make_analytic_container(shape, WallArithmetic::plain, frame.resolution);
  for (int i = 0; i < 300; ++i) {
    const Vector<3> c = random_point(1.2);
    const double precise_gap = precise(c);
    // Radii that the double cannot tell from the clearance, too.
    for (const double r : {0.5 * std::abs(precise_gap), std::abs(precise_gap) * (1 + 1e-15),
                           std::abs(precise_gap), 1.5 * std::abs(precise_gap)}) {
      const bool holds = exact->contains(c, r);
      EXPECT_EQ(container->contains(c, r), holds);
      if (std::abs(precise_gap - r) < rounding()) continue;
      EXPECT_EQ(holds, precise_gap >= r);
      EXPECT_EQ(plain->contains(c, r), holds);
    }
  }
}

/// To the last bit, by the definition: the ball is clear of every place on its way, and of none a little
/// farther on.
TEST_P(FlatContainerLaws, FreePathAtEveryLevelEndsAtTheContact) {
  const auto exact = make_analytic_container(shape, WallArithmetic::exact, frame.resolution);
  const auto plain = make_analytic_container(shape, WallArithmetic::plain, frame.resolution);
  int stopped = 0;
  for (int i = 0; i < 60; ++i) {
    const double r = random_radius();
    Vector<3> c = random_point();
    while (!container->contains(c, r)) c = random_point();
    const Vector<3> u = random_direction();
    const double limit = random.uniform(0, 2);
    const double way = exact->free_path(c, r, u, limit);
    ASSERT_GE(way, 0);
    ASSERT_LE(way, limit);
    constexpr int steps = 100;
    for (int k = 0; k <= steps; ++k) ASSERT_GE(precise(c + way * k / steps * u) - r, -rounding());
    // A few roundoffs of the lengths: domain/free_path.hpp.
    const double certified = container->free_path(c, r, u, limit);
    EXPECT_LE(certified, way);
    EXPECT_GE(certified, way - 16 * tolerance::roundoff * (bounds.size().norm() + r + way));
    EXPECT_EQ(certified == limit, way == limit);
    const double bound = 2 * plain->free_path_bound(c, r);
    EXPECT_GE(precise(c + plain->free_path(c, r, u, limit) * u) - r, -bound);
    if (way == limit) continue;
    ++stopped;
    EXPECT_NEAR(precise(c + way * u), r, rounding());
  }
  EXPECT_GT(stopped, 10);
}

TEST_P(FlatContainerLaws, FacetsAreThoseNearNearestFirst) {
  for (int i = 0; i < 200; ++i) {
    const Vector<3> c = random_point();
    if (!(container->clearance(c) > 0)) continue;
    std::vector<NearFacet> near;
    const double reach = random.uniform(0, 1.0);
    container->facets_near(c, reach, near);
    EXPECT_EQ(near.empty(), container->clearance(c) >= reach);
    for (std::size_t k = 0; k < near.size(); ++k) {
      EXPECT_LT(near[k].distance, reach);
      EXPECT_NEAR(distance(near[k].facet, c), near[k].distance, rounding());
      EXPECT_LE(near[k > 0 ? k - 1 : 0].distance, near[k].distance);
    }
    if (near.empty()) continue;
    EXPECT_NEAR(near.front().distance, container->clearance(c), rounding());
  }
}

TEST_P(FlatContainerLaws, PlacesLieInThePlaneAndEverywhere) {
  const Places places(*container);
  EXPECT_GE(places.volume(), container->volume() * (1 - 1e-12));
  EXPECT_LE(places.volume(), 1.3 * container->volume());
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> p = places.draw(random);
    EXPECT_EQ(p[2], 0);
    inside += container->clearance(p) > 0;
  }
  const double share = container->volume() / places.volume();
  EXPECT_NEAR(inside, 2000 * share, 1 + 5 * std::sqrt(2000 * share * (1 - share) + 1e-9));
}

TEST_P(FlatContainerLaws, NoPlaceIsRoomierThanTheRoomiest) {
  const LargestRoom room = largest_room(*container);
  EXPECT_EQ(room.place[2], 0);
  EXPECT_NEAR(container->clearance(room.place), room.radius, rounding());
  for (int i = 0; i < 5000; ++i) EXPECT_LE(container->clearance(random_point()), room.bound);
}

INSTANTIATE_TEST_SUITE_P(All, FlatContainerLaws, ::testing::ValuesIn(test::flat_domains()),
                         [](const auto& tested) { return tested.param.first; });

}  // namespace flat_containers_test
}  // namespace bernal

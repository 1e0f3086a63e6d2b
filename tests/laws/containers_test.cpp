// What every container must keep, whatever it is made of. A new one joins in tests/support/containers.hpp.
#include "support/containers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/tolerance.hpp"
#include "domain/wall_contacts.hpp"

namespace bernal {
namespace containers_test {

using test::ContainerUnderTest;
using test::precise_clearance;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double endless = 100;  // many times the size of a container

class ContainerLaws : public ::testing::TestWithParam<ContainerUnderTest> {
 protected:
  const ContainerUnderTest& under_test() const { return GetParam(); }

  /// "A few roundoffs of the largest coordinate"; the container stands within [-1, 1]³ and points within
  /// twice that.
  double rounding() const { return 8 * std::max(under_test().resolution, 4.5e-16); }

  double precise_gap(const Vector<3>& c, double r) const {
    return static_cast<double>(precise_clearance(under_test().shape, c) - r);
  }

  Vector<3> random_point(double enlarged = 1) {
    const Bounds<3> b = container->bounds();
    const Vector<3> half = 0.5 * enlarged * b.size();
    return uniform_point<3>(random, {b.center() - half, b.center() + half});
  }

  /// A sphere that lies inside with a gap of at least its skin.
  Vector<3> random_place(double r) {
    for (;;) {
      const Vector<3> c = random_point();
      if (container->clearance(c) >= r + skin(r)) return c;
    }
  }

  bool repeats(int axis) const { return container->boundary().repeats(axis); }

  double skin(double r) const { return tolerance::skin(r, under_test().resolution); }

  /// A radius from a thousandth to most of what fits at all.
  double random_radius() {
    if (roomiest_ == 0)
      for (int i = 0; i < 2000; ++i) roomiest_ = std::max(roomiest_, container->clearance(random_point()));
    return std::pow(10, random.uniform(-3, -0.1)) * roomiest_;
  }

  std::unique_ptr<Container> container = under_test().container();
  Random random{1, stream(Stream::test)};

 private:
  double roomiest_ = 0;
};

TEST_P(ContainerLaws, ClearanceIsTheSignedDistance) {
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> p = random_point(1.5);
    ASSERT_NEAR(container->clearance(p), precise_gap(p, 0), rounding()) << p.transpose();
    inside += container->clearance(p) > 0;
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, 1980);
}

TEST_P(ContainerLaws, ClearanceIsOneLipschitz) {
  for (int i = 0; i < 2000; ++i) {
    const Vector<3> p = random_point(1.5);
    const Vector<3> q = p + std::pow(10, random.uniform(-6, 0)) * uniform_direction<3>(random);
    ASSERT_LE(std::abs(container->clearance(p) - container->clearance(q)), (p - q).norm() + 2 * rounding());
  }
}

// What repeats itself does so with the period that the container says.
TEST_P(ContainerLaws, ImagesOfAPointHaveTheSameWall) {
  const Boundary<3>& boundary = container->boundary();
  EXPECT_EQ(boundary.repeats(), is_periodic(under_test().shape));
  for (int k = 0; k < 3; ++k) {
    if (!repeats(k)) continue;
    EXPECT_NEAR(boundary.edges[k], container->bounds().size()[k], rounding());
    EXPECT_NEAR(boundary.origin[k], container->bounds().lower[k], rounding());
  }
  for (int i = 0; i < 200; ++i) {
    const Vector<3> p = random_point(1.2);
    const double r = random_radius(), gap = precise_gap(p, r);
    for (const double periods : {-1.0, 2.0}) {
      const Vector<3> image = p + periods * boundary.edges;
      EXPECT_NEAR(container->clearance(image), container->clearance(p), 4 * rounding());
      if (std::abs(gap) > 8 * rounding()) {
        EXPECT_EQ(container->contains(image, r), container->contains(p, r));
      }
    }
  }
}

// The share of n points that fall inside has the standard error sqrt(f (1 - f) / n).
TEST_P(ContainerLaws, VolumeIsTheShareOfItsBounds) {
  constexpr int n = 20000;
  int inside = 0;
  for (int i = 0; i < n; ++i) inside += container->clearance(random_point()) >= 0;
  const double share = container->volume() / container->bounds().volume();
  EXPECT_NEAR(double(inside) / n, share, 4 * std::sqrt(share * (1 - share) / n) + 1e-12);
}

TEST_P(ContainerLaws, BoundsAreTheSmallest) {
  const Bounds<3> b = container->bounds();
  for (int i = 0; i < 500; ++i) {
    const Vector<3> p = random_point(1.5);
    if (container->clearance(p) < 0) continue;
    for (int k = 0; k < 3; ++k) {
      if (container->boundary().repeats(k)) continue;
      ASSERT_GE(p[k], b.lower[k]);
      ASSERT_LE(p[k], b.upper[k]);
    }
  }
  // From outside, a plane of the bounds sees the container at distance zero: walk towards it by its distance.
  for (int axis = 0; axis < 3; ++axis) {
    if (container->boundary().repeats(axis)) continue;
    for (const double side : {-1.0, 1.0}) {
      double nearest = infinity;
      Vector<3> far = b.center() + side * 1e6 * Vector<3>::Unit(axis);
      nearest = -container->clearance(far);
      const double plane = 1e6 - 0.5 * b.size()[axis];
      // A point at the distance L sees a wall across L by L + w²/2L, w at most the diagonal.
      EXPECT_NEAR(nearest, plane, b.diagonal() * b.diagonal() / 1e6 + 1e-9) << "axis " << axis;
    }
  }
}

// Sphere tracing: clearance is 1-Lipschitz, so moving by gap - skin never passes the first place where the
// gap is the skin. An oracle that asks for nothing but clearance.
TEST_P(ContainerLaws, FirstContactIsWhereSphereTracingStops) {
  int limited = 0;
  for (int i = 0; i < 1000; ++i) {
    const double r = random_radius();
    const Vector<3> c = random_place(r);
    Vector<3> u = uniform_direction<3>(random);
    double limit = std::pow(10, random.uniform(-2, 1));
    if (i % 4 == 0) {  // straight at the wall, over before or after the skin by next to nothing
      std::vector<WallPoint> walls;
      container->walls_near(c, infinity, walls);
      u = -walls.front().inward;
      limit = std::max(0.0, walls.front().clearance - r + random.uniform(-1.5, 1) * skin(r));
    }
    const double answer = container->first_contact(c, r, u, limit);
    ASSERT_GE(answer, 0);
    ASSERT_LE(answer, limit);

    const double tiny = skin(r) / 64;
    double t = 0;
    for (int step = 0; step < 10000; ++step) {
      const double ahead = precise_gap(c + t * u, r) - skin(r);
      if (ahead <= tiny || t >= limit) break;
      t += ahead;
    }
    t = std::min(t, limit);
    // Newton's method ends when the way left to the contact is below `tiny`.
    ASSERT_GE(answer, t - tiny - rounding()) << "stopped where nothing was";
    if (answer < limit) {
      ++limited;
      EXPECT_LE(precise_gap(c + answer * u, r), skin(r) + tiny + rounding());
    }
    for (int k = 1; k <= 32; ++k)
      ASSERT_GE(precise_gap(c + answer * k / 32 * u, r), skin(r) / 2 - rounding()) << "k = " << k;
  }
  EXPECT_GT(limited, 100);
}

TEST_P(ContainerLaws, ARestingSphereCanLeaveButNotPushIn) {
  int left = 0;
  for (int i = 0; i < 500; ++i) {
    const double r = random_radius();
    Vector<3> c = random_place(r);
    const Vector<3> u = uniform_direction<3>(random);
    const double way = container->first_contact(c, r, u, endless);
    if (way == endless) continue;  // along walls that do not end
    c += way * u;

    EXPECT_LE(container->first_contact(c, r, u, r), skin(r)) << "went on";

    // A direction away from every wall that the way could meet is free. It may be a chord of a round wall: of
    // the slope 0.1, in a sphere of radius R >= 1.25 r, it is longer than the limit.
    const double limit = 0.01 * r;
    std::vector<WallPoint> walls;
    container->walls_near(c, r + 2 * skin(r) + limit, walls);
    ASSERT_FALSE(walls.empty());
    const Vector<3> v = uniform_direction<3>(random);
    const auto leads_away = [&](const WallPoint& w) { return v.dot(w.inward) > 0.1; };
    if (!std::all_of(walls.begin(), walls.end(), leads_away)) continue;
    ++left;
    EXPECT_EQ(container->first_contact(c, r, v, limit), limit);
  }
  EXPECT_GT(left, 50);
}

TEST_P(ContainerLaws, ASlightlyPenetratingSphereIsPushedOutNeverThrough) {
  for (int i = 0; i < 500; ++i) {
    const double r = random_radius();
    Vector<3> c = random_place(r);
    const Vector<3> u = uniform_direction<3>(random);
    const double way = container->first_contact(c, r, u, endless);
    if (way == endless) continue;
    c += way * u;
    std::vector<WallPoint> walls;
    container->walls_near(c, r + 2 * skin(r), walls);
    const Vector<3> inward = walls.front().inward;
    c -= std::pow(10, random.uniform(-9, -3)) * r * inward;
    const double start = precise_gap(c, r);

    EXPECT_EQ(container->first_contact(c, r, -inward, r), 0) << "further into the wall";
    for (int k = 0; k < 4; ++k) {
      const Vector<3> v = uniform_direction<3>(random);
      const double answer = container->first_contact(c, r, v, endless);
      for (int step = 1; step <= 16; ++step)
        ASSERT_GE(precise_gap(c + answer * step / 16 * v, r), std::min(start, skin(r) / 2) - rounding());
    }
    if (walls.size() == 1) {
      const double out = container->first_contact(c, r, inward, 0.1 * r);
      EXPECT_GT(precise_gap(c + out * inward, r), start) << "not pushed out";
    }
  }
}

TEST_P(ContainerLaws, WallPointsAreOnTheWallNearestFirstAndEachOnce) {
  std::vector<WallPoint> walls;
  for (int i = 0; i < 1000; ++i) {
    const Vector<3> c = random_place(1e-3);
    const double reach = random.uniform(1, 3) * container->clearance(c);
    walls.clear();
    container->walls_near(c, reach, walls);
    ASSERT_FALSE(walls.empty());
    EXPECT_NEAR(walls.front().clearance, container->clearance(c), rounding());
    for (std::size_t k = 0; k < walls.size(); ++k) {
      const WallPoint& w = walls[k];
      EXPECT_LT(w.clearance, reach);
      EXPECT_NEAR((c - w.point).norm(), w.clearance, rounding());
      EXPECT_NEAR(precise_gap(w.point, 0), 0, rounding());
      EXPECT_NEAR(w.inward.norm(), 1, 1e-14);
      EXPECT_NEAR(w.inward.dot(c - w.point), w.clearance, rounding());
      if (k > 0) {
        EXPECT_LE(walls[k - 1].clearance, w.clearance);
      }
      for (std::size_t j = 0; j < k; ++j) EXPECT_GT((walls[j].point - w.point).norm(), 16 * rounding());
    }
  }
}

TEST_P(ContainerLaws, FacetsNearAreSortedAndComplete) {
  std::vector<NearFacet> all, near;
  for (int i = 0; i < 200; ++i) {
    const Vector<3> c = random_place(1e-3);
    all.clear(), near.clear();
    container->facets_near(c, infinity, all);
    const double reach = random.uniform(0, 1);
    near.push_back({-1, {}});  // what stands there already is left alone
    container->facets_near(c, reach, near);
    ASSERT_EQ(near.front().distance, -1);
    near.erase(near.begin());
    const auto is_near = [&](const NearFacet& f) { return f.distance < reach; };
    ASSERT_EQ(near.size(), static_cast<std::size_t>(std::count_if(all.begin(), all.end(), is_near)));
    for (std::size_t k = 0; k < near.size(); ++k) {
      EXPECT_EQ(near[k].facet.id, all[k].facet.id);
      EXPECT_EQ(near[k].distance, distance(near[k].facet, c));
      if (k > 0) {
        EXPECT_LE(near[k - 1].distance, near[k].distance);
      }
    }
  }
}

TEST_P(ContainerLaws, FewFacetsAreAllFacetsOrNone) {
  std::vector<NearFacet> all, few;
  for (int i = 0; i < 200; ++i) {
    const Vector<3> c = random_place(1e-3);
    const double reach = random.uniform(0, 1);
    all.clear(), few.clear();
    container->facets_near(c, reach, all);
    const std::size_t most = all.size() - std::min<std::size_t>(all.size(), i % 2);
    const bool are_few = container->few_facets_near(c, reach, most, few);
    EXPECT_EQ(are_few, all.size() <= most);
    if (are_few) {
      EXPECT_EQ(few.size(), all.size());
    }
  }
}

TEST_P(ContainerLaws, ContactsAreThoseFacetsForWhichNoNearerOneSpeaks) {
  std::vector<NearFacet> facets;
  std::vector<WallContact> contacts, all;
  std::size_t corners = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector<3> c = random_place(1e-3);
    const double clearance = container->clearance(c), r = random.uniform(0.9, 2.5) * clearance;
    facets.clear(), contacts.clear(), all.clear();
    container->facets_near(c, r, facets);
    for (const NearFacet& f : facets) {
      const Vector<3> offset = c - closest_point(f.facet, c);
      all.push_back({offset.normalized(), offset.norm()});
    }
    container->contacts(c, r, contacts);
    ASSERT_EQ(contacts.empty(), all.empty());
    if (all.empty()) continue;
    corners += contacts.size() > 1;
    EXPECT_NEAR(contacts.front().distance, clearance, 1e-9 * clearance + rounding());
    leave_distinct(all, r);
    ASSERT_EQ(contacts.size(), all.size());
    for (std::size_t k = 0; k < all.size(); ++k)
      EXPECT_LE((contacts[k].distance * contacts[k].normal - all[k].distance * all[k].normal).norm(),
                8 * rounding());
  }
  const std::string shape = under_test().name;
  if (shape.starts_with("Cube") || shape.starts_with("LShape")) {
    EXPECT_GT(corners, 50u);
  }
}

TEST_P(ContainerLaws, ContainsAgreesAtAllLevelsAwayFromTies) {
  const auto plain = under_test().container(WallArithmetic::plain);
  const auto exact = under_test().container(WallArithmetic::exact);
  for (int i = 0; i < 300; ++i) {
    const Vector<3> c = random_point(1.2);
    const double r = random_radius();
    const double gap = precise_gap(c, r);
    if (std::abs(gap) < 2 * rounding()) continue;
    EXPECT_EQ(plain->contains(c, r), gap > 0);
    EXPECT_EQ(container->contains(c, r), gap > 0);
    EXPECT_EQ(exact->contains(c, r), gap > 0);
  }
}

// Radii around the clearance, one unit in the last place apart: often the tie is among them.
TEST_P(ContainerLaws, FilteredIsExactAtTies) {
  const auto exact = under_test().container(WallArithmetic::exact);
  int changes = 0;
  for (int i = 0; i < 100; ++i) {
    const Vector<3> c = random_place(1e-3);
    const double clearance = container->clearance(c);
    EXPECT_TRUE(exact->contains(c, clearance - 2 * rounding()));
    EXPECT_FALSE(exact->contains(c, clearance + 2 * rounding()));

    double r = clearance;
    for (int k = 0; k < 8; ++k) r = std::nextafter(r, 0);
    bool last = true;
    for (int k = 0; k < 16; ++k, r = std::nextafter(r, infinity)) {
      const bool inside = exact->contains(c, r);
      EXPECT_EQ(container->contains(c, r), inside);
      EXPECT_TRUE(last || !inside) << "a larger sphere cannot fit where a smaller one does not";
      changes += last && !inside;
      last = inside;
    }
  }
  EXPECT_GT(changes, 50);
}

// What repeats itself answers the same in every period, and its period is the domain's without rounding.
TEST_P(ContainerLaws, EveryPeriodIsLikeTheFirst) {
  const Boundary<3>& boundary = container->boundary();
  EXPECT_EQ(boundary.edges, boundary_of<3>(under_test().shape).edges);
  EXPECT_EQ(boundary.repeats(), is_periodic(under_test().shape));
  for (int i = 0; i < 500 && boundary.repeats(); ++i) {
    const Vector<3> p = random_point(1.5);
    Vector<3> q = p;
    for (int k = 0; k < 3; ++k) q[k] += std::floor(random.uniform(-9, 9)) * boundary.edges[k];
    ASSERT_NEAR(container->clearance(q), container->clearance(p), rounding());
    const Vector<3> wrapped = boundary.wrap(q);
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      ASSERT_GE(wrapped[k], container->bounds().lower[k] - rounding());
      ASSERT_LE(wrapped[k], container->bounds().upper[k] + rounding());
      ASSERT_NEAR(std::remainder(wrapped[k] - p[k], boundary.edges[k]), 0, 32 * rounding());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, ContainerLaws, ::testing::ValuesIn(test::containers_under_test()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace containers_test
}  // namespace bernal

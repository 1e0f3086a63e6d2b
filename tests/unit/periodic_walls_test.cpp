// Measurements where walls and periods come together: boxes that end on some axes, and cylinders that repeat
// themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/measure/measure.hpp"

namespace bernal {
namespace periodic_walls_test {

using std::numbers::pi;

struct Measured {
  std::string name;
  Domain domain;
};

std::vector<Measured> domains() {
  return {{"CylinderAlongZ", Cylinder{{1, -2, 3}, {0, 0, 1}, 3, 5, true}},
          {"CylinderAgainstXFarAway", Cylinder{{3e4, 1e4, -2e4}, {-2, 0, 0}, 2.5, 4, true}},
          {"BetweenTwoWalls", Box{{0, 0, 0}, {5, 6, 4.5}, {true, true, false}}},
          {"BetweenFourWalls", Box{{-1, 2, 100}, {5, 6, 4.5}, {false, true, false}}}};
}

int periodic_axis(const Domain& domain) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  return boundary.repeats(0) ? 0 : boundary.repeats(1) ? 1 : 2;
}

/// The domain with `turns` periods for one along an axis, and the images in them.
Domain longer(Domain domain, int axis, int turns) {
  if (auto* box = std::get_if<Box>(&domain)) box->size[axis] *= turns;
  if (auto* cylinder = std::get_if<Cylinder>(&domain)) cylinder->height *= turns;
  return domain;
}
Spheres<3> repeated(const Spheres<3>& spheres, const Domain& domain, int axis, int turns) {
  Spheres<3> all;
  // A cylinder that points backwards grows backwards.
  const double step = bounds_of(longer(domain, axis, 2)).lower[axis] < bounds_of(domain).lower[axis] ? -1 : 1;
  for (int turn = 0; turn < turns; ++turn)
    for (std::size_t i = 0; i < spheres.size(); ++i)
      all.push_back(
          spheres.center(i) + step * turn * boundary_of<3>(domain).edges[axis] * Vector<3>::Unit(axis),
          spheres.r[i]);
  return all;
}

/// By the plainest definition: the smallest distance from any wall.
double depth(const Domain& domain, const Vector<3>& p) {
  if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> w = p - cylinder->base, a = cylinder->axis.normalized();
    return cylinder->radius - (w - w.dot(a) * a).norm();
  }
  const Box& box = std::get<Box>(domain);
  double least = 1e300;
  for (int k = 0; k < 3; ++k)
    if (!box.periodic[static_cast<std::size_t>(k)])
      least = std::min({least, p[k] - box.corner[k], box.corner[k] + box.size[k] - p[k]});
  return least;
}

/// Spheres that do not overlap, grown until they touch something: another one, an image or a wall.
Spheres<3> touching(const Domain& domain, std::size_t n, double r_max, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  const Boundary<3> boundary = boundary_of<3>(domain);
  Spheres<3> spheres;
  for (int failures = 0; spheres.size() < n && failures < 2000; ++failures) {
    const Vector<3> c = uniform_point(random, bounds_of(domain));
    double room = std::min(r_max, depth(domain, c));
    for (std::size_t i = 0; i < spheres.size(); ++i)
      room = std::min(room, boundary.minimum_image(spheres.center(i) - c).norm() - spheres.r[i]);
    if (room < 0.2 * r_max) continue;
    spheres.push_back(c, room);
    failures = 0;
  }
  return spheres;
}

class BetweenWalls : public ::testing::TestWithParam<Measured> {
 protected:
  const Domain& domain() const { return GetParam().domain; }
  Spheres<3> spheres(double r_max = 0.7) const { return touching(domain(), 80, r_max, 3); }
};

INSTANTIATE_TEST_SUITE_P(All, BetweenWalls, ::testing::ValuesIn(domains()),
                         [](const auto& test) { return test.param.name; });

TEST_P(BetweenWalls, ContactsAgreeWithBruteForceOverAllImages) {
  const Spheres<3> s = spheres();
  const Vector<3> periods = boundary_of<3>(domain()).edges;
  const std::vector<double> gaps = {1e-6, 0.1, 0.5};
  const std::vector<Contacts> contacts = measure_contacts(s, domain(), gaps);
  for (std::size_t g = 0; g < gaps.size(); ++g) {
    std::uint64_t pairs = 0, walls = 0;
    for (std::size_t i = 0; i < s.size(); ++i) {
      for (std::size_t j = 0; j < s.size(); ++j)
        for (int image = 0; image < 125; ++image) {
          const Vector<3> turns(image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2);
          const Vector<3> shift = turns.cwiseProduct(periods);
          if ((turns.array() != 0 && periods.array() == 0).any() || (i == j && turns.isZero(0))) continue;
          pairs += (s.center(i) - s.center(j) + shift).norm() < (1 + gaps[g]) * (s.r[i] + s.r[j]);
        }
      const double reach = (1 + gaps[g]) * s.r[i];
      if (std::holds_alternative<Cylinder>(domain())) walls += depth(domain(), s.center(i)) < reach;
      if (const auto* box = std::get_if<Box>(&domain()))
        for (int k = 0; k < 3; ++k)
          if (periods[k] == 0) {
            walls += s.x[static_cast<std::size_t>(k)][i] - box->corner[k] < reach;
            walls += box->corner[k] + box->size[k] - s.x[static_cast<std::size_t>(k)][i] < reach;
          }
    }
    EXPECT_EQ(contacts[g].pairs, pairs / 2) << gaps[g];
    EXPECT_EQ(contacts[g].walls, walls) << gaps[g];
    EXPECT_GT(pairs, 20u);
    EXPECT_GT(walls, 5u);
    EXPECT_EQ(contacts[g].isostatic.has_value(), contacts[g].backbone > 0);
    if (contacts[g].isostatic) {
      EXPECT_EQ(*contacts[g].isostatic,
                3 * contacts[g].backbone + 1 - static_cast<std::uint64_t>(symmetries_of(domain())));
    }
  }
}

/// Where two periods, or three, stand for one, nothing changes but the number of spheres.
TEST_P(BetweenWalls, SeveralPeriodsAreLikeOne) {
  const Spheres<3> s = spheres();
  const int axis = periodic_axis(domain());
  const Measurements one = measure(s, domain());
  for (const int turns : {2, 3}) {
    const Spheres<3> all = repeated(s, domain(), axis, turns);
    const auto n = static_cast<std::uint64_t>(turns);
    const Measurements many = measure(all, longer(domain(), axis, turns));
    EXPECT_NEAR(many.packing_fraction, one.packing_fraction, 1e-12);
    EXPECT_EQ(many.contacts.pairs, n * one.contacts.pairs);
    EXPECT_EQ(many.contacts.walls, n * one.contacts.walls);
    EXPECT_EQ(many.contacts.rattlers, n * one.contacts.rattlers);
    ASSERT_TRUE(one.order && many.order);
    EXPECT_EQ(many.order->all.crystalline, n * one.order->all.crystalline);
    EXPECT_EQ(many.order->near_wall->spheres, n * one.order->near_wall->spheres);
    EXPECT_EQ(many.order->core->spheres, n * one.order->core->spheres);
    ASSERT_TRUE(one.walls && many.walls);
    ASSERT_EQ(many.walls->layers.size(), one.walls->layers.size());
    for (std::size_t k = 0; k < one.walls->layers.size(); ++k) {
      const WallProfile::Layer &a = one.walls->layers[k], &b = many.walls->layers[k];
      EXPECT_NEAR(b.from, a.from, 1e-9);
      EXPECT_NEAR(b.share, a.share, 1e-9);
      EXPECT_NEAR(b.porosity, a.porosity, 5 * std::hypot(a.error, b.error) + 1e-9) << a.from;
    }
    // As many centres around each, where both reach; each is held against those of its own box.
    ASSERT_TRUE(one.radial && many.radial);
    const double per_one = static_cast<double>(s.size()) - 1;
    const double per_many = (static_cast<double>(all.size()) - 1) / turns;
    for (std::size_t k = 0; k < std::min(one.radial->g.size(), many.radial->g.size()); ++k)
      EXPECT_NEAR(many.radial->g[k] * per_many, one.radial->g[k] * per_one,
                  5 * std::hypot(many.radial->error[k] * per_many, one.radial->error[k] * per_one))
          << one.radial->r[k];
    ASSERT_TRUE(one.chambers && many.chambers);
    EXPECT_EQ(many.chambers->chambers.size(), 1u);
    EXPECT_EQ(many.chambers->misplaced, 0u);
    EXPECT_NEAR(many.chambers->by_smallest.share, one.chambers->by_smallest.share,
                5 * std::hypot(one.chambers->by_smallest.error, many.chambers->by_smallest.error) + 1e-3);
  }
}

/// Points of one period, those that some image of a sphere holds: layer by layer.
TEST_P(BetweenWalls, TheProfileAgreesWithDenseSampling) {
  const Spheres<3> s = spheres();
  const WallProfile profile = wall_profile(s, domain(), {.work = 1e6}).value();
  const Boundary<3> boundary = boundary_of<3>(domain());
  Random random(11, stream(Stream::test));
  std::vector<double> points(profile.layers.size(), 0), solid(profile.layers.size(), 0);
  double inside = 0;
  for (int n = 0; n < 60'000; ++n) {
    const Vector<3> p = uniform_point(random, bounds_of(domain()));
    const double z = depth(domain(), p);
    if (z < 0) continue;
    ++inside;
    std::size_t k = 0;
    while (k + 1 < points.size() && z >= profile.layers[k].to) ++k;
    ++points[k];
    for (std::size_t i = 0; i < s.size(); ++i)
      if (boundary.minimum_image(s.center(i) - p).norm() < s.r[i]) {
        ++solid[k];
        break;
      }
  }
  EXPECT_GT(points.size(), 10u);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& layer = profile.layers[k];
    const double share = points[k] / inside, found = solid[k] / points[k];
    EXPECT_NEAR(layer.share, share, 5 * std::sqrt(share / inside)) << layer.from;
    EXPECT_NEAR(1 - layer.porosity, found,
                5 * std::hypot(layer.error, std::sqrt(found * (1 - found) / points[k])) + 1e-3)
        << layer.from;
  }
}

TEST_P(BetweenWalls, ImagesOfCentresAreAsGoodAsCentres) {
  const Spheres<3> s = spheres();
  Spheres<dynamic> moved = s;
  const Boundary<3> boundary = boundary_of<3>(domain());
  for (std::size_t i = 0; i < s.size(); ++i)
    moved.set_center(i, s.center(i) + (static_cast<double>(i % 5) - 2) * boundary.edges);
  const Measurements here = measure(s, domain()), there = measure(moved, domain());
  EXPECT_EQ(there.contacts.pairs, here.contacts.pairs);
  EXPECT_EQ(there.contacts.walls, here.contacts.walls);
  EXPECT_EQ(there.walls->regions, here.walls->regions);
  EXPECT_EQ(there.chambers->misplaced, 0u);

  wrap(moved, domain());
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_LT((moved.center(i) - boundary.wrap(s.center(i))).norm(), 1e-10);
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      EXPECT_GE(moved.center(i)[k], boundary.origin[k]);
      EXPECT_LT(moved.center(i)[k], boundary.origin[k] + boundary.edges[k]);
    }
  }
}

TEST(PeriodicCylinderProfile, LooksAtTheSideOnly) {
  // A sphere on the axis that touches its own image: its slice at the distance ρ from the axis is a tube of
  // the height 2 sqrt(r² - ρ²).
  const double R = 3, r = 1;
  const Cylinder column{{0, 0, 0}, {0, 0, 1}, R, 2 * r, true};
  Spheres<3> spheres;
  spheres.push_back({0, 0, 0.3}, r);
  const WallProfile profile = wall_profile(spheres, column).value();
  EXPECT_DOUBLE_EQ(profile.layers.back().to, R);
  const auto within = [&](double rho) {  // volume of the sphere nearer to the axis than rho
    return 4 * pi / 3 * (std::pow(r, 3) - std::pow(r * r - std::min(r, rho) * std::min(r, rho), 1.5));
  };
  for (const auto& layer : profile.layers) {
    const double outer = R - layer.from, inner = R - layer.to;
    EXPECT_NEAR(layer.share, (outer * outer - inner * inner) / (R * R), 1e-12);
    const double solid = (within(outer) - within(inner)) / (layer.share * volume_of(column));
    EXPECT_NEAR(1 - layer.porosity, solid, 5 * layer.error + 1e-9) << layer.from;
  }
}

/// Between two plates the simple cubic lattice has six neighbours inside and five and a wall outside.
TEST(SlabContacts, OfALatticeBetweenTwoPlates) {
  Spheres<3> spheres;
  for (int i = 0; i < 27; ++i) spheres.push_back(Vector<3>(i % 3 + 7, i / 3 % 3 - 5, i / 9 + 0.5), 0.5);
  const Contacts contacts = measure_contacts(spheres, Box{{7, -5, 0}, {3, 3, 3}, {true, true, false}}, 1e-9);
  EXPECT_EQ(contacts.pairs, 27u + 27u + 18u);
  EXPECT_EQ(contacts.walls, 18u);
  EXPECT_EQ(contacts.rattlers, 0u);
}

/// As many as the length of such an axis has periods of the others would take for ever.
TEST(SlabContacts, OfASphereBeyondAllBoundsAreThoseOfTheOthers) {
  for (const double far : {1e10, 1e19, 1e60}) {
    Spheres<3> spheres;
    for (const Vector<3>& c : {Vector<3>(2, 2, far), Vector<3>(4.9, 1.5, 1.3), Vector<3>(0.9, 1.5, 1.3)})
      spheres.push_back(c, 0.5);
    const Measurements measured = measure(spheres, Box{{0, 0, 0}, {5, 5, 5}, {true, true, false}});
    EXPECT_EQ(measured.contacts.pairs, 1u) << far;
    EXPECT_TRUE(measured.chambers && measured.walls && measured.order && measured.local && measured.pores)
        << far;
  }
}

TEST(SlabContacts, OfGapsThatAreNoneAreRefused) {
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(1, 1, 1), 0.5);
  const Box box{{0, 0, 0}, {3, 3, 3}, {true, true, false}};
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double gap : {std::nan(""), infinity, -infinity, 1e300, 1.5, -2.0})
    EXPECT_THROW(measure(spheres, box, {}, {.contact_gap = gap}), Error) << gap;
}

}  // namespace periodic_walls_test
}  // namespace bernal

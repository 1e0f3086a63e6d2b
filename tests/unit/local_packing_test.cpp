#include "bernal/measure/local_packing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/monitor.hpp"
#include "core/parallel.hpp"
#include "support/packings.hpp"
#include "support/periodic.hpp"

namespace bernal {
namespace local_packing_test {

using namespace testing;

LocalPacking local_of(const Spheres<dynamic>& spheres, const Domain& domain) {
  const std::optional<LocalPacking> local = local_packing(spheres, domain);
  EXPECT_TRUE(local);
  return local.value();
}
LocalPacking local_of(const Packing& packing) { return local_of(packing.spheres, packing.domain); }

Packing hexagonal_close(int n) {
  const double a = 1, b = std::sqrt(3.0), c = std::sqrt(8.0 / 3);
  return lattice<3>({{0, 0, 0}, {.5, .5, 0}, {.5, 5. / 6, .5}, {0, 1. / 3, .5}}, {a, b, c}, {n, n, n}, 0.5);
}

TEST(LocalPacking, OfLatticesIsThatOfTheirCells) {
  struct Case {
    const char* name;
    Packing packing;
    double fraction;
    std::uint32_t neighbours;
  };
  const double pi = std::numbers::pi, closest = pi / std::sqrt(18.0);
  std::vector<Case> cases;
  for (const int n : {1, 2, 5}) {
    cases.push_back({"simple cubic", simple_cubic(n), pi / 6, 6});
    cases.push_back({"body centred", body_centred(n), pi * std::sqrt(3.0) / 8, 14});
    cases.push_back({"face centred", face_centred(n), closest, 12});
    cases.push_back({"hexagonal close", hexagonal_close(n), closest, 12});
    cases.push_back({"hexagonal discs", hexagonal_discs(n), pi / std::sqrt(12.0), 6});
  }
  for (const auto& [name, packing, fraction, neighbours] : cases) {
    const LocalPacking local = local_of(packing);
    const std::size_t n = packing.spheres.size();
    ASSERT_EQ(local.packing_fraction.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(local.packing_fraction[i], fraction, 1e-12) << name << " " << n;
      EXPECT_EQ(local.neighbours[i], neighbours) << name << " " << n;
    }
    EXPECT_LT(local.volume_error, 1e-12) << name << " " << n;
    EXPECT_NEAR(local.mean, fraction, 1e-12);
    EXPECT_LT(local.deviation, 1e-7);
    EXPECT_EQ(local.empty, 0u);
  }
}

/// Volumes by the definition: random points, each of which belongs to the sphere of the least power.
std::vector<double> by_points(const Spheres<dynamic>& spheres, const Box& box, std::size_t points) {
  const auto nearest_image = [&](Vector<dynamic> d) {
    for (int k = 0; k < d.size(); ++k)
      if (box.repeats(k)) d[k] -= box.size[k] * std::nearbyint(d[k] / box.size[k]);
    return d;
  };
  std::vector<double> volume(spheres.size(), 0);
  Random random(17, stream(Stream::test));
  for (std::size_t k = 0; k < points; ++k) {
    Vector<dynamic> p = box.corner;
    for (int axis = 0; axis < p.size(); ++axis) p[axis] += random.uniform(0, box.size[axis]);
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double power = nearest_image(p - spheres.center(i)).squaredNorm() - spheres.r[i] * spheres.r[i];
      if (power < least) {
        least = power;
        nearest = i;
      }
    }
    volume[nearest] += box.size.prod() / static_cast<double>(points);
  }
  return volume;
}

Spheres<dynamic> gas(std::size_t n, double least, double most, const Box& box, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<dynamic> spheres(box.dimension());
  for (std::size_t i = 0; i < n; ++i) {
    Vector<dynamic> c = box.corner;
    for (int k = 0; k < c.size(); ++k) c[k] += random.uniform(0, box.size[k]);
    spheres.push_back(c, least * std::pow(most / least, random.uniform()));
  }
  return spheres;
}

TEST(LocalPacking, OfSpheresOfAnySizeIsThatOfTheNearestPower) {
  constexpr std::size_t points = 100'000;
  const std::vector<bool> all = {true, true, true}, some = {true, false, true}, none = {false, false, false};
  struct Case {
    const char* name;
    Box box;
    double least, most;
  };
  const Case cases[] = {
      {"periodic, equal", {{0, 0, 0}, {1, 1, 1}, all}, 0.1, 0.1},
      {"periodic, wide, with hidden ones", {{0, 0, 0}, {1, 1, 1}, all}, 0.01, 0.4},
      {"periodic, thin", {{0, 0, 0}, {0.1, 2, 0.3}, all}, 0.02, 0.1},
      {"walls on one axis", {{-3, 2, 7}, {1, 0.5, 2}, some}, 0.01, 0.1},
      {"walls", {{-3, 2, 7}, {1, 0.5, 2}, none}, 0.01, 0.2},
      {"discs", {{0, 1}, {2, 1}, {true, true}}, 0.01, 0.2},
      {"discs between walls", {{0, 1}, {2, 1}, {true, false}}, 0.01, 0.2},
  };
  for (const auto& [name, box, least, most] : cases) {
    const Spheres<dynamic> spheres = gas(60, least, most, box, 3);
    const LocalPacking local = local_of(spheres, box);
    const std::vector<double> expected = by_points(spheres, box, points);
    EXPECT_LT(local.volume_error, 1e-12) << name;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const double share = std::max(local.cell_volume[i] / local.volume, 10.0 / points);
      EXPECT_NEAR(local.cell_volume[i] / local.volume, expected[i] / local.volume,
                  5 * std::sqrt(share / points))
          << name << " " << i;
      const double ball = local.cell_volume[i] > 0 ? ball_volume(spheres.dimension(), spheres.r[i]) : 0;
      EXPECT_NEAR(local.packing_fraction[i] * local.cell_volume[i], ball, 1e-12);
    }
  }
}

TEST(LocalPacking, CellsFillPeriodicBoxesOfManySpheres) {
  // Several blocks, sizes over two decades, a void that only the largest cells reach into.
  Box box{{0, 0, 0}, {1, 1.5, 1}, {true, true, true}};
  Spheres<dynamic> spheres(3);
  const Spheres<dynamic> all = gas(40'000, 0.0005, 0.05, box, 5);
  for (std::size_t i = 0; i < all.size(); ++i)
    if ((all.center(i) - Vector<3>(.5, .5, .5)).norm() > 0.45) spheres.push_back(all.center(i), all.r[i]);
  ASSERT_GT(spheres.size(), 20'000u);
  for (const bool walls : {false, true}) {
    if (walls) box.periodic = {true, false, false};
    const LocalPacking local = local_of(spheres, box);
    EXPECT_LT(local.volume_error, 1e-11);
    EXPECT_GT(local.empty, 100u);
  }
}

TEST(LocalPacking, DoesNotDependOnPlaceUnitAndOrder) {
  const Box box{{0, 0, 0}, {1, 1, 1}, {true, true, false}};
  const Spheres<dynamic> spheres = gas(300, 0.01, 0.1, box, 7);
  const LocalPacking here = local_of(spheres, box);
  for (const double scale : {1e-9, 1.0, 1e7}) {
    const Vector<3> shift = scale * Vector<3>(1e4, -3e4, 2e4);
    Spheres<dynamic> moved(3);
    for (std::size_t i = spheres.size(); i-- > 0;) {
      Vector<3> c = spheres.center(i);
      c[0] += static_cast<double>(i % 3) - 1;  // another image
      moved.push_back(scale * c + shift, scale * spheres.r[i]);
    }
    const Box there_box{shift, scale * box.size, box.periodic};
    const LocalPacking there = local_of(moved, there_box);
    EXPECT_LT(there.volume_error, 1e-9);
    for (std::size_t i = 0; i < spheres.size(); ++i)
      EXPECT_NEAR(there.packing_fraction[spheres.size() - 1 - i], here.packing_fraction[i],
                  1e-7 * (1e-3 + here.packing_fraction[i]))
          << scale << " " << i;
  }
}

TEST(LocalPacking, OfFewSpheresAndOfThoseInALineOrAPlane) {
  const Box walls{{0, 0, 0}, {4, 4, 4}}, periodic{{0, 0, 0}, {4, 4, 4}, {true, true, true}};
  const std::vector<std::vector<Vector<3>>> cases = {
      {{1, 2, 3}},
      {{1, 2, 3}, {2, 1, 1}},
      {{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}, {3, 3, 3}},
      {{1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {3, 3, 1}},
      {{2, 0.5, 2}, {2, 1.5, 2}, {2, 2.5, 2}, {2, 3.5, 2}},
  };
  for (const Box& box : {walls, periodic}) {
    for (const auto& centers : cases) {
      Spheres<dynamic> spheres(3);
      for (const Vector<3>& c : centers) spheres.push_back(c, 0.4);
      const LocalPacking local = local_of(spheres, box);
      EXPECT_LT(local.volume_error, 1e-13) << centers.size();
      EXPECT_EQ(local.empty, 0u);
    }
  }
  Spheres<dynamic> row(3);
  for (const Vector<3>& c : cases.back()) row.push_back(c, 0.4);
  for (const double volume : local_of(row, walls).cell_volume) EXPECT_NEAR(volume, 16, 1e-12);
  EXPECT_EQ(local_of(row, walls).neighbours, (std::vector<std::uint32_t>{1, 2, 2, 1}));
  // Each meets itself across four sides, and two others.
  EXPECT_EQ(local_of(row, periodic).neighbours, (std::vector<std::uint32_t>{6, 6, 6, 6}));
  EXPECT_FALSE(local_packing(Spheres<dynamic>(3), walls));
  EXPECT_FALSE(local_packing(row, walls, {.most_spheres = 3}));
}

TEST(LocalPacking, SpheresInsideOfOthersHaveNoCell) {
  const Box box{{0, 0, 0}, {4, 4, 4}, {true, true, true}};
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(1, 1, 1), 1);
  spheres.push_back(Vector<3>(1.1, 1, 1), 0.3);  // inside of the first
  spheres.push_back(Vector<3>(5, 1, -3), 1);     // the first again
  spheres.push_back(Vector<3>(1, 1, 1), 0.5);
  const LocalPacking local = local_of(spheres, box);
  EXPECT_EQ(local.empty, 3u);
  EXPECT_NEAR(local.cell_volume[0], 64, 1e-12);
  EXPECT_EQ(local.packing_fraction[1], 0);
  EXPECT_EQ(local.mean, local.packing_fraction[0]);
}

TEST(LocalPacking, TwoSpheresInABallShareItAsThePlaneBetweenThemSays) {
  // The plane of equal power is x = (25 + 1 - 4) / 10 - 2 = 0.2 for centres at -2 and 3, radii 1 and 2.
  const double R = 6, x = 0.2;
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(-2, 0, 0), 1);
  spheres.push_back(Vector<3>(3, 0, 0), 2);
  const double right = std::numbers::pi * (R - x) * (R - x) * (2 * R + x) / 3;
  const LocalPacking local = local_of(spheres, Sphere{{0, 0, 0}, R});
  EXPECT_NEAR(local.cell_volume[1] / right, 1, 1e-13);
  EXPECT_LT(local.volume_error, 1e-13);
}

/// A wall to be cut along, and what is inside of it.
struct RoundWall {
  const char* name;
  Domain domain;
  std::function<bool(const Vector<3>&)> inside;
};

std::vector<RoundWall> round_walls() {
  const auto within = [](const Cylinder& s) {
    return [s](const Vector<3>& p) {
      const Vector<3> axis = s.axis.normalized(), w = p - s.base;
      const double height = w.dot(axis);
      return height >= 0 && height <= s.height && (w - height * axis).norm() <= s.radius;
    };
  };
  const Cylinder upright{{0.1, 0.2, -0.3}, {0, 0, 1}, 0.7, 1.3}, flat{{0, 0, 0}, {0, 2, 0}, 1, 0.2},
      oblique{{1, 2, 3}, {1, -2, 0.5}, 0.3, 1.3}, column{{0, 0, 1}, {0, 0, 1}, 0.5, 2, true};
  const Sphere ball{{0.3, -0.1, 5}, 0.8};
  return {{"upright", upright, within(upright)},
          {"flat", flat, within(flat)},
          {"oblique", oblique, within(oblique)},
          {"periodic", column, within(column)},
          {"sphere", ball, [ball](const Vector<3>& p) { return (p - ball.center).norm() <= ball.radius; }}};
}

/// Of random points in the bounds those inside; every one belongs to the sphere of the least power.
std::vector<double> by_points(const Spheres<dynamic>& spheres, const RoundWall& wall, std::size_t points) {
  const Bounds<3> bounds = bounds_of(wall.domain);
  const Boundary<3> boundary = boundary_of<3>(wall.domain);
  std::vector<double> volume(spheres.size(), 0);
  Random random(19, stream(Stream::test));
  for (std::size_t k = 0; k < points; ++k) {
    const Vector<3> p = uniform_point<3>(random, bounds);
    if (!wall.inside(p)) continue;
    const auto power = [&](std::size_t i) {
      return boundary.minimum_image(p - Vector<3>(spheres.center(i))).squaredNorm() -
             spheres.r[i] * spheres.r[i];
    };
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < spheres.size(); ++i)
      if (power(i) < power(nearest)) nearest = i;
    volume[nearest] += bounds.volume() / static_cast<double>(points);
  }
  return volume;
}

TEST(LocalPacking, CellsBetweenRoundWallsAreThoseOfTheNearestPowerAndFillThem) {
  constexpr std::size_t points = 40'000;
  for (const RoundWall& wall : round_walls()) {
    const Bounds<3> bounds = bounds_of(wall.domain);
    for (const std::size_t n : {1, 2, 30, 500}) {
      const Box around{bounds.lower, bounds.size()};
      const Spheres<dynamic> spheres = gas(n, 0.01, 0.2, around, n);  // some of them outside
      const LocalPacking local = local_of(spheres, wall.domain);
      EXPECT_LT(local.volume_error, 1e-12) << wall.name << " " << n;
      if (n > 30) continue;
      const std::vector<double> expected = by_points(spheres, wall, points);
      const double all = bounds.volume();
      for (std::size_t i = 0; i < n; ++i) {
        const double share = std::max(local.cell_volume[i] / all, 10.0 / points);
        EXPECT_NEAR(local.cell_volume[i] / all, expected[i] / all, 5 * std::sqrt(share / points))
            << wall.name << " " << n << " " << i;
      }
    }
  }
}

TEST(LocalPacking, OfFewSpheresInVeryLongAndVeryFlatContainersTakesNoLonger) {
  for (const double length : {1e4, 1e6, 1e9})
    for (const bool oblique : {false, true})
      for (const bool flat : {false, true}) {
        const Vector<3> axis = oblique ? Vector<3>(1, 2, -0.5) : Vector<3>(0, 0, 1);
        const Cylinder shape{{0, 0, 0}, axis, flat ? length : 1.5, flat ? 1.5 : length};
        Spheres<dynamic> spheres(3);
        for (const double at : {0.1, 0.7}) spheres.push_back(at * shape.height * axis.normalized(), 0.5);
        const LocalPacking local = local_of(spheres, shape);
        // Coordinates of a millionth of a millionth of the length have few digits left across the axis.
        EXPECT_LT(local.volume_error, oblique ? 1e-14 * length : 1e-12) << length << oblique << flat;
        EXPECT_NEAR(local.cell_volume[0] / local.volume, 0.4, 1e-6) << length << oblique << flat;
      }
}

TEST(LocalPacking, OfASampleIsThatOfTheSameSpheres) {
  const Box box{{0, 0, 0}, {1, 1, 1}, {true, true, true}};
  const Spheres<dynamic> spheres = gas(2000, 0.01, 0.03, box, 23);
  const LocalPacking all = local_of(spheres, box);
  EXPECT_TRUE(all.ids.empty());
  const LocalPacking some = local_packing(spheres, box, {.all_of = 1999, .looked_at = 400}).value();
  ASSERT_EQ(some.ids.size(), 400u);
  ASSERT_EQ(some.cell_volume.size(), 400u);
  for (std::size_t k = 0; k < some.ids.size(); ++k) {
    EXPECT_EQ(some.cell_volume[k], all.cell_volume[some.ids[k]]);
    EXPECT_EQ(some.packing_fraction[k], all.packing_fraction[some.ids[k]]);
    EXPECT_EQ(some.neighbours[k], all.neighbours[some.ids[k]]);
  }
  EXPECT_TRUE(std::isnan(some.volume_error));
  EXPECT_NEAR(some.mean_error, all.deviation * std::sqrt(0.8 / 400), 0.1 * some.mean_error);
  EXPECT_NEAR(some.mean, all.mean, 4 * some.mean_error);
  EXPECT_EQ(all.mean_error, 0);
  EXPECT_NEAR(some.mean_neighbours, all.mean_neighbours, 1);
  EXPECT_TRUE(local_packing(spheres, box, {.all_of = 2000, .looked_at = 400})->ids.empty());
}

TEST(LocalPacking, OfAnInsetIsRefused) {
  const Polygon shape{{{{0, 0}, {4, 0}, {4, 1}, {0, 1}}}, 0.1};
  Spheres<dynamic> discs(2);
  discs.push_back(Vector<2>(1, 0.5), 0.2);
  EXPECT_THROW(local_packing(discs, shape), Error);
}

TEST(LocalPacking, OfDiscsInAPolygonAddsUpToItsArea) {
  // An L with a hole; between flat walls linear interpolation is exact but at the corners.
  const Polygon shape{
      {{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}, {{0.3, 0.3}, {0.3, 0.7}, {0.7, 0.7}, {0.7, 0.3}}}};
  Spheres<dynamic> discs(2);
  for (const Vector<2>& c : {Vector<2>(0.5, 2), Vector<2>(2, 0.5), Vector<2>(3.5, 0.4)})
    discs.push_back(c, 0.2);
  const LocalPacking local = local_of(discs, shape);
  EXPECT_NEAR(local.volume, 6 - 0.16, 1e-12);
  EXPECT_LT(local.volume_error, 3e-4);
}

TEST(LocalPacking, IsHeardToBeInterrupted) {
  const Box box{{0, 0, 0}, {1, 1, 1}, {true, true, true}};
  const Spheres<dynamic> spheres = gas(500, 0.01, 0.02, box, 1);
  const Monitor stop{{}, [] { return true; }};
  const Interruptible listening(stop);
  EXPECT_THROW(local_packing(spheres, box), Cancelled);
}

}  // namespace local_packing_test
}  // namespace bernal

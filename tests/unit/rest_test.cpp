#include "bernal/measure/rest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/run/run.hpp"
#include "bernal/settle/compress.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

// Which spheres rest and which hang, against cases by hand and against a walk of each in small steps past all
// others.
namespace bernal {
namespace rest_test {

const Vector<3> down(0, 0, -1);

Spheres<dynamic> spheres_at(const std::vector<Vector<3>>& centers, double r = 1) {
  Spheres<3> spheres;
  for (const Vector<3>& c : centers) spheres.push_back(c, r);
  return Spheres<dynamic>(std::move(spheres));
}

const Box box{Vector<3>::Zero(), Vector<3>(10, 10, 20)};

TEST(RestOfSpheres, OneAboveTheFloorByMoreThanAHundredthOfItsRadius) {
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1}}), box, down).hanging, 0u);
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1.009}}), box, down).hanging, 0u);
  const Rest high = measure_rest(spheres_at({{5, 5, 1.011}}), box, down);
  EXPECT_EQ(high.hanging, 1u);
  EXPECT_NEAR(high.farthest, 0.011, 1e-12);
  // The other way it hangs under the lid, and so it does from a wall.
  EXPECT_NEAR(measure_rest(spheres_at({{5, 5, 1}}), box, -down).farthest, 18, 1e-12);
  EXPECT_NEAR(measure_rest(spheres_at({{5, 5, 1}}), box, {3, 0, 0}).farthest, 4, 1e-12);
  EXPECT_EQ(measure_rest(Spheres<dynamic>(3), box, down).hanging, 0u);
}

TEST(RestOfSpheres, AreListedThoseFirstThatCouldFallTheFarthest) {
  // On the floor, six above it, beside the first, and three above the floor.
  const Spheres<dynamic> spheres = spheres_at({{2, 2, 1}, {7, 7, 7}, {3, 2, 1 + std::sqrt(3.0)}, {7, 2, 4}});
  EXPECT_TRUE(measure_rest(spheres, box, down).list.empty());
  const Rest rest = measure_rest(spheres, box, down, {.list = true});
  ASSERT_EQ(rest.list.size(), rest.unsettled);
  ASSERT_EQ(rest.unsettled, 3u);
  EXPECT_EQ(rest.list[0].sphere, 1u);
  EXPECT_NEAR(rest.list[0].fall, 6, 1e-12);
  EXPECT_EQ(rest.list[1].sphere, 3u);
  EXPECT_NEAR(rest.list[1].fall, 3, 1e-12);
  EXPECT_EQ(rest.list[2].sphere, 2u);
  EXPECT_EQ(rest.list[2].fall, 0);
  EXPECT_NEAR(rest.list[2].slope, 0.5, 1e-9);
}

TEST(RestOfSpheres, IsJudgedToATolerance) {
  // Half a thousandth above the floor, and three thousandths above another one.
  const Spheres<dynamic> spheres = spheres_at({{2, 2, 1.0005}, {7, 7, 1}, {7, 7, 3.003}});
  EXPECT_EQ(measure_rest(spheres, box, down).unsettled, 2u);
  EXPECT_EQ(measure_rest(spheres, box, down, {.tolerance = 1e-3}).unsettled, 1u);
  EXPECT_EQ(measure_rest(spheres, box, down, {.tolerance = 5e-3}).unsettled, 0u);
  // A way down that is as steep as that; and what hangs farther hangs.
  const double tilt = 2e-3;
  const Spheres<dynamic> aside = spheres_at({{5, 5, 1}, {5 + 2 * std::sin(tilt), 5, 1 + 2 * std::cos(tilt)}});
  EXPECT_EQ(measure_rest(aside, box, down, {.tolerance = 1e-3}).unsettled, 1u);
  EXPECT_EQ(measure_rest(aside, box, down, {.tolerance = 3e-3}).unsettled, 0u);
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1.02}}), box, down, {.tolerance = 5e-3}).hanging, 1u);
  // Less than what is always allowed is that.
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1 + 0.9e-6}}), box, down, {.tolerance = 0}).unsettled, 0u);
}

TEST(RestOfSpheres, WhatTouchesOnlyBesideSupportsNothing) {
  // Of three in a row the outer ones touch walls, and all of them hang; a rounding more or less is no
  // support.
  const Box narrow{Vector<3>::Zero(), Vector<3>(6, 10, 20)};
  for (const double rounding : {0.0, 1e-15, -1e-15}) {
    const Rest row =
        measure_rest(spheres_at({{1, 5, 10}, {3 + rounding, 5, 10}, {5, 5, 10 + rounding}}), narrow, down);
    EXPECT_EQ(row.hanging, 3u) << rounding;
    EXPECT_NEAR(row.farthest, 9, 1e-6) << rounding;
  }
  // One that stands a little lower does, however steep; and the lower one rests.
  const double low = 10 - 0.01, apart = std::sqrt(4 - 0.01 * 0.01);
  EXPECT_EQ(measure_rest(spheres_at({{3, 5, 10}, {3 + apart, 5, low}}), box, down).hanging, 1u);
}

TEST(RestOfSpheres, BetweenAWallAndASphereOnTheFloor) {
  const double height = std::sqrt(4 - 1.5 * 1.5);
  EXPECT_EQ(measure_rest(spheres_at({{2.5, 5, 1}, {1, 5, 1 + height}}), box, down).hanging, 0u);
  // Above nothing but the edge of another it falls past by a hair.
  EXPECT_EQ(measure_rest(spheres_at({{3.0, 5, 1}, {1 - 1e-9, 5, 5}}), box, down).hanging, 1u);
}

TEST(RestOfSpheres, InATubeThatIsAsWideAsItIs) {
  const Cylinder tube{.radius = 1, .height = 12};
  const Rest snug = measure_rest(spheres_at({{0, 0, 5}, {0, 0, 1}}), tube, down);
  EXPECT_EQ(snug.hanging, 1u);
  EXPECT_NEAR(snug.farthest, 2, 1e-6);
}

TEST(RestOfSpheres, WallsThatAreUprightButForTheRoundingOfAFileSupportNothing) {
  Mesh leaning = test::box_mesh(Vector<3>::Zero(), Vector<3>::Constant(10));
  for (Vector<3>& v : leaning.vertices)
    if (v[2] < 5) v[0] += v[0] < 5 ? 3e-6 : -3e-6;  // narrower below
  const Rest beside = measure_rest(spheres_at({{1 + 3e-6, 5, 5}, {9 - 3e-6, 1, 5}}), leaning, down);
  EXPECT_EQ(beside.hanging, 2u);
  EXPECT_GT(beside.farthest, 3.9);
  // A funnel does.
  Mesh funnel = test::box_mesh(Vector<3>::Zero(), Vector<3>::Constant(10));
  for (Vector<3>& v : funnel.vertices)
    if (v[2] < 5) v[0] += v[0] < 5 ? 1 : -1;
  EXPECT_EQ(measure_rest(spheres_at({{0.5 + std::sqrt(1.01), 5, 5}}), funnel, down).hanging, 0u);
}

TEST(RestOfSpheres, OnTheNextPeriod) {
  const Box slab{Vector<3>::Zero(), Vector<3>(8, 8, 20), {true, true, false}};
  const double height = std::sqrt(4 - 1.2 * 1.2);
  EXPECT_EQ(measure_rest(spheres_at({{7.5, 4, 1}, {0.7, 4, 1 + height}}), slab, down).hanging, 0u);
  EXPECT_EQ(measure_rest(spheres_at({{7.5, 4, 1}, {0.7, 4, 1.02 + height}}), slab, down).hanging, 1u);
  // Centres may lie anywhere along it.
  EXPECT_EQ(measure_rest(spheres_at({{7.5, 4, 1}, {0.7 + 24, 4 - 8, 1 + height}}), slab, down).hanging, 0u);
}

TEST(RestOfSpheres, ThatKeepGapsStandOnThose) {
  const auto two = spheres_at({{5, 5, 1.3}, {5, 5, 3.8}});
  EXPECT_EQ(measure_rest(two, box, down, {.gap = 0.5, .wall_gap = 0.3}).hanging, 0u);
  EXPECT_EQ(measure_rest(two, box, down).hanging, 2u);
}

TEST(RestOfSpheres, OnThreeBelowButNotOnTwoOrOnTheTopOfOne) {
  // A tetrahedron whose uppermost lies in the hollow of three on the floor; then one of them is missing.
  const double a = 1 / std::sqrt(3.0), height = std::sqrt(8.0 / 3);
  const Vector<3> middle(5, 5, 1);
  std::vector<Vector<3>> centers = {middle + Vector<3>(2 * a, 0, 0), middle + Vector<3>(-a, 1, 0),
                                    middle + Vector<3>(-a, -1, 0), middle + Vector<3>(0, 0, height)};
  EXPECT_EQ(measure_rest(spheres_at(centers), box, down).unsettled, 0u);
  centers.erase(centers.begin());
  const Rest on_two = measure_rest(spheres_at(centers), box, down);
  EXPECT_EQ(on_two.unsettled, 1u);
  EXPECT_EQ(on_two.hanging, 0u);  // it rolls
  // On the top of one it balances, which is rest, to a slope of a millionth.
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1}, {5, 5, 3}}), box, down).unsettled, 0u);
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1}, {5 + 1e-5, 5, 3}}), box, down).unsettled, 1u);
  // In the corner of two walls it needs but one below.
  EXPECT_EQ(measure_rest(spheres_at({{1, 1, 1}, {1, 1, 3}}), box, down).unsettled, 0u);
}

TEST(RestOfSpheres, FrictionHoldsUpToItsAngle) {
  const auto leaning = [](double degrees) {
    const double angle = degrees * std::acos(-1.0) / 180;
    return spheres_at({{5, 5, 1}, {5 + 2 * std::sin(angle), 5, 1 + 2 * std::cos(angle)}});
  };
  const auto with = [](const Spheres<dynamic>& spheres, double friction) {
    return measure_rest(spheres, box, down, {.friction = friction});
  };
  EXPECT_EQ(with(leaning(20), 0).unsettled, 1u);
  EXPECT_EQ(with(leaning(20), 0).held_by_friction, 0u);
  EXPECT_EQ(with(leaning(20), 19.9).unsettled, 1u);
  const Rest held = with(leaning(20), 20.1);
  EXPECT_EQ(held.unsettled, 0u);
  EXPECT_EQ(held.held_by_friction, 1u);
  EXPECT_NEAR(held.friction, 20, 1e-4);
  // What rests anyway needs none, and what touches nothing, or a wall that is upright, is held by none.
  EXPECT_EQ(with(leaning(0), 45).held_by_friction, 0u);
  EXPECT_EQ(with(spheres_at({{5, 5, 3}}), 45).hanging, 1u);
  EXPECT_EQ(with(spheres_at({{1, 5, 3}}), 89).hanging, 1u);
  // Across a gap of two: along the line between them it would slide level, and rests; off that line it rolls.
  EXPECT_NEAR(with(spheres_at({{4, 5, 1}, {6, 5, 1}, {5, 5 + std::sqrt(3.0) * 0.5, 2.5}}), 45).friction, 30,
              1e-4);
}

TEST(RestOfSpheres, ContactsAreClosedToAMillionthOfARadius) {
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1 + 0.9e-6}}), box, down).unsettled, 0u);
  const Rest above = measure_rest(spheres_at({{5, 5, 1 + 1.1e-6}}), box, down);
  EXPECT_EQ(above.unsettled, 1u);
  EXPECT_EQ(above.hanging, 0u);
  EXPECT_EQ(above.farthest, 0);
}

TEST(RestOfSpheres, OnTheGroundOfRoundWallsAndOfASlope) {
  const Sphere ball{.radius = 4};
  EXPECT_EQ(measure_rest(spheres_at({{0, 0, -3}}), ball, down).unsettled, 0u);
  EXPECT_EQ(measure_rest(spheres_at({{3 * std::sin(1e-3), 0, -3 * std::cos(1e-3)}}), ball, down).unsettled,
            1u);
  // Gravity across the floor: it slides along it to the wall.
  EXPECT_EQ(measure_rest(spheres_at({{5, 5, 1}}), box, {1e-4, 0, -1}).unsettled, 1u);
  EXPECT_EQ(measure_rest(spheres_at({{9, 5, 1}}), box, {1e-4, 0, -1}).unsettled, 0u);
}

/// The same by brute force: each sphere walks along the direction in small steps, past all images of all.
struct Walked {
  std::uint64_t spheres = 0;
  double farthest = 0;
};

Walked walked(const Spheres<dynamic>& spheres, const Domain& domain, const Vector<3>& direction) {
  const Frame frame = frame_of(domain);
  const auto container = make_local_container(domain, frame, WallArithmetic::filtered);
  const Boundary<3>& boundary = container->boundary();
  const Vector<3> u = direction.normalized();
  std::vector<Vector<3>> at;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    Vector<3> c = Vector<3>::Zero();
    c.head(spheres.dimension()) = spheres.center(i);
    at.push_back(frame.to_local(c));
  }
  Walked result;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double r = spheres.r[i] / frame.scale;
    const auto is_free = [&](double t) {
      const Vector<3> p = at[i] + t * u;
      for (std::size_t j = 0; j < spheres.size(); ++j) {
        const double sum = r + spheres.r[j] / frame.scale;
        if (j == i || boundary.minimum_image(at[j] - p).norm() >= sum) continue;
        if (boundary.minimum_image(at[j] - p).dot(u) > 0) return false;
      }
      return container->contains(p, r);
    };
    double t = 0;
    for (const double step = 5e-4 * r; t < 0.02 * r && is_free(t + step);) t += step;
    if (t < 0.02 * r) {
      for (double step = 5e-4 * r; step > 1e-9 * r; step /= 2)
        if (is_free(t + step)) t += step;
    } else {
      for (const double step = 0.05 * r; is_free(t + step);) t += step;
    }
    if (t < Rest::least_fall * r) continue;
    ++result.spheres;
    result.farthest = std::max(result.farthest, t * frame.scale);
  }
  return result;
}

void expect_as_walked(const Spheres<dynamic>& spheres, const Domain& domain, const Vector<3>& direction) {
  const Walked expected = walked(spheres, domain, direction);
  const Rest found = measure_rest(spheres, domain, direction);
  EXPECT_EQ(found.hanging, expected.spheres);
  EXPECT_NEAR(found.farthest, expected.farthest, 0.05 * std::ranges::max(spheres.r));
}

std::string stages(int iterations, const std::string& direction) {
  return "[[stage]]\ndo = \"insert\"\npacking_fraction = 0.25\n[[stage]]\ndo = \"compress\"\nmax_iterations "
         "= " +
         std::to_string(iterations) + "\ndirection = " + direction + "\n";
}

TEST(RestOfSpheres, AsManyAsAWalkInSmallStepsFinds) {
  const std::string wide = "radius = { distribution = \"uniform\", min = 0.1, max = 1.0 }\ncount = 70\n";
  const std::string equal = "radius = 0.5\ncount = 70\n";
  struct Case {
    const char* name;
    std::string container, spheres, direction;
  };
  const Case cases[] = {
      {"box", "kind = \"box\"\nsize = [8.0, 7.0, 12.0]\n", wide, "[0, 0, -1]"},
      {"box, oblique", "kind = \"box\"\nsize = [8.0, 7.0, 12.0]\n", equal, "[1, -2, 3]"},
      {"tilted cylinder", "kind = \"cylinder\"\nradius = 4.0\nheight = 12.0\naxis = [1.0, 2.0, 3.0]\n", wide,
       "[0, 0, -1]"},
      {"sphere", "kind = \"sphere\"\nradius = 5.0\n", equal, "[0, 1, 0]"},
      {"column without end", "kind = \"cylinder\"\nradius = 4.0\nheight = 8.0\nperiodic = true\n", equal,
       "[1, 0, 0]"},
      {"slab", "kind = \"periodic\"\nsize = [8.0, 8.0, 9.0]\nwalls = [2]\n", equal, "[0, 0, 1]"},
      {"discs", "kind = \"box\"\nsize = [14.0, 16.0]\n", equal, "[0, -1]"},
      {"discs in a polygon",
       "kind = \"polygon\"\nvertices = [[0.0, 0.0], [14.0, 2.0], [16.0, 16.0], [1.0, 14.0]]\n", wide,
       "[1, -4]"}};
  for (const Case& c : cases)
    for (const int iterations : {2, 40}) {
      SCOPED_TRACE(std::string(c.name) + ", " + std::to_string(iterations));
      const Packing packing = run(testing::plan_of("[container]\n" + c.container + "[spheres]\n" + c.spheres +
                                                   stages(iterations, c.direction)));
      const Compress options = *packing.scene.stages[1].as<Compress>();
      Vector<3> direction = Vector<3>::Zero();
      direction.head(options.direction.size()) = options.direction;
      expect_as_walked(packing.spheres, packing.domain, direction);
    }
}

TEST(RestOfSpheres, AsManyInAMesh) {
  Plan plan = testing::plan_of(
      "[container]\nkind = \"cylinder\"\nradius = 4.0\nheight = 12.0\n[spheres]\nradius = 0.5\ncount = "
      "120\n" +
      stages(5, "[0, 0, -1]"));
  plan.domain = test::prism_mesh(16, 4, 12);
  plan.container = nullptr;
  const Packing packing = run(plan);
  ASSERT_GT(packing.spheres.size(), 60u);
  expect_as_walked(packing.spheres, packing.domain, down);
}

TEST(RestOfSpheres, FarFromTheOriginAndInAnyUnitIsTheSame) {
  const Packing packing =
      run(testing::plan_of("[container]\nkind = \"cylinder\"\nradius = 4.0\nheight = 12.0\n[spheres]\nradius "
                           "= 0.5\ncount = 120\n" +
                           stages(6, "[0, 0, -1]")));
  const Rest here = measure_rest(packing.spheres, packing.domain, down);
  ASSERT_GT(here.hanging, 0u);
  Spheres<dynamic> far = packing.spheres;
  for (auto* column : {&far.x[0], &far.x[1], &far.x[2]})
    for (double& x : *column) x = 1024 * (x + 4096);
  for (double& r : far.r) r *= 1024;
  const Domain there =
      testing::shifted(testing::scaled(packing.domain, 1024), Vector<3>::Constant(1024.0 * 4096));
  const Rest found = measure_rest(far, there, down);
  EXPECT_EQ(found.hanging, here.hanging);
  EXPECT_NEAR(found.farthest, 1024 * here.farthest, 1e-3 * found.farthest);
}

}  // namespace rest_test
}  // namespace bernal

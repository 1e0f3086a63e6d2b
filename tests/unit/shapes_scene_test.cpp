// Containers that need no CAD file: what their words mean, and what they refuse.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bernal/core/error.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "domain/revolved_surface.hpp"
#include "support/containers.hpp"
#include "support/scenes.hpp"
#include "support/scenes_under_test.hpp"

namespace bernal {
namespace shapes_scene_test {

using std::numbers::pi;

std::string scene_with(const std::string& container, const std::string& rest = "") {
  return "unit = \"mm\"\n[container]\n" + container + "\n[spheres]\ncount = 5\nradius = 0.2\n" + rest;
}

Domain domain_with(const std::string& container) {
  return domain_of(parse_scene(scene_with(container), "s.toml"));
}

std::string error_with(const std::string& container, const std::string& rest = "") {
  try {
    build(parse_scene(scene_with(container, rest), "s.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::vector<Vector<2>> profile_with(const std::string& container) {
  return std::get<Revolved>(domain_with(container)).profile;
}

using Line = std::vector<Vector<2>>;

TEST(Shapes, AConeAndATubeAreSolidsOfRevolution) {
  const std::string cone = "kind = \"cone\"\nradii = [2, 0.5]\nheight = 3\n";
  EXPECT_EQ(profile_with(cone), (Line{{0, 0}, {2, 0}, {0.5, 3}, {0, 3}}));
  EXPECT_NEAR(volume_of(domain_with(cone)), pi / 3 * 3 * (4 + 1 + 0.25), 1e-12);
  EXPECT_NEAR(area_of(domain_with(cone)), pi * (4 + 0.25 + 2.5 * std::hypot(1.5, 3)), 1e-12);
  const std::string tube = "kind = \"tube\"\nradius = 2\ninner_radius = 1\nheight = 3\nbase = [1, 0, 0]\n";
  EXPECT_NEAR(volume_of(domain_with(tube)), pi * 3 * 3, 1e-12);
  EXPECT_NEAR(area_of(domain_with(tube)), 2 * pi * 3 * 3 + 2 * pi * 3, 1e-12);
  EXPECT_EQ(bounds_of(domain_with(tube)).lower, Vector<3>(-1, -2, 0));
}

TEST(Shapes, AProfileIsClosedAsPeopleMeanIt) {
  const auto revolved = [](const std::string& points) {
    return profile_with("kind = \"revolved\"\nprofile = " + points + "\n");
  };
  EXPECT_EQ(revolved("[[1, 0], [1, 2], [3, 4]]"), (Line{{0, 0}, {1, 0}, {1, 2}, {3, 4}, {0, 4}}));
  EXPECT_EQ(revolved("[[3, 4], [1, 2], [1, 0]]"), (Line{{0, 4}, {3, 4}, {1, 2}, {1, 0}, {0, 0}}));
  EXPECT_EQ(revolved("[[0, 0], [1, 0], [3, 4]]"), (Line{{0, 0}, {1, 0}, {3, 4}, {0, 4}}));
  EXPECT_EQ(revolved("[[0, 0], [1, 0], [3, 4], [0, 4]]"), (Line{{0, 0}, {1, 0}, {3, 4}, {0, 4}}));
  EXPECT_EQ(revolved("[[1, 0], [2, 0], [2, 1], [1, 1]]"), (Line{{1, 0}, {2, 0}, {2, 1}, {1, 1}}));
  EXPECT_EQ(revolved("[[0, 0], [1, 1], [0, 2]]"), (Line{{0, 0}, {1, 1}, {0, 2}}));
}

TEST(Shapes, APrismIsAClosedMeshOfItsVolume) {
  const Domain prism = domain_with(
      "kind = \"extruded\"\npolygon = [[0, 0], [6, 0], [6, 3], [3, 3], [3, 6], [0, 6]]\n"
      "holes = [[[1, 1], [2, 1], [2, 2], [1, 2]], [[4, 1], [4, 2], [5, 2]]]\nheight = 2\nbase = [1, 2, 3]\n");
  const Mesh& mesh = std::get<Mesh>(prism);
  EXPECT_NEAR(volume_of(prism), 2 * (27 - 1 - 0.5), 1e-12);
  EXPECT_NEAR(area_of(prism), 2 * (27 - 1.5) + 2 * (24 + 4 + 2 + std::sqrt(2.0)), 1e-12);
  EXPECT_EQ(bounds_of(prism).lower, Vector<3>(1, 2, 3));
  EXPECT_EQ(bounds_of(prism).upper, Vector<3>(7, 8, 5));
  // The outline runs the other way, a hole as the outline: no matter.
  const Domain turned = domain_with(
      "kind = \"extruded\"\npolygon = [[0, 6], [3, 6], [3, 3], [6, 3], [6, 0], [0, 0]]\nheight = 2\n");
  EXPECT_NEAR(volume_of(turned), 2 * 27, 1e-12);
  const auto container = make_container(prism, WallArithmetic::exact, 1e-15);
  EXPECT_TRUE(container->contains({2.5, 2.5, 4}, 0.5));
  EXPECT_FALSE(container->contains({2.5, 3.5, 4}, 0.1));
  EXPECT_TRUE(container->contains({3.5, 3.5, 4}, 0.5));
  EXPECT_EQ(mesh.triangles.size(), 2 * (13 + 2 * 2 - 2) + 2 * 13u);
}

// 0.1 + 0.2 is above 0.3 as a sum of doubles, and less than the double next to it: the wall is the sum.
TEST(Shapes, APrismWithABaseIsCertifiedAgainstItsExactCorners) {
  const Domain prism = domain_with(
      "kind = \"extruded\"\npolygon = [[0, 0], [0.2, 0], [0.2, 10], [0, 10]]\nheight = 10\n"
      "base = [0.1, 0, 0]\n");
  ASSERT_TRUE(std::get<Mesh>(prism).exact);
  Spheres<dynamic> ball(3);
  ball.push_back(Vector<3>(0.25, 5, 5), 0.050000000000000044);
  EXPECT_FALSE(certify(ball, prism).certified);
  ball.r[0] = 0.05;
  EXPECT_TRUE(certify(ball, prism).certified);
  const Domain whole = domain_with(
      "kind = \"extruded\"\npolygon = [[0, 0], [2, 0], [2, 10], [0, 10]]\nheight = 10\nbase = [1, 2, 3]\n");
  EXPECT_FALSE(std::get<Mesh>(whole).exact);
}

TEST(Shapes, AreCalledByTheirWordsAndAPointByItsNumber) {
  const Plan cone = build(parse_scene(scene_with("kind = \"cone\"\nradii = [3, 1]\nheight = 4"), "s.toml"));
  EXPECT_NE(describe(cone).find("container  cone,"), std::string::npos) << describe(cone);
  EXPECT_NE(error_with("kind = \"revolved\"\nprofile = [[0, 0], [2, 2, 1], [0, 2]]")
                .find("point 2 of \"profile\" in [container] must be two numbers [r, z]"),
            std::string::npos);
}

TEST(Shapes, WhatTheyAreNotIsSaidInOneLine) {
  EXPECT_NE(error_with("kind = \"cone\"\nradii = [1, 2, 3]\nheight = 1").find("must be two"),
            std::string::npos);
  EXPECT_NE(error_with("kind = \"cone\"\nradii = [0, 0]\nheight = 1").find("not both 0"), std::string::npos);
  EXPECT_NE(error_with("kind = \"tube\"\nradius = 1\ninner_radius = 2\nheight = 1").find("below its radius"),
            std::string::npos);
  EXPECT_NE(
      error_with("kind = \"revolved\"\nprofile = [[0, 0], [2, 2], [2, 0], [0, 2]]").find("meet at about"),
      std::string::npos);
  EXPECT_NE(error_with("kind = \"revolved\"\nprofile = [[0, 0], [-2, 2], [0, 2]]").find("r >= 0"),
            std::string::npos);
  EXPECT_NE(error_with("kind = \"revolved\"").find("\"profile\""), std::string::npos);
  EXPECT_NE(error_with("kind = \"extruded\"\npolygon = [[0, 0], [2, 2], [2, 0], [0, 2]]\nheight = 1")
                .find("meet at about"),
            std::string::npos);
  const std::string cone = "kind = \"cone\"\nradii = [3, 1]\nheight = 4";
  EXPECT_NE(error_with(cone, "[engine]\nkind = \"lammps\"\n[[stage]]\ndo = \"relax\"\n")
                .find("engines have no walls of a solid of revolution"),
            std::string::npos);
}

// What pictures, measures and formats take for the solid: closed, outwards, near it, and of its volume.
TEST(SurfaceOfARevolved, IsClosedAndNearIt) {
  for (const test::ContainerUnderTest& tested : test::containers_under_test()) {
    const auto* solid = std::get_if<Revolved>(&tested.shape);
    if (!solid) continue;
    const double volume = volume_of(tested.shape);
    EXPECT_NEAR(volume_of(surface_of(*solid, 64, RoundAs::of_same_area)), volume, 1e-9 * volume)
        << tested.name;
    double widest = 0;
    for (const Vector<2>& p : solid->profile) widest = std::max(widest, p[0]);
    const double deflection = 1e-2 * widest;
    const auto sides = static_cast<int>(sides_for(*solid, deflection));
    for (const RoundAs as : {RoundAs::inscribed, RoundAs::circumscribed}) {
      const Mesh mesh = surface_of(*solid, sides, as);
      const auto container = tested.container();
      const auto flat = make_container(Domain(mesh), WallArithmetic::plain, tested.resolution);
      EXPECT_GT(volume_of(mesh), 0) << tested.name;
      const bool is_around = as == RoundAs::circumscribed;
      EXPECT_EQ(volume_of(mesh) >= volume, is_around) << tested.name;
      Random random(1, stream(Stream::test));
      for (int k = 0; k < 100; ++k) {
        const Vector<3> p = uniform_point<3>(random, container->bounds());
        EXPECT_NEAR(flat->clearance(p), container->clearance(p), 1.01 * deflection) << tested.name;
        EXPECT_TRUE(!is_around || flat->clearance(p) >= container->clearance(p) - 1e-9) << tested.name;
      }
    }
  }
}

}  // namespace shapes_scene_test
}  // namespace bernal

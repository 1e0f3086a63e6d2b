// What is taken out of containers that stand in no file, and rounded edges: shapes that are packed as meshes,
// or as solids of revolution, inside of what they stand for.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "cad/diagnose/diagnose_mesh.hpp"
#include "domain/flattened.hpp"
#include "domain/rounded.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace obstacles_test {

using std::numbers::pi;

std::string scene_with(const std::string& container) {
  return "unit = \"mm\"\n[container]\n" + container + "\n[spheres]\ncount = 40\nradius = 1\n";
}

Domain domain_with(const std::string& container) {
  return domain_of(parse_scene(scene_with(container), "s.toml"));
}

std::string refusal_of(const std::string& container) {
  try {
    build(parse_scene(scene_with(container), "s.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

const std::string cylinder = "kind = \"cylinder\"\nradius = 20\nheight = 60\n";
const std::string across =
    "obstacles = [{ kind = \"cylinder\", radius = 5, height = 60, axis = [1, 0, 0], base = [-30, 0, 30] }]";

bool is_closed_and_outward(Mesh mesh) {
  cad::Triangles triangles{.mesh = mesh};
  return cad::diagnose_mesh(triangles).usable() && triangles.mesh.triangles == mesh.triangles &&
         volume_of(mesh) > 0;
}

// The volume that cylinders of the radii R and a < R have in common, at right angles: the integral of
// 4 √(R² - y²) √(a² - y²) over y, here by the substitution y = a sin t.
double common_volume(double R, double a) {
  constexpr int steps = 2000;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const double t = pi * ((k + 0.5) / steps - 0.5), y = a * std::sin(t);
    sum += 4 * std::sqrt(R * R - y * y) * std::pow(a * std::cos(t), 2) * pi / steps;
  }
  return sum;
}

TEST(Obstacles, WhatIsLeftHasTheVolumeThatIsLeft) {
  const double whole = pi * 400 * 60;
  EXPECT_NEAR(volume_of(domain_with(cylinder + across)), whole - common_volume(20, 5), 2e-4 * whole);
  const std::string box = "kind = \"box\"\nsize = [10, 10, 10]\n";
  EXPECT_NEAR(
      volume_of(domain_with(box + "obstacles = [{ kind = \"box\", size = [2, 3, 4], corner = [1, 1, 1] }, "
                                  "{ kind = \"box\", size = [20, 1, 1], corner = [-5, 8, 8] }]")),
      1000 - 24 - 10, 1e-9);
  EXPECT_NEAR(volume_of(domain_with("kind = \"sphere\"\nradius = 10\n"
                                    "obstacles = [{ kind = \"sphere\", radius = 5 }]")),
              4 * pi / 3 * (1000 - 125), 2e-3 * 4000);
  EXPECT_NEAR(volume_of(domain_with("kind = \"extruded\"\npolygon = [[0, 0], [6, 0], [0, 6]]\nheight = 5\n"
                                    "obstacles = [{ kind = \"extruded\", polygon = [[1, 1], [2, 1], [1, 2]], "
                                    "height = 9, base = [0, 0, -2] }]")),
              (18 - 0.5) * 5, 1e-9);
}

TEST(Obstacles, ARodAboutTheAxisLeavesASolidOfRevolution) {
  const std::string rod =
      "obstacles = [{ kind = \"cylinder\", radius = 1, height = 80, base = [0, 0, -10] }]";
  const Domain tube = domain_with(cylinder + rod);
  EXPECT_TRUE(std::holds_alternative<Revolved>(tube));
  EXPECT_NEAR(volume_of(tube), pi * 399 * 60, 1e-9 * pi * 399 * 60);
  const std::string vessel = "kind = \"revolved\"\nprofile = [[4, 0], [4, 5], [8, 12], [8, 20]]\n";
  const Domain around = domain_with(
      vessel +
      "obstacles = [{ kind = \"cylinder\", radius = 1, height = 20, axis = [0, 0, -3], base = [0, 0, 20] }]");
  EXPECT_TRUE(std::holds_alternative<Revolved>(around)) << "it touches floor and lid";
  const double volume = pi * (16 * 5 + 7 * (16 + 32 + 64) / 3.0 + 64 * 8 - 20);
  EXPECT_NEAR(volume_of(around), volume, 1e-9 * volume);
  const auto container = make_container(around, WallArithmetic::exact, 1e-15);
  EXPECT_TRUE(container->contains({2, 0, 10}, 1));
  EXPECT_FALSE(container->contains({2, 0, 10}, std::nextafter(1.0, 2.0)));
  for (const auto& [rest, base] : {std::pair{400 * 60 - 30, "[0, 0, 5]"}, {400 * 60 - 20, "[0, 0, -10]"}}) {
    const Domain stood = domain_with(
        cylinder +
        fmt::format("obstacles = [{{ kind = \"cylinder\", radius = 1, height = 30, base = {} }}]", base));
    EXPECT_TRUE(std::holds_alternative<Revolved>(stood)) << "it ends within";
    EXPECT_NEAR(volume_of(stood), pi * rest, 1e-9 * pi * rest) << base;
  }
  for (const char* other : {"radius = 1, height = 80, base = [1, 0, -10]",
                            "radius = 1, height = 80, base = [0, 0, -10], axis = [0, 1e-3, 1]"})
    EXPECT_TRUE(std::holds_alternative<Mesh>(
        domain_with(cylinder + "obstacles = [{ kind = \"cylinder\", " + other + " }]")))
        << other;
}

// A ball between the flat faces lies between the round walls, whatever these are; and one that keeps the
// deviation from the round walls lies between the flat faces.
TEST(Obstacles, FlatFacesStandOnTheInnerSideOfRoundWalls) {
  const Revolved tube{{0.1, 0.2, 0.3}, {1, -2, 0.5}, {{0.4, 0}, {1, 0}, {1, 1.6}, {0.4, 1.6}}};
  const Revolved hopper{.profile = {{0, 0}, {0.2, 0}, {0.2, 0.2}, {1, 1}, {1, 2}, {0, 2}}};
  const Cylinder column{{0, 1, 0}, {0, 1, 1}, 0.7, 1.5};
  for (const Domain& domain :
       {Domain(tube), Domain(hopper), Domain(column), Domain(Sphere{{0, 0, 1}, 1.1})}) {
    const auto round = make_container(domain, WallArithmetic::exact, 1e-15);
    const Flattened within = flattened(domain, RoundAs::within);
    const Flattened around = flattened(domain, RoundAs::circumscribed);
    ASSERT_TRUE(is_closed_and_outward(within.mesh) && is_closed_and_outward(around.mesh)) << kind_of(domain);
    const auto inner = make_container(within.mesh, WallArithmetic::exact, 1e-15);
    const auto outer = make_container(around.mesh, WallArithmetic::exact, 1e-15);
    Random random(1, 2);
    const Bounds<3> bounds = round->bounds();
    int inside = 0;
    for (int k = 0; k < 3000; ++k) {
      Vector<3> p;
      for (int i = 0; i < 3; ++i) p[i] = bounds.lower[i] + random.uniform() * bounds.size()[i];
      const double tiny = 1e-13, depth = round->clearance(p);
      EXPECT_LE(inner->clearance(p), depth + tiny) << kind_of(domain) << ": " << p.transpose();
      EXPECT_GE(outer->clearance(p), depth - tiny) << kind_of(domain) << ": " << p.transpose();
      if (depth <= 0) continue;
      ++inside;
      EXPECT_GE(inner->clearance(p), depth - within.deviation - tiny) << kind_of(domain);
      EXPECT_LE(outer->clearance(p), depth + around.deviation + tiny) << kind_of(domain);
    }
    EXPECT_GT(inside, 300);
  }
}

TEST(Obstacles, APipeOfAFileAcrossACylinderIsPackedAroundAndCertifiedFromTheFiles) {
  const testing::Folder folder;
  folder.write("pipe.off", test::as_off(test::box_mesh({-25, -4, 26}, {50, 8, 8})));
  folder.write("s.toml",
               scene_with(cylinder + "obstacles = [\"pipe.off\", { kind = \"sphere\", radius = 8 }]"));
  const Packing packing = run(build(read_scene(folder / "s.toml")));
  ASSERT_EQ(packing.spheres.size(), 40u);
  const auto inside = make_container(Cylinder{{0, 0, 0}, {0, 0, 1}, 20, 60}, WallArithmetic::exact, 1e-15);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Vector<3> c = packing.spheres.center(i);
    const Vector<2> beyond(std::abs(c[1]) - 4, std::abs(c[2] - 30) - 4);
    EXPECT_TRUE(inside->contains(c, 1));
    EXPECT_GE(beyond.cwiseMax(0).norm(), 1) << c.transpose();
    EXPECT_GE(c.norm(), 9) << c.transpose();
  }
  write_packing(packing, folder / "out");
  const Packing again = read_packing(folder / "out");
  EXPECT_TRUE(certify(again.spheres, again.domain).certified);
  EXPECT_EQ(volume_of(again.domain), volume_of(packing.domain));
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "container.off"));
  folder.write("pipe.off", test::as_off(test::box_mesh({-25, -4, 26}, {50, 8, 9})));
  EXPECT_EQ(changed_files(again.scene).size(), 1u);
}

TEST(Obstacles, AreWrittenAsTheyWereRead) {
  const std::vector<std::string> containers = {
      cylinder + across, cylinder + "rounding = 2\n" + across,
      "kind = \"mesh\"\nfile = \"a.stl\"\nobstacles = [\"b.stl\", { kind = \"cone\", radii = [1, 0], "
      "height = 2 }]",
      "kind = \"box\"\nsize = [4, 5, 6]\nrounding = \"1 mm\"\n"};
  for (const std::string& container : containers) {
    const Scene scene = parse_scene(scene_with(container), "/s.toml");
    const std::string text = scene_as_toml(scene);
    EXPECT_EQ(scene_as_toml(parse_scene(text, "/s.toml")), text);
  }
  const std::string text = scene_as_toml(parse_scene(scene_with(cylinder + across), "/s.toml"));
  EXPECT_NE(text.find("obstacles = [{ kind = \"cylinder\", radius = 5, height = 60, "), std::string::npos)
      << text;
}

TEST(Obstacles, TheContainerKeepsItsWord) {
  const std::string said = describe(build(parse_scene(scene_with(cylinder + across), "s.toml")));
  EXPECT_NE(said.find("container  cylinder,"), std::string::npos) << said;
  EXPECT_NE(said.find("took out obstacle 1 (cylinder) of 1024 faces"), std::string::npos) << said;
  EXPECT_NE(said.find("off by 0.0015 mm at most"), std::string::npos) << said;
}

TEST(Obstacles, WhatCannotBeIsSaidInOneLine) {
  const auto refused = [](const std::string& container, const std::string& why) {
    EXPECT_NE(refusal_of(container).find(why), std::string::npos) << refusal_of(container);
  };
  refused(cylinder + "obstacles = [{ kind = \"sphere\", radius = 1, center = [40, 0, 0] }]",
          "s.toml:6: obstacle 1 (sphere) lies outside of the container");
  refused(cylinder + "obstacles = [{ kind = \"sphere\", radius = 100 }]", "leaves nothing of the container");
  refused(cylinder + "periodic = true\n" + across, "no periods");
  refused("kind = \"box\"\nsize = [4, 5]\nobstacles = [\"a.stl\"]", "no periods");
  refused(cylinder + "obstacles = [{ kind = \"box\", size = [4, 5] }]",
          "solid 1 of obstacles of [container]: what has obstacles, or is one, has three dimensions");
  refused(cylinder + "obstacles = [{ kind = \"periodic\", edge = 1 }]", "unknown kind \"periodic\"");
  refused(cylinder + "obstacles = [{ kind = \"sphere\" }]",
          "missing \"radius\" in solid 1 of obstacles of [container]");
  refused(cylinder + "obstacles = [{ kind = \"sphere\", radius = 1, obstacles = [\"a.stl\"] }]",
          "cannot have obstacles of its own");
  refused(cylinder + "obstacles = [3]",
          "\"obstacles\" in [container] must be an array of files and of tables");
  refused(cylinder + "obstacles = [\"absent.stl\"]", "absent.stl");
}

TEST(Rounding, ABallIsInARoundedBoxOnlyIfItReachesNowhereBeyondTheTrueOne) {
  const Box box{Vector<3>(-1, 2, 0.25), Vector<3>(2, 1.5, 1)};
  const double q = 0.3;
  const Mesh mesh = rounded(box, q);
  ASSERT_TRUE(is_closed_and_outward(mesh));
  const auto walls = make_container(mesh, WallArithmetic::exact, 1e-15);
  const Bounds<3> bounds = bounds_of(box);
  EXPECT_EQ(bounds_of(mesh).lower, bounds.lower);
  EXPECT_EQ(bounds_of(mesh).upper, bounds.upper);
  // Steiner: of the inner box volume, q times its area, pi q² times the sum of its three edges, and a ball.
  const Vector<3> e = bounds.size() - Vector<3>::Constant(2 * q);
  const double whole = e.prod() + 2 * q * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]) + pi * q * q * e.sum() +
                       4 * pi / 3 * q * q * q;
  EXPECT_NEAR(volume_of(mesh), whole, 4e-4 * whole);
  EXPECT_LT(volume_of(mesh), whole);
  Random random(1, 2);
  for (int k = 0; k < 3000; ++k) {
    Vector<3> p;
    for (int i = 0; i < 3; ++i) p[i] = bounds.lower[i] + random.uniform() * bounds.size()[i];
    // The clearance of the true one: q less the distance from the inner box, or q and the depth in that.
    const Vector<3> half = 0.5 * e, depth = half - (p - bounds.center()).cwiseAbs();
    const double clearance = depth.minCoeff() >= 0 ? q + depth.minCoeff() : q - depth.cwiseMin(0).norm();
    EXPECT_LE(walls->clearance(p), clearance + 1e-13);
    EXPECT_GE(walls->clearance(p), clearance - deviation_of_rounded_box * q);
  }
}

TEST(Rounding, ACylinderMayBecomeABall) {
  const Cylinder tin{{1, 2, 3}, {0, 0, 2}, 2, 4};
  const Revolved ball = rounded(tin, 2);
  EXPECT_NO_THROW(require_profile(ball));
  EXPECT_NEAR(volume_of(ball), 4 * pi / 3 * 8, 1e-3 * 33);
  const Revolved edges = rounded(tin, 0.5);
  EXPECT_NO_THROW(require_profile(edges));
  EXPECT_EQ(bounds_of(edges).upper[2], 7);
  // Pappus: a corner of q² (1 - pi/4), turned about the axis at the distance of its centroid.
  const double q = 0.5, corner = q * q * (1 - pi / 4);
  const double centroid = 2 - q + q * (1. / 2 - 1. / 3) / (1 - pi / 4);
  const double whole = pi * 16 - 2 * corner * 2 * pi * centroid;
  EXPECT_NEAR(volume_of(edges), whole, 3e-3);
  EXPECT_LT(volume_of(edges), whole);
  const Revolved edge = rounded(Cylinder{{0, 0, 0}, {0, 0, 1}, 2, 1}, 0.5);  // no straight side is left
  EXPECT_NO_THROW(require_profile(edge));
}

TEST(Rounding, IsSaidByBoxesAndCylindersOnly) {
  const std::string box = "kind = \"box\"\nsize = [8, 10, 12]\n";
  EXPECT_EQ(refusal_of(box + "rounding = 4"), "");
  EXPECT_NE(refusal_of(box + "rounding = 4.1").find("at most 4"), std::string::npos);
  EXPECT_NE(refusal_of("kind = \"box\"\nsize = [8, 10]\nrounding = 1").find("three dimensions"),
            std::string::npos);
  EXPECT_NE(refusal_of(cylinder + "periodic = true\nrounding = 1").find("without periods"),
            std::string::npos);
  EXPECT_NE(refusal_of("kind = \"sphere\"\nradius = 9\nrounding = 1").find("unknown key \"rounding\""),
            std::string::npos);
  const std::string said = describe(build(parse_scene(scene_with(box + "rounding = 2"), "s.toml")));
  EXPECT_NE(said.find("container  box,"), std::string::npos) << said;
  EXPECT_NE(said.find("off by 0.0022 mm at most"), std::string::npos) << said;
}

}  // namespace obstacles_test
}  // namespace bernal

// Parts of a container with spheres of their own: how they share it, and what they refuse.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/formats/export.hpp"
#include "bernal/formats/import.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/report/describe.hpp"
#include "bernal/report/zones_in_place.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "bernal/verify/certificate.hpp"
#include "geometry/changes.hpp"
#include "plan/part_below.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace zones_test {

using std::numbers::pi;
using testing::error_of;
using testing::Folder;
using testing::text_of;

constexpr std::string_view cylinder = "container = { kind = \"cylinder\", radius = 5, height = 20 }\n";

Scene scene_of(const std::string& text) { return parse_scene("unit = \"mm\"\n" + text, "zones.toml"); }

std::string refusal(const std::string& text) {
  return error_of([&] { build(scene_of(text)); }).what();
}

bool is_certified(const Packing& packing) { return certify(packing.spheres, packing.domain).certified; }

/// The lowest and the highest point of the spheres of a class along an axis.
std::pair<double, double> extent_of(const Packing& packing, std::uint32_t of, std::size_t axis = 2) {
  double lowest = 1e300, highest = -1e300;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    if (packing.classes[i] != of) continue;
    lowest = std::min(lowest, packing.spheres.x[axis][i] - packing.spheres.r[i]);
    highest = std::max(highest, packing.spheres.x[axis][i] + packing.spheres.r[i]);
  }
  return {lowest, highest};
}

TEST(Zones, BetweenPlanesEachHasItsSizes) {
  const Packing packing =
      run(build(scene_of(std::string(cylinder) +
                         "spheres = { diameter = 2 }\n"
                         "[[zone]]\nplace = \"z < 8\"\ndiameter = 1\nmaterial = \"sand\"\n")),
          {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  ASSERT_EQ(packing.classes.size(), packing.spheres.size());
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    EXPECT_EQ(packing.spheres.r[i], packing.classes[i] == 0 ? 0.5 : 1.0);
  EXPECT_LE(extent_of(packing, 0).second, 8);
  EXPECT_GE(extent_of(packing, 1).first, 8);
  EXPECT_GT(std::ranges::count(packing.classes, 0u), 500);
  EXPECT_GT(std::ranges::count(packing.classes, 1u), 80);
  EXPECT_TRUE(is_certified(packing));
  const std::vector<SphereClass> classes = classes_of(packing.scene);
  ASSERT_EQ(classes.size(), 2u);
  EXPECT_EQ(classes[0].name, "sand");
  EXPECT_EQ(classes[1].name, "rest");
}

TEST(Zones, LayersOfABedLieOneUponTheOther) {
  const Packing packing =
      run(build(scene_of(
              std::string(cylinder) +
              "spheres = { diameter = 1.5, bed = \"poured\", height = 15, material_density = 2000 }\n"
              "[[zone]]\nplace = \"z < 6\"\ndiameter = 1\nmaterial = \"sand\"\nmaterial_density = 2600\n")),
          {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(is_certified(packing));
  EXPECT_LE(extent_of(packing, 0).second, 6 * (1 + 1e-3));
  EXPECT_GT(extent_of(packing, 0).second, 6 - 1.05);
  const auto [lowest, highest] = extent_of(packing, 1);
  EXPECT_LT(lowest, 6) << "it lies on the spheres below, not on a plane";
  EXPECT_GT(lowest, 4.5);
  EXPECT_LE(highest, 15 * (1 + 1e-3));
  EXPECT_GT(highest, 15 - 1.6);
  // Every centre of the upper layer is above the mean surface of the lower one.
  double mass = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    mass += (packing.classes[i] == 0 ? 2600 : 2000) * 4 * pi / 3 * std::pow(1e-3 * packing.spheres.r[i], 3);
  EXPECT_NEAR(*mass_of(packing, packing.packing_fraction()), mass, 1e-9 * mass);
}

TEST(Zones, LayersWithoutAPlaceLieInTheirOrder) {
  const Packing packing = run(
      build(scene_of(std::string(cylinder) + "spheres = { diameter = 2, count = 40, bed = \"poured\" }\n"
                                             "[[zone]]\nname = \"first\"\ndiameter = 1\ncount = 200\n"
                                             "[[zone]]\nname = \"second\"\ndiameter = 1.4\ncount = 80\n")),
      {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  for (std::uint32_t of = 0; of < 3; ++of)
    EXPECT_EQ(std::ranges::count(packing.classes, of), (std::vector{200, 80, 40}[of]));
  EXPECT_LT(extent_of(packing, 0).first, extent_of(packing, 1).first);
  EXPECT_LT(extent_of(packing, 1).first, extent_of(packing, 2).first);
  EXPECT_TRUE(is_certified(packing));
}

std::filesystem::path written_mesh(const Folder& folder, const std::string& name, const Mesh& mesh) {
  std::string off = fmt::format("OFF\n{} {} 0\n", mesh.vertices.size(), mesh.triangles.size());
  for (const Vector<3>& v : mesh.vertices) off += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
  for (const auto& t : mesh.triangles) off += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return folder.write(name, off);
}

TEST(Zones, ChambersAreCountedFromTheLargest) {
  const Folder folder;
  Mesh mesh = mesh_of_box({Vector<3>::Zero(), Vector<3>(10, 10, 10)});
  append(mesh, mesh_of_box({Vector<3>(20, 0, 0), Vector<3>(28, 8, 8)}));
  append(mesh, mesh_of_box({Vector<3>(40, 0, 0), Vector<3>(46, 6, 6)}));
  const auto file = written_mesh(folder, "chambers.off", mesh);
  const std::string container =
      fmt::format("container = {{ kind = \"mesh\", file = \"{}\" }}\n", file.string());
  const Packing packing = run(build(scene_of(container + "spheres = { diameter = 3 }\n"
                                                         "[[zone]]\nchamber = 2\ndiameter = 1.5\n"
                                                         "[[zone]]\nchamber = 3\ndiameter = 1\n")),
                              {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(is_certified(packing));
  EXPECT_GE(extent_of(packing, 0, 0).first, 20);
  EXPECT_LE(extent_of(packing, 0, 0).second, 28);
  EXPECT_GE(extent_of(packing, 1, 0).first, 40);
  EXPECT_LE(extent_of(packing, 2, 0).second, 10);
  const Packing between = run(build(scene_of(container + "spheres = { diameter = 3 }\n[[zone]]\n"
                                                         "place = \"x > 15\"\ndiameter = 1.5\n")),
                              {});
  EXPECT_TRUE(is_certified(between));
  EXPECT_GE(extent_of(between, 0, 0).first, 20) << "a plane between bodies cuts none of them";
  EXPECT_LE(extent_of(between, 1, 0).second, 10);
  EXPECT_NE(refusal(container + "spheres = { diameter = 3 }\n[[zone]]\nchamber = 4\ndiameter = 1\n")
                .find("has 3 closed spaces"),
            std::string::npos);
}

TEST(Zones, ASurfaceInTheContainerHasItsOwnSpheresAndTheRestLiesAround) {
  const Folder folder;
  const auto file =
      written_mesh(folder, "cube.off", mesh_of_box({Vector<3>(-2.5, -2.5, 6), Vector<3>(2.5, 2.5, 14)}));
  const std::string zone =
      fmt::format("[[zone]]\nmesh = \"{}\"\ndiameter = 0.8\nmaterial = \"sand\"\n", file.string());
  const Packing packing =
      run(build(scene_of(std::string(cylinder) + "spheres = { diameter = 1.2 }\n" + zone)), {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(is_certified(packing));
  EXPECT_GT(std::ranges::count(packing.classes, 0u), 300);
  EXPECT_GT(std::ranges::count(packing.classes, 1u), 400);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const Vector<3> c = packing.spheres.center(i) - Vector<3>(0, 0, 10);
    const double r = packing.spheres.r[i];
    const Vector<3> beyond = (c.cwiseAbs() - Vector<3>(2.5, 2.5, 4)).eval();
    if (packing.classes[i] == 0)
      EXPECT_LE(beyond.maxCoeff(), -r) << i;
    else
      EXPECT_GE(beyond.cwiseMax(0).norm(), r * (1 - 1e-12)) << i;
  }
  const auto zones = zones_in_place(packing.scene, packing.domain, packing.spheres, packing.classes);
  ASSERT_TRUE(zones);
  EXPECT_TRUE(zones->misplaced.empty());
  ASSERT_TRUE(packing.scene.zones[0].mesh);
  EXPECT_EQ(packing.scene.zones[0].mesh->sha256.size(), 1u) << "a result names the file by its digest";
  std::vector<std::uint32_t> exchanged = packing.classes;
  std::swap(exchanged.front(), exchanged.back());
  EXPECT_EQ(zones_in_place(packing.scene, packing.domain, packing.spheres, exchanged)->misplaced,
            (std::vector<std::uint64_t>{0, packing.spheres.size() - 1}));
}

TEST(Zones, ASurfaceLiesInTheContainerAndInNoOtherZone) {
  const Folder folder;
  const auto zone = [&](const char* name, const Bounds<3>& cube) {
    return fmt::format("[[zone]]\nmesh = \"{}\"\ndiameter = 0.5\n",
                       written_mesh(folder, name, mesh_of_box(cube)).string());
  };
  const std::string inside = zone("a.off", {Vector<3>(-2, -2, 6), Vector<3>(2, 2, 14)});
  const auto says = [&](const std::string& zones, const std::string& what) {
    EXPECT_NE(refusal(std::string(cylinder) + zones).find(what), std::string::npos)
        << refusal(std::string(cylinder) + zones);
  };
  says(inside + zone("b.off", {Vector<3>(-1, -1, 13), Vector<3>(1, 1, 17)}), "in another zone");
  says(inside + zone("c.off", {Vector<3>(2.5, -1, 8), Vector<3>(6.5, 1, 12)}), "outside of the container");
  says(inside + zone("d.off", {Vector<3>(20, 20, 8), Vector<3>(24, 22, 12)}),
       "lies outside of the container");
  says(inside + "[[zone]]\nplace = \"z > 16\"\ndiameter = 0.5\n", "all surfaces");
  EXPECT_NE(refusal("container = { kind = \"periodic\", size = [9, 9, 20] }\n" +
                    zone("e.off", {Vector<3>(2, 2, 6), Vector<3>(6, 6, 14)}))
                .find("without periods"),
            std::string::npos);
}

TEST(Zones, PhasesOfMfixHaveTheirDensities) {
  const Folder folder;
  const Packing packing =
      run(build(scene_of(std::string(cylinder) +
                         "spheres = { diameter = 2, material_density = 2000 }\n[[zone]]\nplace = \"z < 8\"\n"
                         "diameter = 1\nmaterial = \"sand\"\nmaterial_density = 2600\n")),
          {});
  write_export(packing, output_of("mfix"), folder / "particle_input.dat");
  const std::string text = text_of(folder / "particle_input.dat");
  for (const char* line : {"\nPhase_ID         T\n", "\nDensity          T\n",
                           "Phase_ID   Diameter   Density\n", " 1 0.001 2600\n", " 2 0.002 2000\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
  EXPECT_EQ(import_packing(folder / "particle_input.dat").packing.spheres.size(), packing.spheres.size());
}

TEST(Zones, HintsSayOfWhichZone) {
  const Plan plan = build(scene_of(std::string(cylinder) +
                                   "spheres = { diameter = 2, count = 3 }\n[[zone]]\nplace = \"z < 8\"\n"
                                   "diameter = 1\ncount = 5\nmaterial = \"sand\"\n"));
  const auto has = [&](const std::string& beginning) {
    return std::ranges::any_of(plan.hints,
                               [&](const std::string& hint) { return hint.starts_with(beginning); });
  };
  EXPECT_TRUE(has("sand: 5 spheres will float"));
  EXPECT_TRUE(has("rest: 3 spheres will float"));
}

TEST(Zones, APeriodicBoxIsCutAtThePlaneAndWhereItBegins) {
  const Packing packing =
      run(build(scene_of("container = { kind = \"periodic\", size = [10, 10, 12] }\n"
                         "spheres = { diameter = 2 }\n[[zone]]\nplace = \"z > 7\"\ndiameter = 1\n")),
          {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_TRUE(is_certified(packing));
  EXPECT_GE(extent_of(packing, 0).first, 7);
  EXPECT_LE(extent_of(packing, 0).second, 12);
  EXPECT_LE(extent_of(packing, 1).second, 7);
  EXPECT_GE(extent_of(packing, 1).first, 0);
  // Across the other axes the box still repeats itself.
  EXPECT_LT(extent_of(packing, 0, 0).first, 0);
}

TEST(Zones, OneSeedGivesOnePackingForAnyNumberOfThreads) {
  const Plan plan = build(scene_of(std::string(cylinder) +
                                   "[[zone]]\nplace = \"z < 6\"\ndiameter = 1.5\ncount = 30\n"
                                   "[[zone]]\nplace = [\"z > 6\", \"z < 12\"]\ndiameter = 2\ncount = 10\n"));
  const Packing one = run(plan, {.threads = 1});
  EXPECT_EQ(run(plan, {.threads = 4}).spheres, one.spheres);
  EXPECT_NE(run(plan, {.seed = 2}).spheres, one.spheres);
  EXPECT_EQ(one.spheres.size(), 40u);
}

TEST(Zones, AResultHoldsThem) {
  const Folder folder;
  Scene scene = scene_of(std::string(cylinder) +
                         "spheres = { diameter = 2, count = 5 }\n"
                         "[[zone]]\nplace = \"z < 8\"\ndiameter = 1\ncount = 20\nmaterial = \"sand\"\n");
  const Packing packing = run(build(scene), {});
  for (const bool as_array : {false, true}) {
    const auto target = folder / (as_array ? "array" : "text");
    const WrittenPacking written = write_packing(packing, target, {.as_array = as_array});
    EXPECT_TRUE(written.certificate.certified);
    const Packing back = read_packing(target);
    EXPECT_EQ(back.classes, packing.classes);
    EXPECT_EQ(back.spheres, packing.spheres);
    EXPECT_EQ(run(build(back.scene), {}).spheres, packing.spheres) << "the scene as run makes it again";
  }
  const std::string csv = text_of(folder / "text" / "spheres.csv");
  EXPECT_NE(csv.find("x,y,z,r,class,material\n"), std::string::npos);
  EXPECT_NE(csv.find(",0.5,sand,sand\n"), std::string::npos);
  EXPECT_NE(csv.find(",1,rest,\n"), std::string::npos);
  EXPECT_NE(text_of(folder / "text" / "report.json").find("\"material\": \"sand\""), std::string::npos);
  EXPECT_NE(explain(build(scene)).find("zone       sand, z < 8: 20"), std::string::npos);
}

TEST(Zones, ALayerThatHoldsNothingIsFull) {
  const Packing packing = run(build(scene_of("container = { kind = \"box\", size = [10, 10, 20] }\n"
                                             "spheres = { bed = \"poured\" }\n"
                                             "[[zone]]\nplace = \"z < 8\"\ndiameter = 1.5\n"
                                             "[[zone]]\nplace = [\"z > 8\", \"z < 8.1\"]\ndiameter = 2.5\n")),
                              {});
  EXPECT_EQ(std::ranges::count(packing.classes, 1u), 0);
  EXPECT_EQ(packing.outcome, Outcome::full) << packing.reason;
}

TEST(Zones, ClassesOfAFileAreThoseOfTheScene) {
  const Folder folder;
  const Packing packing = run(
      build(scene_of(std::string(cylinder) + "[[zone]]\nplace = \"z < 8\"\ndiameter = 1\ncount = 3\n")), {});
  write_packing(packing, folder / "out", {.view = false});
  const std::string csv = text_of(folder / "out" / "spheres.csv");
  folder.write("out/spheres.csv", csv.substr(0, csv.rfind("zone 1")) + "banana,\n");
  const std::string error = error_of([&] { read_packing(folder / "out"); }).what();
  EXPECT_NE(error.find("a class \"banana\", and the scene has only zone 1"), std::string::npos) << error;
}

TEST(Zones, RefuseWhatCannotBeMeant) {
  const auto says = [](const std::string& text, const std::string& line) {
    const std::string error = refusal(text);
    EXPECT_NE(error.find(line), std::string::npos) << error;
  };
  const std::string in_cylinder(cylinder);
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\ndiameter = 1\n[[zone]]\nplace = \"z > 7\"\ndiameter = 2\n",
       "overlap");
  says(in_cylinder + "[[zone]]\nplace = \"z > 30\"\ndiameter = 1\n", "nothing of the container");
  says(in_cylinder + "[[zone]]\nplace = \"x < 0\"\ndiameter = 1\n", "a cylinder is cut across its axis");
  says(in_cylinder + "[[zone]]\nplace = \"z = 8\"\ndiameter = 1\n", "write < or >");
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\n",
       "[[zone]] 1 needs exactly one of \"radius\", \"diameter\"");
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\ndiametr = 1\n", "unknown key \"diametr\" in [[zone]] 1");
  says(in_cylinder + "[[zone]]\ndiameter = 1\n",
       "needs exactly one of \"place\", \"solid\", \"chamber\", \"mesh\"");
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\nsolid = \"a\"\ndiameter = 1\n", "exclude each other");
  says(in_cylinder + "[[zone]]\nchamber = 1\ndiameter = 1\n", "is one of a mesh");
  says(in_cylinder +
           "spheres = { diameter = 1, bed = \"poured\" }\n[[zone]]\nplace = \"x < 0\"\ndiameter = 1\n",
       "planes across gravity");
  says(in_cylinder + "spheres = { bed = \"poured\" }\n[[zone]]\nplace = \"z > 8\"\ndiameter = 1\n",
       "nothing lies under");
  says(in_cylinder + "spheres = { diameter = 1, gap = 0.1 }\n[[zone]]\nplace = \"z < 8\"\ndiameter = 1\n",
       "\"wall_gap\" of 0.05");
  says(in_cylinder + "spheres = { scale = 2 }\n[[zone]]\nplace = \"z < 8\"\ndiameter = 1\n", "\"scale\" in");
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\nmass = 1\ndiameter = 1\n", "\"mass\" in [[zone]] 1 needs");
  says(in_cylinder +
           "spheres = { diameter = 1, bed = \"poured\", height = 5 }\n[[zone]]\nplace = \"z < 8\"\n"
           "diameter = 1\n",
       "ends within the layers below it");
  says(in_cylinder + "spheres = { count = 5 }\n[[zone]]\nplace = \"z < 8\"\ndiameter = 1\n",
       "lie in no zone");
  says("container = { kind = \"sphere\", radius = 5 }\n[[zone]]\nplace = \"z < 0\"\ndiameter = 1\n",
       "no plane cuts a sphere");
  says(in_cylinder + "[[zone]]\nplace = \"z < 8\"\ndiameter = 30\n", "zone 1: ");
}

TEST(Zones, ARoundContainerHasLayers) {
  const Packing packing =
      run(build(scene_of("container = { kind = \"sphere\", radius = 5 }\nspheres = { bed = \"poured\" }\n"
                         "[[zone]]\nplace = \"z < -1\"\ndiameter = 1\n")),
          {});
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_LE(extent_of(packing, 0).second, -1 + 1e-2);
  EXPECT_TRUE(is_certified(packing));
}

TEST(Zones, PartsOfEveryDomainAddUp) {
  const Box box{Vector<3>(1, 2, 3), Vector<3>(4, 5, 6), {false, false, true}};
  const Revolved hopper{.profile = {{0, 0}, {1, 0}, {3, 4}, {3, 9}, {0, 9}}};
  for (const Domain& domain : {Domain(box), Domain(Cylinder{.radius = 2, .height = 7}),
                               Domain(Cylinder{.radius = 2, .height = 7, .periodic = true}), Domain(hopper),
                               Domain(mesh_of_box({Vector<3>(0, 0, 0), Vector<3>(3, 4, 8)}))}) {
    const double volume = volume_of(domain);
    for (const double at : {3.5, 5.0}) {
      const auto below = part_below(domain, Vector<3>::UnitZ(), at),
                 above = part_below(domain, -Vector<3>::UnitZ(), -at);
      ASSERT_TRUE(below && above) << name_of(domain);
      EXPECT_NEAR(volume_of(*below) + volume_of(*above), volume, 1e-12 * volume) << name_of(domain);
      EXPECT_NEAR(bounds_of(*below).upper[2], at, 1e-12);
      EXPECT_NEAR(bounds_of(*above).lower[2], at, 1e-12);
    }
    EXPECT_FALSE(part_below(domain, Vector<3>::UnitZ(), -1));
    EXPECT_NEAR(volume_of(*part_below(domain, Vector<3>::UnitZ(), 100)), volume, 1e-12 * volume);
  }
}

}  // namespace zones_test
}  // namespace bernal

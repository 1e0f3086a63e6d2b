#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

#include <fmt/format.h>

#include "bernal/mesh_files/mesh_packing.hpp"
#include "check.hpp"
#include "mesh_scenes.hpp"

namespace bernal::testing {
namespace mesh_command_test {

namespace fs = std::filesystem;

constexpr const char* few_spheres = R"(unit = "mm"
[container]
kind = "cylinder"
radius = 1.2
height = 2.5
[spheres]
count = 5
diameter = 1
)";

struct Packed {
  Folder folder;
  Packed() {
    const Ended packed = bernal({"pack", folder.write("scene.toml", few_spheres).string(), "-o", out()});
    EXPECT_EQ(packed.status, 0) << packed.err;
  }
  std::string out() const { return folder / "out"; }
};

TEST(MeshCommand, WritesEveryFormatAndStatesTheQuality) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  for (const MeshFormat& format : mesh_formats()) {
    if (format.is_surface) continue;
    const std::string file = result.folder / ("bed" + format.ending);
    const Ended ended =
        bernal({"mesh", result.out(), "--to", format.name, "-o", file, "--regions", "all", "--json"});
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_TRUE(fs::exists(file)) << file;
    const auto report = nlohmann::json::parse(ended.out);
    EXPECT_EQ(report["spheres"], 5);
    EXPECT_GE(report["least_sicn"], 0.1);
    EXPECT_EQ(report["worst"].size(), 10U);
    EXPECT_EQ(report["worst"][0]["sicn"], report["least_sicn"]);
    std::size_t cells = 0;
    for (const auto& count : report["histogram"]) cells += count.get<std::size_t>();
    EXPECT_EQ(report["tetrahedra"], cells);
    // Chords cut off about one per cent of spheres, and as much of the cylinder.
    EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 0.01);
  }
  for (const char* name : {"points", "faces", "owner", "neighbour", "boundary", "cellZones"})
    EXPECT_TRUE(fs::exists(fs::path(result.folder / "constant/polyMesh") / name)) << name;
}

TEST(MeshCommand, ElementsOfSecondOrderHoldTheStatedPorosity) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const Ended ended = bernal({"mesh", result.out(), "--to", "abaqus", "-o", result.folder / "bed.inp",
                              "--contact", "gap", "--order", "2", "--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto report = nlohmann::json::parse(ended.out);
  EXPECT_GT(report["least_curved_sicn"], 0);
  EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 1e-4);
}

TEST(MeshCommand, LayersAreRegionsOfTheStatedVolumes) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Folder folder;
  const Ended packed = bernal(
      {"pack", folder.write("scene.toml", std::string(layered_spheres)).string(), "-o", folder / "out"});
  ASSERT_EQ(packed.status, 0) << packed.err;
  const auto mesh = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "mesh", folder / "out", "--to", "abaqus", "-o", folder / "rve.inp", "--contact", "gap", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = bernal(words);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  };
  const auto report = mesh({"--regions", "all", "--order", "2"});
  EXPECT_GE(report["least_curved_sicn"], 0.1);
  std::map<std::string, nlohmann::json> groups;
  for (const auto& group : report["groups"]) groups[group["name"]] = group;
  ASSERT_EQ(groups.size(), 3U);
  for (const char* name : {"fluid", "layer_core", "layer_thin_coat"}) {
    ASSERT_TRUE(groups.contains(name)) << name;
    EXPECT_NEAR(groups[name]["volume"].get<double>() / groups[name]["stated_volume"].get<double>(), 1, 2e-4);
  }
  const double ball = 4 * 3.14159265358979 / 3 * 12;
  EXPECT_NEAR(groups["layer_core"]["stated_volume"].get<double>(), ball * 0.9 * 0.9 * 0.9, 1e-9);
  EXPECT_TRUE(fs::exists(folder / "rve.inp"));
  EXPECT_EQ(mesh({})["groups"].size(), 1U);  // the fluid alone
  const auto part = mesh({"--regions", "all", "--cut", "x = 1..4, y = 0 mm..3 mm, z = 2..4"});
  EXPECT_NEAR(part["domain_volume"].get<double>(), 18, 1e-12);
  EXPECT_GT(part["clipped"], 0);
  double stated = 0;
  for (const auto& group : part["groups"]) stated += group["stated_volume"].get<double>();
  EXPECT_NEAR(stated, 18, 1e-9);
}

TEST(MeshCommand, PrismsStandInTheFluid) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const auto mesh = [&](const std::string& format, const std::vector<std::string>& more) {
    static const std::map<std::string, std::string> names = {
        {"openfoam", "case"}, {"vtu", "bed.vtu"}, {"gmsh", "bed.msh"}, {"abaqus", "bed.inp"}};
    std::vector<std::string> words = {"mesh", result.out(), "--to",
                                      format, "-o",         result.folder / names.at(format)};
    words.insert(words.end(), more.begin(), more.end());
    return bernal(words);
  };
  const auto report_of = [&](const std::string& format, std::vector<std::string> more) {
    more.emplace_back("--json");
    const Ended ended = mesh(format, more);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  };
  const auto without = report_of("vtu", {});
  EXPECT_EQ(without["prisms"], 0);
  for (const char* format : {"openfoam", "vtu", "gmsh"}) {
    const auto with = report_of(format, {"--prisms", "3", "--prism-height", "0.08", "--prism-growth", "1.3"});
    EXPECT_GT(with["prisms"], 1000) << format;
    EXPECT_GT(with["prism_ends"], 0);
    EXPECT_GT(with["prism_share"], 0.4);
    EXPECT_LE(with["mean_prism_height"], 0.04 * (1 + 1e-12));
    EXPECT_GT(with["least_scaled_jacobian"], 0.2);
    EXPECT_GE(with["least_sicn"], 0.1);
    // They belong to the fluid, whose surface stays, but for shorter edges on walls.
    EXPECT_NEAR(with["meshed_porosity"].get<double>(), with["porosity"].get<double>(), 0.01);
    EXPECT_EQ(with["porosity"], without["porosity"]);
  }
  expect_refused_in_one_line(mesh("abaqus", {"--prisms", "3"}), {"prisms", "abaqus"});
  expect_refused_in_one_line(mesh("gmsh", {"--prisms", "3", "--regions", "all"}), {"prisms", "fluid"});
  expect_refused_in_one_line(mesh("gmsh", {"--prisms", "3", "--order", "2"}), {"prisms", "order"});
}

TEST(MeshCommand, FilletsHoldTheStatedPorosity) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const auto mesh = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"mesh",      result.out(), "--to",
                                      "vtu",       "-o",         result.folder / "bed.vtu",
                                      "--contact", "fillet",     "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = bernal(words);
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  };
  const auto report = mesh({"--regions", "all"});
  EXPECT_GT(report["necks"], 0);
  EXPECT_EQ(report["cut_fillets"], 0);
  EXPECT_GE(report["least_sicn"], 0.1);
  EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 0.01);
  EXPECT_NEAR(report["contact_area"].get<double>(),
              report["necks"].get<double>() * 3.14159265358979 * 0.1 * 0.1, 1e-9);
  // A waist of 0.2 radii is seen under more than 12 degrees.
  EXPECT_LT(mesh({"--bridge-angle", "10"})["contact_area"], report["contact_area"]);
  expect_refused_in_one_line(bernal({"mesh", result.out(), "--to", "gmsh", "-o", result.folder / "a.msh",
                                     "--bridge-angle", "10", "--bridge-radius", "0.2"}),
                             {"--bridge-radius", "--bridge-angle"});
}

/// How many triangles of an OBJ file have each edge, and the names of its groups.
struct ReadSurface {
  std::map<std::pair<int, int>, int> edges;
  std::vector<std::string> groups;
  explicit ReadSurface(const std::string& file) {
    std::ifstream in(file);
    for (std::string word; in >> word;) {
      std::string name;
      std::array<int, 3> c{};
      if (word == "g" && in >> name) groups.push_back(name);
      if (word == "f" && in >> c[0] >> c[1] >> c[2])
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(c[k], c[(k + 1) % 3])];
    }
  }
};

TEST(MeshCommand, PolyMeshHasZonesOfFacesAndNothingOfAnEarlierMesh) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const fs::path folder = result.folder / "constant/polyMesh";
  const auto mesh = [&](const std::string& regions) {
    const Ended ended = bernal(
        {"mesh", result.out(), "--to", "openfoam", "-o", result.folder / "bed.foam", "--regions", regions});
    EXPECT_EQ(ended.status, 0) << ended.err;
  };
  mesh("all");
  const std::string zones = text_of(folder / "faceZones");
  for (const char* name : {"surface_of_spheres", "necks"})
    EXPECT_NE(zones.find(fmt::format("    {}\n    {{\n        type            faceZone;", name)),
              std::string::npos)
        << name;
  for (const char* name : {"cellLevel", "pointZones", "points.gz", "mine"})
    std::ofstream(folder / name) << "x";
  mesh("fluid");  // which has no faces between regions
  for (const char* name : {"cellLevel", "pointZones", "points.gz", "faceZones"})
    EXPECT_FALSE(fs::exists(folder / name)) << name;
  EXPECT_TRUE(fs::exists(folder / "mine"));
  EXPECT_TRUE(fs::exists(folder / "points"));
}

TEST(MeshCommand, SnappyNeedsNoMesherForItsClosedSurface) {
  const Packed result;
  const std::string folder = result.folder / "case";
  const auto mesh = [&] {
    const Ended ended = bernal({"mesh", result.out(), "--to", "snappy", "-o", folder + "/bed.foam",
                                "--prisms", "2", "--mesh-size", "0.6", "--json"});
    EXPECT_EQ(ended.status, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  };
  const auto report = mesh();
  EXPECT_TRUE(report["is_surface"]);
  EXPECT_EQ(report["tetrahedra"], 0);
  EXPECT_GT(report["necks"], 0);
  EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 0.01);
  const ReadSurface surface(folder + "/constant/triSurface/bed.obj");
  EXPECT_EQ(2 * surface.edges.size(), 3 * report["triangles"].get<std::size_t>());
  for (const auto& [ends, triangles] : surface.edges) EXPECT_EQ(triangles, 2);
  const std::string dictionary = text_of(folder + "/system/snappyHexMeshDict");
  for (const std::string& group : surface.groups) {
    EXPECT_NE(dictionary.find(group + " { name " + group + "; }"), std::string::npos) << group;
    EXPECT_EQ(dictionary.find(group + " { nSurfaceLayers 2; }") != std::string::npos,
              group == "surface_of_spheres" || group == "side")
        << group;
  }
  EXPECT_EQ(surface.groups.size(), 5U);  // spheres, necks, side, floor, lid
  // A case is the user's where it has been changed: what every program reads is left alone.
  std::ofstream(folder + "/system/controlDict") << "mine";
  mesh();
  EXPECT_EQ(text_of(folder + "/system/controlDict"), "mine");
  expect_refused_in_one_line(
      bernal({"mesh", result.out(), "--to", "snappy", "-o", folder + "/bed.foam", "--regions", "all"}),
      {"snappy", "--regions all"});
  expect_refused_in_one_line(
      bernal({"mesh", result.out(), "--to", "abaqus", "-o", folder + "/bed.inp", "--prisms", "2"}),
      {"abaqus", "prisms"});
}

/// A mesher that ends by an assertion of its own as often as asked, and works then.
void write_faulty_tetgen(const Folder& folder, int faults) {
  const std::string left = (folder / "faults").string();
  folder.write("faults", fmt::format("{}\n", faults));
  folder.write("tetgen", fmt::format("#!/bin/sh\nn=$(cat {0})\n"
                                     "[ \"$n\" -eq 0 ] || {{ echo $((n - 1)) > {0}; kill -ABRT $$; }}\n"
                                     "exec /usr/bin/tetgen \"$@\"\n",
                                     left));
  fs::permissions(folder / "tetgen", fs::perms::owner_all);
}

TEST(MeshCommand, AMesherThatFailsByItselfIsAskedAgain) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const Folder programs;
  const std::string path = std::getenv("PATH");
  setenv("PATH", (programs.path().string() + ":" + path).c_str(), 1);
  for (const int faults : {1, 4}) {
    write_faulty_tetgen(programs, faults);
    const Ended ended =
        bernal({"mesh", result.out(), "--to", "vtu", "-o", result.folder / "bed.vtu", "--mesh-size", "0.9"});
    if (faults == 1) {
      EXPECT_EQ(ended.status, 0) << ended.err;
    } else {
      expect_refused_in_one_line(ended, {"TetGen made no mesh", "signal 6"});
    }
  }
  setenv("PATH", path.c_str(), 1);
}

TEST(MeshCommand, SaysWhatTheMeshIsOf) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Packed result;
  const auto meshed = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"mesh",  result.out(), "--contact",   "shrink",
                                      "--gap", "0.05",       "--mesh-size", "0.9"};
    words.insert(words.end(), more.begin(), more.end());
    return bernal(words);
  };
  // A folder is a case of OpenFOAM; its points are in the unit that is asked for.
  const std::string folder = result.folder / "case";
  const Ended ended = meshed({"--to", "openfoam", "-o", folder, "--unit", "m"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("5 smaller than packed"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("as packed"), std::string::npos);
  EXPECT_NE(ended.err.find("floor (patch)"), std::string::npos) << ended.err;
  EXPECT_TRUE(fs::exists(fs::path(folder) / "case.foam"));
  ASSERT_EQ(meshed({"--to", "snappy", "-o", result.folder / "run1.5"}).status, 0);
  EXPECT_TRUE(fs::exists(result.folder / "run1.5/run1.5.foam"));
  std::ifstream points(fs::path(folder) / "constant/polyMesh/points");
  double largest = 0;
  for (std::string line; std::getline(points, line);) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(line.c_str(), "(%lf %lf %lf)", &x, &y, &z) == 3) largest = std::max(largest, z);
  }
  EXPECT_NEAR(largest, 2.5e-3, 1e-12);
  expect_refused_in_one_line(meshed({"--to", "vtu", "-o", result.folder / "bed.msh"}), {".vtu", "gmsh"});
  for (const char* name : {"bed.txt", "bed.VTU", "bed"})
    expect_refused_in_one_line(meshed({"--to", "vtu", "-o", result.folder / name}), {".vtu", name});
  expect_refused_in_one_line(
      meshed({"--to", "vtu", "-o", result.folder / "bed.vtu", "--prism-height", "0.2"}), {"--prism-height"});
  expect_refused_in_one_line(meshed({"--to", "vtu", "-o", result.folder / "bed.vtu", "--unit", "parsec"}),
                             {"parsec"});
  expect_refused_in_one_line(meshed({"--to", "vtu", "-o", result.folder / "bed.vtu", "--gap-size", "4 mm"}),
                             {"4 mm is not a number"});
  // So is a packing that ended before it had what was asked.
  const std::string many = std::string(few_spheres).replace(std::string(few_spheres).find("= 5"), 3, "= 50");
  EXPECT_EQ(
      bernal({"pack", result.folder.write("many.toml", many).string(), "-o", result.folder / "many"}).status,
      3);
  const Ended full = bernal(
      {"mesh", result.folder / "many", "--to", "vtu", "-o", result.folder / "bed.vtu", "--mesh-size", "0.9"});
  EXPECT_NE(full.err.find("not what was asked for: full"), std::string::npos) << full.err;
}

TEST(MeshCommand, RefusesWhatItCannotWrite) {
  const Packed result;
  const std::string file = result.folder / "bed.foam";
  expect_refused_in_one_line(bernal({"mesh", result.out(), "--to", "openfoam", "-o", file, "--order", "2"}),
                             {"openfoam", "second order"});
  expect_refused_in_one_line(bernal({"mesh", result.out(), "--to", "openfaom", "-o", file}), {"openfoam"});
  expect_refused_in_one_line(bernal({"mesh", result.out(), "--to", "gmsh", "-o", "-"}), {"-o"});
  expect_refused_in_one_line(bernal({"mesh", result.out(), "--to", "openfoam", "-o", file, "--contact",
                                     "fillet", "--bridge-radius", "0.05"}),
                             {"at least 0.1"});
  expect_refused_in_one_line(
      bernal({"mesh", result.out(), "--to", "gmsh", "-o", result.out() + "/spheres.csv"}), {"spheres.csv"});
  EXPECT_FALSE(fs::exists(file));
}

}  // namespace mesh_command_test
}  // namespace bernal::testing

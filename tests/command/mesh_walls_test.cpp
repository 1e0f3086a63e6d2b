// Walls of beds in CAD parts, some with names of their own, and parts that are cut out of packings.
#include <filesystem>

#include <fmt/format.h>

#include "check.hpp"
#include "mesh_scenes.hpp"

namespace bernal::testing {
namespace mesh_walls_test {

namespace fs = std::filesystem;

struct PackedHopper {
  Folder folder;
  PackedHopper() {
    const std::string scene = fmt::format(R"(unit = "m"
[container]
kind = "mesh"
file = "{}/meshes/hopper.stl"
unit = "m"
[spheres]
count = 8
diameter = 0.24
)",
                                          BERNAL_DATA);
    const Ended packed = bernal({"pack", folder.write("scene.toml", scene).string(), "-o", out()});
    EXPECT_EQ(packed.status, 0) << packed.err;
  }
  std::string out() const { return folder / "out"; }
};

/// What the file "boundary" of a polyMesh says of a patch: its type and its number of faces.
std::pair<std::string, int> patch_in(const std::string& boundary, const std::string& name) {
  const auto after = [&](const char* word, std::size_t from) {
    const std::size_t begin =
        boundary.find_first_not_of(' ', boundary.find(word, from) + std::string_view(word).size());
    return boundary.substr(begin, boundary.find(';', begin) - begin);
  };
  const std::size_t at = boundary.find("    " + name + "\n");
  if (at == std::string::npos) return {};
  return {after("type", at), std::stoi(after("nFaces", at))};
}

TEST(MeshWalls, InletAndOutletOfACadPartArePatchesWithoutPrisms) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const PackedHopper result;
  const Ended ended = bernal({"mesh", result.out(), "--to", "openfoam", "-o", result.folder / "case/bed.foam",
                              "--patches", "outlet: z = 0, inlet: z=140 cm", "--prisms", "1", "--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_GE(nlohmann::json::parse(ended.out)["least_sicn"], 0.1);
  const std::string boundary = text_of(result.folder / "case/constant/polyMesh/boundary");
  for (const char* name : {"inlet", "outlet"}) {
    const auto [type, faces] = patch_in(boundary, name);
    EXPECT_EQ(type, "patch") << name;
    EXPECT_GT(faces, 10) << name;
  }
  EXPECT_EQ(patch_in(boundary, "walls").first, "wall");
}

TEST(MeshWalls, CadPartsKeepTheirVolumeInTheMesh) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const PackedHopper result;
  for (const char* contact : {"bridge", "gap"}) {
    const Ended ended = bernal({"mesh", result.out(), "--to", "gmsh", "-o", result.folder / "bed.msh",
                                "--regions", "all", "--contact", contact, "--json"});
    ASSERT_EQ(ended.status, 0) << ended.err;
    const auto report = nlohmann::json::parse(ended.out);
    EXPECT_GE(report["least_sicn"], 0.1);
    double volume = 0;
    for (const auto& group : report["groups"]) volume += group["volume"].get<double>();
    EXPECT_NEAR(volume, 0.8125, 1e-7);  // corners of the file are in single precision
    EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 0.01);
  }
}

TEST(MeshWalls, PlanesWithoutAWallAndTakenNamesAreRefused) {
  const PackedHopper result;
  const auto mesh = [&](const char* patches) {
    return bernal(
        {"mesh", result.out(), "--to", "snappy", "-o", result.folder / "case", "--patches", patches});
  };
  expect_refused_in_one_line(mesh("inlet: z = 1.3"), {"z = 1.3", "inlet", "0.1 off"});
  expect_refused_in_one_line(mesh("inlet: x + y = 3"), {"no flat wall is parallel"});
  expect_refused_in_one_line(mesh("inlet: z < 1"), {"--patches", "inlet: z = 0"});
  expect_refused_in_one_line(mesh("z = 0"), {"--patches"});
  expect_refused_in_one_line(mesh("inlet: z = nonsense"), {"nonsense"});
  expect_refused_in_one_line(mesh("walls: z = 0"), {"walls", "another name"});
  expect_refused_in_one_line(mesh("in let: z = 0"), {"in let"});
  expect_refused_in_one_line(mesh("Fluid: z = 0"), {"Fluid", "another name"});
  expect_refused_in_one_line(mesh("all: z = 0"), {"all", "another name"});
  expect_refused_in_one_line(mesh("in: z = 0, IN: z = 1.4"), {"in", "IN", "case"});
  expect_refused_in_one_line(mesh("a: z = 0, b: z = 0"), {"a and b", "same wall"});
  expect_refused_in_one_line(mesh("1: z = 0"), {"begins with a letter"});
  expect_refused_in_one_line(mesh(""), {"--patches", "empty"});
}

constexpr std::string_view tetrahedron = R"(OFF
4 4 0
1 1 1
4 1 1
1 4 1
1 1 4
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
)";

TEST(MeshWalls, ConvexPartsAreCutOut) {
  if (!has_tetgen()) GTEST_SKIP() << "tetgen is not installed";
  const Folder folder;
  const Ended packed = bernal(
      {"pack", folder.write("scene.toml", std::string(layered_spheres)).string(), "-o", folder / "out"});
  ASSERT_EQ(packed.status, 0) << packed.err;
  const auto mesh = [&](const std::string& part) {
    return bernal({"mesh", folder / "out", "--to", "gmsh", "-o", folder / "part.msh", "--contact", "gap",
                   "--regions", "all", "--order", "2", "--json", "--cut", part});
  };
  const auto expect_volume = [&](const std::string& part, double volume) {
    const Ended ended = mesh(part);
    ASSERT_EQ(ended.status, 0) << ended.err;
    const auto report = nlohmann::json::parse(ended.out);
    EXPECT_NEAR(report["domain_volume"].get<double>(), volume, 1e-9);
    EXPECT_GT(report["clipped"], 0);
    double stated = 0, meshed = 0;
    for (const auto& group : report["groups"]) {
      stated += group["stated_volume"].get<double>();
      meshed += group["volume"].get<double>();
    }
    EXPECT_NEAR(stated, volume, 1e-9);
    EXPECT_NEAR(meshed, volume, 1e-9);
    EXPECT_NEAR(report["porosity"].get<double>(), report["meshed_porosity"].get<double>(), 1e-3);
    EXPECT_LE(report["packed_porosity"].get<double>(), report["porosity"].get<double>() + 1e-12);
    EXPECT_GT(report["packed_porosity"].get<double>(), 0.3);
  };
  expect_volume("0.6 x + 0.8 z = 1..3, -0.8 x + 0.6 z = -1..1, y = 0..3", 12);
  expect_volume(folder.write("part.off", std::string(tetrahedron)).string(), 4.5);
  constexpr std::string_view corners = "OFF\n4 3 0\n0 0 0\n3 0 0\n0 3 0\n0 0 3\n";
  constexpr std::string_view faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n";
  const std::string open = fmt::format("{}{}", corners, faces);
  const std::string dented =
      fmt::format("OFF\n5 6 0\n{}0.3 0.3 0.3\n{}3 1 2 4\n3 2 3 4\n3 3 1 4\n", corners.substr(10), faces);
  for (const std::string& part :
       {std::string("x = 1..4"), std::string("x = 1..4, x = 1..4, z = 2..4"), std::string("x = 1..4, y = 2"),
        std::string("x = 1..4, y = 1..4, z = 0..5, x > 6"), folder.write("open.off", open).string(),
        folder.write("dented.off", dented).string()})
    expect_refused_in_one_line(mesh(part), {"cut"});
  expect_refused_in_one_line(mesh((folder / "absent.stl").string()), {"absent.stl"});
  expect_refused_in_one_line(mesh(""), {"--cut", "empty"});
  expect_refused_in_one_line(mesh("x = 0..3000, y = 0..3000, z = 0..3000"), {"--cut", "3000", "unit"});
}

}  // namespace mesh_walls_test
}  // namespace bernal::testing

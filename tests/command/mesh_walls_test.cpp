// Walls of beds in CAD parts that have names of their own.
#include <filesystem>

#include <fmt/format.h>

#include "check.hpp"

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
  if (!fs::exists("/usr/bin/tetgen")) GTEST_SKIP() << "tetgen is not installed";
  const PackedHopper result;
  const Ended ended = bernal({"mesh", result.out(), "--to", "openfoam", "-o", result.folder / "case/bed.foam",
                              "--patches", "outlet: z = 0, inlet: z=1.4", "--prisms", "1", "--json"});
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
}

}  // namespace mesh_walls_test
}  // namespace bernal::testing

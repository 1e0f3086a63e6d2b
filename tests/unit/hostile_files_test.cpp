// Files that crash, stop or mislead assimp 5.2.5, or take all memory there: each ends in one line with the
// file's name, or as the part that it is.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "support/cad_formats.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace hostile_files_test {

class HostileFile : public ::testing::Test {
 protected:
  /// What is said of it, less the name of the file in front, which must be there.
  std::string refusal(std::string_view name, std::string_view content) {
    const auto file = folder.write(name, content);
    std::string said;
    try {
      read_mesh({.file = file});
      ADD_FAILURE() << name << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_mesh);
      said = error.what();
    }
    const std::string path = file.string() + ": ";
    EXPECT_TRUE(said.starts_with(path)) << said;
    EXPECT_EQ(said.find_first_of("\n\r\x1b"), std::string::npos) << said;
    EXPECT_GT(said.size(), path.size());
    return said.substr(std::min(path.size(), said.size()));
  }

  /// A model in XML with these resources and this to build, as a 3MF.
  std::string refusal_of_3mf(std::string_view resources, std::string_view build) {
    return refusal(
        "part.3mf",
        test::archived_3mf(fmt::format(
            R"(<?xml version="1.0"?><model unit="millimeter" xmlns=)"
            R"("http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>{}</resources>)"
            R"(<build>{}</build></model>)",
            resources, build)));
  }

  static std::string object_3mf(int id, std::string_view mesh_or_components) {
    return fmt::format(R"(<object id="{}" type="model">{}</object>)", id, mesh_or_components);
  }
  static std::string components(std::initializer_list<int> ids) {
    std::string xml = "<components>";
    for (const int id : ids) xml += fmt::format(R"(<component objectid="{}"/>)", id);
    return xml + "</components>";
  }
  static std::string mesh_3mf(int last) {
    return fmt::format(
        R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/>)"
        R"(<vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>)"
        R"(<triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="{}"/>)"
        R"(</triangles></mesh>)",
        last);
  }
  static constexpr const char* item_1 = R"(<item objectid="1"/>)";

  testing::Folder folder;
};

constexpr const char* damaged =
    "cannot be read: a zip archive that is cut short or damaged; export it again, or as STL";

TEST_F(HostileFile, FormatsThatNobodyTested) {
  for (const char* name :
       {"a.ase", "a.raw", "a.x", "a.3ds", "a.lwo", "a.nff", "a.mdl", "a.irr", "part", "a.zae"})
    EXPECT_NE(refusal(name, "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*MESH {\n*MESH_FACE_LIST")
                  .find("none of .stl"),
              std::string::npos)
        << name;
}

TEST_F(HostileFile, OtherFormatsUnderATestedName) {
  refusal("a.obj", "*3DSMAX_ASCIIEXPORT 200\n*GEOMOBJECT {\n*MESH {\n*MESH_FACE_LIST");
  refusal("a.gltf", "solid part\nfacet normal 0 0 1\n");
  refusal("a.dae", "; FBX 7.4.0 project file\n");
  refusal("a.fbx", "<COLLADA></COLLADA>");
  refusal("a.glb", "ply\nformat ascii 1.0\nelement vertex 1\n");
}

TEST_F(HostileFile, LyingCountsOfOffAndPly) {
  refusal("a.off", "OFF\n4294967295 4294967295 0\n0 0 0\n");
  refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n");
  const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n";
  refusal("a.ply", header);
  refusal("a.ply", header +
                       "property float z\nelement face 4294967295\nproperty list uint int vertex_indices\n"
                       "end_header\n0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n");
}

TEST_F(HostileFile, ThreeMfThatIsAPartOfItself) {
  EXPECT_EQ(refusal_of_3mf(object_3mf(1, components({1})), item_1),
            "cannot be read: one of its objects is a part of itself; export it again, or as STL");
  EXPECT_EQ(refusal_of_3mf(object_3mf(1, components({2})) + object_3mf(2, components({1})), item_1),
            "cannot be read: one of its objects is a part of itself; export it again, or as STL");
  EXPECT_EQ(
      refusal_of_3mf(object_3mf(1, components({2})), item_1),
      "cannot be read: a component of object 1 names object \"2\", which 3D/3dmodel.model does not hold "
      "(line 1 of 3D/3dmodel.model); export it again, or as STL");
}

TEST_F(HostileFile, ThreeMfThatDoublesItsComponents) {
  std::string objects = object_3mf(100, mesh_3mf(3));
  for (int id = 99; id >= 1; --id) objects += object_3mf(id, components({id + 1, id + 1}));
  EXPECT_EQ(
      refusal_of_3mf(objects, item_1),
      "cannot be read: its objects repeat each other up to more than 1e9 faces; export it again, or as STL");
}

TEST_F(HostileFile, ThreeMfOfAThousandLevels) {
  std::string objects = object_3mf(2000, mesh_3mf(3));
  for (int id = 1999; id >= 1; --id) objects += object_3mf(id, components({id + 1}));
  EXPECT_EQ(refusal_of_3mf(objects, item_1),
            "cannot be read: its objects are nested more than a thousand deep; export it again, or as STL");
}

TEST_F(HostileFile, ThreeMfWithAnIndexBelowZeroInItsSecondObject) {
  refusal_of_3mf(object_3mf(1, mesh_3mf(3)) + object_3mf(2, mesh_3mf(-6)),
                 std::string(item_1) + R"(<item objectid="2"/>)");
  refusal_of_3mf(object_3mf(1, mesh_3mf(3)) + object_3mf(2, mesh_3mf(4)),
                 std::string(item_1) + R"(<item objectid="2"/>)");
}

TEST_F(HostileFile, ArchivesThatAreDamagedOrLie) {
  const std::string good = test::as_3mf(test::box_mesh({0, 0, 0}, {1, 1, 1}), "millimeter");
  EXPECT_EQ(refusal("cut.3mf", good.substr(0, good.size() / 2)), damaged);
  EXPECT_EQ(refusal("cut.3mf", good.substr(0, good.size() - 30)), damaged);
  EXPECT_EQ(refusal("none.3mf", "PK\x03\x04 and nothing more"), damaged);
  std::string flipped = good;  // within the packed model
  const std::size_t model = good.find("3D/3dmodel.model") + 40;
  flipped[model] = static_cast<char>(flipped[model] ^ 0x55);
  EXPECT_EQ(refusal("flipped.3mf", flipped), damaged);
  std::string lying = good;  // in the directory: its size unpacked
  const std::size_t entry = good.rfind("PK\x01\x02");
  for (const std::size_t k : {24U, 25U, 26U, 27U}) lying[entry + k] = '\x7f';
  EXPECT_EQ(refusal("lying.3mf", lying),
            "cannot be read: an archive whose directory cannot be true; export it again, or as STL");
}

TEST_F(HostileFile, ThreeMfWithoutAModel) {
  EXPECT_EQ(refusal("part.3mf", test::archived({{"[Content_Types].xml", "<Types/>"}})),
            "cannot be read: an archive without an entry that ends in .model; export it again, or as STL");
}

TEST_F(HostileFile, GltfOfFiftyThousandLevels) {
  std::string nodes;
  constexpr int levels = 50'000;
  for (int k = 0; k + 1 < levels; ++k) nodes += fmt::format(R"({{"children":[{}]}},)", k + 1);
  refusal("deep.gltf", fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
                                   R"("nodes":[{}{{}}]}})",
                                   nodes));
}

TEST_F(HostileFile, GltfOfTwoToThe36Instances) {
  const Mesh box = test::box_mesh({0, 0, 0}, {1, 1, 1});
  std::string gltf = test::as_gltf(box), nodes;
  constexpr int levels = 36;
  for (int k = 0; k < levels; ++k) nodes += fmt::format(R"({{"children":[{0},{0}]}},)", k + 1);
  gltf.replace(gltf.find(R"("nodes":[{"mesh":0}])"), 20, fmt::format(R"("nodes":[{}{{"mesh":0}}])", nodes));
  folder.write("part.bin", test::as_gltf_numbers(box));
  refusal("many.gltf", gltf);
}

TEST_F(HostileFile, ColladaThatInstancesItself) {
  const std::string xml = test::as_collada(test::box_mesh({0, 0, 0}, {1, 1, 1}), 1, "Z_UP");
  const std::size_t at = xml.find("</node>");
  refusal("self.dae", xml.substr(0, at) + R"(<instance_node url="#n"/>)" + xml.substr(at));
}

TEST_F(HostileFile, SideFilesThatArePipesOrElsewhere) {
  ASSERT_EQ(mkfifo((folder / "part.bin").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder / "part.mtl").c_str(), 0600), 0);
  const Mesh box = test::box_mesh({0, 0, 0}, {1, 1, 1});
  refusal("part.gltf", test::as_gltf(box));
  EXPECT_TRUE(
      read_mesh({.file = folder.write("part.obj", "mtllib part.mtl\n" + test::as_obj(box))}).report.usable());
  const testing::Folder elsewhere;
  elsewhere.write("part.bin", test::as_gltf_numbers(box));
  std::string gltf = test::as_gltf(box);
  gltf.replace(gltf.find("part.bin"), 8, (elsewhere / "part.bin").string());
  refusal("other.gltf", gltf);
}

// assimp looks for a buffer beside the part where its folder is missing, and takes the first of two keys that
// are the same: it would read what the digest does not cover.
TEST_F(HostileFile, BuffersOfAGltfThatItsDigestDoesNotCover) {
  const Mesh box = test::box_mesh({0, 0, 0}, {1, 1, 1});
  const std::string gltf = test::as_gltf(box);
  folder.write("part.bin", test::as_gltf_numbers(box));
  EXPECT_TRUE(read_mesh({.file = folder.write("good.gltf", gltf)}).report.usable());
  const auto with_uri = [&](std::string_view uri) {
    std::string other = gltf;
    return other.replace(other.find("part.bin"), 8, uri);
  };
  for (const std::string_view uri : {"textures/part.bin", "x\\\\part.bin", "http://x/part.bin"})
    refusal("elsewhere.gltf", with_uri(uri));
  std::filesystem::create_directory(folder / "sub dir");
  folder.write("sub dir/b%c.bin", test::as_gltf_numbers(box));
  EXPECT_TRUE(
      read_mesh({.file = folder.write("encoded.gltf", with_uri("sub%20dir/b%25c.bin"))}).report.usable());
  const std::size_t key = gltf.find("\"uri\"");
  folder.write("other.bin", test::as_gltf_numbers(box));
  refusal("twice.gltf", gltf.substr(0, key) + R"("uri":"other.bin",)" + gltf.substr(key));
  refusal("latin.gltf", gltf.substr(0, 1) + "\"x\":\"\xe9\"," + gltf.substr(1));
}

// Numbers that a double holds without its first bit.
TEST_F(HostileFile, CoordinatesBelowTheLeastNormalNumber) {
  std::string obj = test::as_obj(test::box_mesh({0, 0, 0}, {1, 1, 1}));
  obj.replace(obj.find("v 0 0 0"), 7, "v 0 1e-320 0");
  EXPECT_TRUE(read_mesh({.file = folder.write("tiny.obj", obj)}).report.usable());
}

TEST_F(HostileFile, PipesDevicesAndFolders) {
  ASSERT_EQ(mkfifo((folder / "pipe.stl").c_str(), 0600), 0);
  for (const std::filesystem::path& file :
       {folder / "pipe.stl", std::filesystem::path("/dev/zero"), folder.path()})
    EXPECT_THROW(read_mesh({.file = file}), Error) << file;
}

// Triangles of such a face reach across each other, and each pair of them would be looked at.
TEST_F(HostileFile, AFaceOfMoreCornersThanPartsHaveIsRefused) {
  constexpr int corners = 60'000;
  std::string off = fmt::format("OFF\n{} 1 0\n", corners), face = std::to_string(corners);
  for (int i = 0; i < corners; ++i) {
    off += fmt::format("{} {} 0\n", i, i % 2);
    face += fmt::format(" {}", i);
  }
  EXPECT_NE(refusal("comb.off", off + face + "\n").find("a face has 60000 corners"), std::string::npos);
}

// Each pair of its triangles crosses: nobody wants to know all of them.
TEST_F(HostileFile, AFaceThatCrossesItselfEverywhereIsToldAsSuch) {
  constexpr int corners = 2000;
  Random random(1, stream(Stream::test));
  std::string off = fmt::format("OFF\n{} 1 0\n", corners), face = std::to_string(corners);
  for (int i = 0; i < corners; ++i) {
    const double x = random.uniform(), y = random.uniform();
    off += fmt::format("{} {} {}\n", x, y, 0.3 * x - 0.7 * y);
    face += fmt::format(" {}", i);
  }
  const MeshReport report = read_mesh({.file = folder.write("star.off", off + face + "\n")}).report;
  EXPECT_FALSE(report.usable());
  EXPECT_GE(report.self_intersections, 50'000u);
  EXPECT_LE(report.self_intersections, 50'000u + 2 * report.faces);
  EXPECT_NE(fmt::format("{}", fmt::join(report.problems, "; ")).find("pairs or more"), std::string::npos);
}

// Fewer pairs cross than are past counting, but thousands in one plane, where exact numbers grow.
TEST_F(HostileFile, ARepairThatTakesTooLongIsGivenUp) {
  constexpr int corners = 100;
  Random random(2, stream(Stream::test));
  std::string off = fmt::format("OFF\n{} {} 0\n", 2 * corners, corners + 2);
  for (int i = 0; i < corners; ++i) {
    const double x = random.uniform(), y = random.uniform();
    for (const int z : {0, 1}) off += fmt::format("{} {} {}\n", x, y, 0.3 * x - 0.7 * y + z);
  }
  for (const int z : {1, 0}) {
    off += std::to_string(corners);
    for (int i = 0; i < corners; ++i) off += fmt::format(" {}", 2 * (z == 1 ? i : corners - 1 - i) + z);
    off += "\n";
  }
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    off += fmt::format("4 {} {} {} {}\n", 2 * i, 2 * next, 2 * next + 1, 2 * i + 1);
  }
  const MeshFile part{.file = folder.write("prism.off", off), .repair = {Repair::self_intersections}};
  const ImportedMesh given_up = read_mesh(part, {.repair_seconds = 1});
  EXPECT_FALSE(given_up.report.usable());
  EXPECT_FALSE(given_up.report.is_repaired);
  EXPECT_NE(fmt::format("{}", fmt::join(given_up.report.repairs, "; "))
                .find("not repaired: CGAL takes longer than 1 s over it"),
            std::string::npos);
}

// A fuzzer found it: the normal of a face overflows, and GMP ends the process (SIGFPE).
TEST_F(HostileFile, ACoordinateWhoseProductsOverflowIsRefused) {
  for (const char* far : {"1e308", "-1e200", "1e51"})
    EXPECT_NE(
        refusal("far.obj", fmt::format("v 0 0 0\nv {} 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\nf 1 4 3 2 5\n"
                                       "f 1 2 5\n",
                                       far))
            .find("has a coordinate of"),
        std::string::npos)
        << far;
}

}  // namespace hostile_files_test
}  // namespace bernal

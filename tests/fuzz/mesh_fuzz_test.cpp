// Files of every mesh format with a few bytes changed: a mesh, or one line that names the file.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "cad/read/polygon_soup.hpp"
#include "support/cad_formats.hpp"
#include "support/folder.hpp"
#include "support/fuzz.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace mesh_fuzz_test {

constexpr std::array<std::string_view, 24> tokens = {"-1",
                                                     "-6",
                                                     "0",
                                                     "4294967295",
                                                     "2147483648",
                                                     "18446744073709551616",
                                                     "1e308",
                                                     "1e-320",
                                                     "nan",
                                                     "-inf",
                                                     "99999999999999999999999",
                                                     "\xff\xff\xff\xff",
                                                     std::string_view("\0\0\0\x80", 4),
                                                     "\n",
                                                     " ",
                                                     "<!--",
                                                     "&#0;",
                                                     "[[[[",
                                                     "{",
                                                     "/",
                                                     "#",
                                                     "\x1b[2J",
                                                     "f 1 2 3\n",
                                                     "mtllib /dev/zero\n"};

struct Format {
  std::string name, content;
};

std::vector<Format> formats() {
  const Mesh box = test::box_mesh({0, 0, 0}, {1, 2, 3});
  const std::string amf =
      R"(<?xml version="1.0"?><amf unit="inch"><object id="0"><mesh><vertices>)"
      R"(<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>)"
      R"(<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>)"
      R"(<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex></vertices><volume>)"
      R"(<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object></amf>)";
  const std::string fbx =
      "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n FBXVersion: 7300\n}\nObjects:  {\n"
      " Geometry: 1, \"Geometry::part\", \"Mesh\" {\n  Vertices: *12 {\n   a: 0,0,0,1,0,0,0,1,0,0,0,1\n  }\n"
      "  PolygonVertexIndex: *12 {\n   a: 0,2,-2,0,1,-4,0,3,-3,1,2,-4\n  }\n }\n"
      " Model: 2, \"Model::part\", \"Mesh\" {\n }\n}\nConnections:  {\n C: \"OO\",1,2\n C: \"OO\",2,0\n}\n";
  std::vector<Format> all = {{"a.stl", test::as_text_stl(box)},
                             {"b.stl", test::as_binary_stl(box)},
                             {"c.obj", test::as_obj(box)},
                             {"d.ply", test::as_text_ply(box)},
                             {"e.off", test::as_off(box)},
                             {"f.3mf", test::as_3mf(box, "inch")},
                             {"g.gltf", test::as_gltf(box)},
                             {"h.dae", test::as_collada(box, 0.001, "Z_UP")},
                             {"i.amf", amf},
                             {"j.fbx", fbx}};
  const std::filesystem::path meshes = std::filesystem::path(BERNAL_DATA) / "meshes";
  if (cad::read_with_opencascade(meshes / "frustum.brep", 0).ok())
    all.insert(all.end(), {{"k.brep", testing::text_of(meshes / "frustum.brep")},
                           {"l.step", testing::text_of(meshes / "assembly_inch.step")},
                           {"m.igs", testing::text_of(meshes / "drum_inch.igs")}});
  return all;
}

/// The text between two tags of the model, changed before it is packed: else the checksum would refuse all.
std::string mutated_3mf(const std::string& model, Random& random) {
  return test::archived_3mf(testing::mutated(model, tokens, random));
}

bool is_a_mesh(const std::filesystem::path& file) {
  const auto start = std::chrono::steady_clock::now();
  bool good = true;
  try {
    const ImportedMesh read = read_mesh({.file = file});
    for (const Vector<3>& v : read.mesh.vertices) EXPECT_TRUE(v.allFinite());
    for (const auto& triangle : read.mesh.triangles)
      for (const std::uint32_t i : triangle) EXPECT_LT(i, read.mesh.vertices.size());
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_mesh);
    EXPECT_TRUE(std::string_view(error.what()).starts_with(file.string() + ":")) << error.what();
    EXPECT_EQ(std::strpbrk(error.what(), "\n\r"), nullptr) << error.what();
    good = false;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  return good;
}

TEST(FuzzMesh, EveryMutationIsAMeshOrAnError) {
  const testing::Folder folder;
  const std::vector<Format> all = formats();
  folder.write("part.bin", test::as_gltf_numbers(test::box_mesh({0, 0, 0}, {1, 2, 3})));
  const std::string model =
      R"(<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">)"
      R"(<resources><object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>)"
      R"(<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>)"
      R"(<triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles>)"
      R"(</mesh></object><object id="2"><components><component objectid="1"/></components></object></resources>)"
      R"(<build><item objectid="2"/></build></model>)";
  for (const Format& format : all)
    EXPECT_TRUE(is_a_mesh(folder.write(format.name, format.content))) << format.name;

  const std::size_t inputs = testing::fuzz_inputs(400, 20);
  std::size_t accepted = 0;
  for (std::size_t k = 0; k < inputs; ++k) {
    Random random(1, stream(Stream::test, k));
    const Format& format = all[k % all.size()];
    const bool packed = format.name == "f.3mf" && k / all.size() % 2 == 0;
    const std::string content =
        packed ? mutated_3mf(model, random) : testing::mutated(format.content, tokens, random);
    const auto file = folder.write(format.name, content);
    accepted += is_a_mesh(file);
    if (HasFailure()) {
      ADD_FAILURE() << "input " << k << " of " << format.name << ":\n" << content.substr(0, 2000);
      break;
    }
  }
  if (inputs >= 400) {
    EXPECT_GT(accepted, inputs / 50);
    EXPECT_LT(accepted, inputs - inputs / 5);
  }
}

}  // namespace mesh_fuzz_test
}  // namespace bernal

// What the importer says about meshes whose answer is known, and which of two readers it believes.
#include "bernal/cad/read_mesh.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bernal/core/error.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace read_mesh_test {

using namespace test;

class ReadMesh : public ::testing::Test {
 protected:
  ImportedMesh read(std::string_view name, std::string_view content) {
    return read_mesh({.file = folder.write(name, content)});
  }
  std::string refusal(std::string_view name, std::string_view content) {
    try {
      read(name, content);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_mesh);
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_EQ(text.find((folder / name).string()), 0U) << text;
      return text.substr((folder / name).string().size());
    }
    return "was read";
  }

  bernal::testing::Folder folder;
  const Mesh box = box_mesh({-1, -2, -3}, {1, 2, 3});
};

TEST_F(ReadMesh, TellsCountsBoundsAndMeasures) {
  const MeshReport report = read("box.off", as_off(box)).report;
  EXPECT_EQ(report.faces, 12U);
  EXPECT_EQ(report.vertices, 8U);
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.genus, 0);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.orientation, "outward");
  EXPECT_TRUE(report.repairs.empty());
  EXPECT_NEAR(report.volume, 6, 1e-14);
  EXPECT_NEAR(report.area, 22, 1e-14);
  EXPECT_EQ(report.bounds.lower, Vector<3>(-1, -2, -3));
  EXPECT_EQ(report.bounds.upper, Vector<3>(0, 0, 0));
}

TEST_F(ReadMesh, EveryFormatGivesTheSameMesh) {
  for (const auto& [name, content] : {std::pair{"box.off", as_off(box)},
                                      {"box.obj", as_obj(box)},
                                      {"box.stl", as_text_stl(box)},
                                      {"binary.stl", as_binary_stl(box)},
                                      {"solid.stl", as_binary_stl(box, "solid but binary")}}) {
    const ImportedMesh mesh = read(name, content);
    EXPECT_TRUE(mesh.report.usable()) << name;
    EXPECT_EQ(mesh.report.faces, 12U) << name;
    EXPECT_EQ(mesh.report.vertices, 8U) << name;
    EXPECT_NEAR(mesh.report.volume, 6, 1e-14) << name;
  }
}

// A coordinate that no float holds: CGAL's is taken, and it is the double that the text means.
TEST_F(ReadMesh, DoublesSurvive) {
  const Mesh fine = translated(scaled(box, 0.1), {1e6, 1e6, 1e6});
  for (const auto& [name, content] :
       {std::pair{"fine.off", as_off(fine)}, {"fine.obj", as_obj(fine)}, {"fine.stl", as_text_stl(fine)}}) {
    const ImportedMesh mesh = read(name, content);
    EXPECT_NE(mesh.report.reader.find("double"), std::string::npos) << mesh.report.reader;
    EXPECT_TRUE(mesh.report.usable()) << name;
    EXPECT_EQ(mesh.report.bounds.lower, bounds_of(fine).lower) << name;
    EXPECT_EQ(mesh.report.bounds.upper, bounds_of(fine).upper) << name;
    EXPECT_NEAR(mesh.report.volume, 6e-3, 1e-10) << name;
  }
}

// Both readers refuse the first and CGAL takes the second for a binary file without telling.
TEST_F(ReadMesh, TextStlInUpperCaseOrWithTabs) {
  std::string upper = as_text_stl(box);
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  EXPECT_NEAR(read("upper.stl", upper).report.volume, 6, 1e-14);

  std::string tabbed = as_text_stl(box);
  tabbed.replace(tabbed.find(' '), 1, "\t");
  const MeshReport report = read("tab.stl", tabbed).report;
  EXPECT_NEAR(report.volume, 6, 1e-14);
  EXPECT_EQ(report.faces, 12U);
}

// What other programs write in text STL that its readers trip over.
TEST_F(ReadMesh, TextStlAsItIsFoundInTheWild) {
  const std::string plain = as_text_stl(box);
  const auto with = [](std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
    return text;
  };
  const auto upper = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
  };
  const std::size_t normal = plain.find("facet normal");
  const std::string first_normal = plain.substr(normal, plain.find('\n', normal) - normal);
  const std::pair<const char*, std::string> texts[] = {
      {"a number behind endfacet", with(plain, "endfacet", "endfacet 17")},
      {"in capitals", upper(with(plain, "endfacet", "endfacet 17"))},
      {"a number behind endloop", with(plain, "endloop", "endloop 3")},
      {"a colour behind endfacet", with(plain, "endfacet", "endfacet attr 0x7fff")},
      {"a number behind outer loop", with(plain, "outer loop", "outer loop 1")},
      {"words behind endsolid", with(plain, "endsolid", "endsolid 12 triangles, v1.0")},
      {"four numbers of a normal", with(plain, first_normal, first_normal + " 0")},
      {"a normal that is none", with(plain, first_normal, "facet normal nan -nan(ind) 1.#QNAN")},
      {"lines of Windows", with(with(plain, "endfacet", "endfacet 17"), "\n", "\r\n")},
      {"lines of old Macs", with(plain, "\n", "\r")},
      {"tabs", with(plain, " ", "\t")},
      {"one line", with(plain, "\n", " ")},
      {"no end of the last line", plain.substr(0, plain.size() - 1)},
      {"comments", "# made by hand\n" + with(plain, "endloop\n", "endloop\n// facet\n# facet\n")},
      {"a solid named after its words", with(plain, "solid", "solid facet holder of a solid")},
      {"exponents of Fortran", with(plain, "vertex -1 ", "vertex -0.1D+01 ")},
  };
  for (const auto& [what, text] : texts) {
    const MeshReport report = read("wild.stl", text).report;
    EXPECT_EQ(report.faces, 12U) << what;
    EXPECT_NEAR(report.volume, 6, 1e-14) << what;
  }
  const MeshReport two =
      read("two.stl", with(plain, "endfacet", "endfacet 1") + as_text_stl(translated(box, {10, 0, 0})))
          .report;
  EXPECT_EQ(two.components, 2U);
  EXPECT_NEAR(two.volume, 12, 1e-13);
  ASSERT_FALSE(two.notes.empty());
  EXPECT_EQ(two.notes.front(), "12 words behind statements of the format, of no meaning there, are ignored");
  EXPECT_NE(refusal("four.stl", with(plain, "vertex -1 ", "vertex -1 1 ")).find("expected"),
            std::string::npos);
  EXPECT_NE(refusal("comma.stl", with(plain, "vertex -1 ", "vertex -1,0 ")).find("found \"-1,0\""),
            std::string::npos);
}

TEST_F(ReadMesh, NumbersOfAnObjThatAreNoneAreTold) {
  const std::string rest = " 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 ";
  const std::string many(1'000'000, '3');
  EXPECT_NE(refusal("long.obj", "v " + many + rest + "4\n").find("no finite number (line 1); export"),
            std::string::npos);
  EXPECT_NE(refusal("digits.obj", "v 0." + many + rest + "4\n").find("(line 1)"), std::string::npos);
  EXPECT_NE(
      refusal("corner.obj", "v 0" + rest + std::string(1'000'000, '0') + "4\n").find("no index (line 8)"),
      std::string::npos);
  EXPECT_NE(refusal("large.obj", "v 1e999" + rest + "4\n").find("\"1e999\", no finite number (line 1)"),
            std::string::npos);
  EXPECT_NE(refusal("comma.obj", "v 1,5" + rest + "4\n").find("\"1,5\""), std::string::npos);
  EXPECT_NEAR(read("good.obj", "v +0.0" + rest + "4\n").report.volume, 1.0 / 6, 1e-15);
  EXPECT_NEAR(read("small.obj", "v 1e-999" + rest + "4\n").report.volume, 1.0 / 6, 1e-15);
}

TEST_F(ReadMesh, SeveralSolidsInOneFile) {
  const Mesh other = translated(box, {10, 0, 0});
  const MeshReport report = read("two.stl", as_text_stl(box, "one") + as_text_stl(other, "two")).report;
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.components, 2U);
  EXPECT_NEAR(report.volume, 12, 1e-13);
}

TEST_F(ReadMesh, MalformedTextStlIsToldWithItsLine) {
  std::string text = as_text_stl(box);
  const std::string foo = std::string(text).replace(text.find("endloop"), 7, "endloop\nfoo");
  EXPECT_EQ(refusal("foo.stl", foo),
            ":8: malformed text STL: expected \"endfacet\", found \"foo\"; export the file again");
  const std::string nan = std::string(text).replace(text.find("vertex -1"), 9, "vertex nan");
  EXPECT_EQ(refusal("nan.stl", nan),
            ":4: malformed text STL: expected a finite number, found \"nan\"; export the file again");
  EXPECT_EQ(refusal("cut.stl", text.substr(0, text.rfind("endsolid"))),
            ":86: malformed text STL: expected \"facet\" or \"endsolid\", found the end of the file; export "
            "the file again");
  const std::string quad = std::string(text).replace(text.find("endloop"), 7, "vertex 0 0 0\nendloop");
  EXPECT_EQ(refusal("quad.stl", quad),
            ":7: malformed text STL: expected \"endloop\", found \"vertex\"; export the file again");
}

TEST_F(ReadMesh, BinaryStlOfTheWrongSizeIsToldWithItsSizes) {
  const std::string whole = as_binary_stl(box);
  EXPECT_NE(refusal("cut.stl", whole.substr(0, 500)).find("12 triangles, so 684 bytes, but it has 500"),
            std::string::npos);
  EXPECT_NE(refusal("long.stl", whole + std::string(50, 'x')).find("malformed binary STL"),
            std::string::npos);
  EXPECT_NE(refusal("solid.stl", as_binary_stl(box, "solid").substr(0, 600)).find("truncated binary STL"),
            std::string::npos);
}

TEST_F(ReadMesh, FilesThatHoldNoMeshAreRefused) {
  EXPECT_EQ(refusal("empty.stl", ""), ": the file is empty");
  EXPECT_NE(refusal("empty.obj", "").find("the file is empty"), std::string::npos);
  EXPECT_NE(refusal("none.stl", "solid\nendsolid\n"), "was read");
  EXPECT_NE(refusal("points.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "was read");
  EXPECT_NE(refusal("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "was read");
  EXPECT_NE(refusal("noise.xyz", "what is this"), "was read");
  EXPECT_THROW(read_mesh({.file = folder / "missing.stl"}), Error);
  EXPECT_THROW(read_mesh({.file = folder.path()}), Error);
}

TEST_F(ReadMesh, WrongIndicesAndInfiniteCoordinatesAreRefused) {
  EXPECT_NE(refusal("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"), "was read");
  EXPECT_NE(refusal("negative.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"), "was read");
  for (const std::string face :
       {"3 0 1 -1", "3 0 1 1e300", "3 0 1 18446744073709551616", "3 0 1 nan", "3 0 1 1.5"})
    EXPECT_NE(refusal("far.off", "OFF\n3 1 0\n0 0 0\n1 0 0 # 7\n\n# 1 2\n0 1 0\n" + face + " # 2\n")
                  .find("a face names a vertex that does not exist"),
              std::string::npos)
        << face;
  EXPECT_EQ(refusal("corners.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1e15 0 1 2\n"),
            ": cannot be read: malformed or truncated; export it again, or as STL");
  EXPECT_EQ(refusal("short.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            ": cannot be read: malformed or truncated; export it again, or as STL");
  EXPECT_NE(
      refusal("short.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty "
              "double z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
              "0\n0 1 0\n3 0 1 2\n"),
      "was read");
  EXPECT_NE(refusal("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "was read");
  EXPECT_NE(refusal("nan.off", "OFF\n3 1 0\nnan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "was read");
  EXPECT_NE(refusal("huge.off", "OFF\n3 1 0\n1e999 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "was read");
}

TEST_F(ReadMesh, NumbersInAPlyFileThatAreNotReadAreNamed) {
  const auto refused = [&](const std::string& coordinate, const std::string& corner) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (const char axis : {'x', 'y', 'z'}) text += "property " + coordinate + " " + axis + "\n";
    text += "element face 2\nproperty list uchar " + corner + " vertex_indices\nend_header\n";
    return refusal("numbers.ply", text + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n");
  };
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(refused("double", "ushort"),
            ": cannot be read: its faces give their vertices as ushort; write these as int");
  EXPECT_EQ(refused("int", "int"), ": cannot be read: its coordinates are int; write them as double");
  EXPECT_EQ(refused("float", "uint32").find("cannot be read"), std::string::npos);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// "f -3 -2 -1" counts back from the last vertex: legal, and not an error.
TEST_F(ReadMesh, ObjMayCountBackwards) {
  std::ostringstream obj;
  for (const Vector<3>& v : box.vertices) obj << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n';
  for (const auto& [i, j, k] : box.triangles)
    obj << "f " << int(i) - 8 << ' ' << int(j) - 8 << ' ' << int(k) - 8 << '\n';
  EXPECT_NEAR(read("back.obj", obj.str()).report.volume, 6, 1e-14);
}

// A prism over an arrowhead given as quads and concave polygons: a fan from the first corner would lie
// outside.
TEST_F(ReadMesh, ConcavePolygonsAreTriangulatedRightly) {
  const std::string arrow =
      "OFF\n8 6 0\n0 0 0\n2 -1 0\n0 2 0\n-2 -1 0\n0 0 1\n2 -1 1\n0 2 1\n-2 -1 1\n"
      "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
  const MeshReport quads = read("arrow.off", arrow).report;
  EXPECT_TRUE(quads.usable());
  EXPECT_NEAR(quads.volume, 4, 1e-14);

  const std::string ell =
      "OFF\n12 8 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 1\n2 0 1\n2 1 1\n1 1 1\n1 2 1\n0 2 1\n"
      "6 2 1 0 5 4 3\n6 8 9 10 11 6 7\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n4 4 5 11 10\n4 5 0 6 "
      "11\n";
  const MeshReport hexagons = read("ell.off", ell).report;
  EXPECT_TRUE(hexagons.usable());
  EXPECT_NEAR(hexagons.volume, 3, 1e-14);
  EXPECT_EQ(hexagons.faces, 20U);
}

TEST_F(ReadMesh, GenusCountsTheHandles) {
  EXPECT_EQ(read("torus.off", as_off(torus_mesh(1, 0.4, 24, 12))).report.genus, 1);
  EXPECT_EQ(read("helix.off", as_off(helix_mesh())).report.genus, 1);
  EXPECT_EQ(read("ball.off", as_off(icosphere_mesh(1, 2))).report.genus, 0);
  const Mesh two = joined(torus_mesh(1, 0.4, 24, 12), translated(torus_mesh(1, 0.4, 24, 12), {5, 0, 0}));
  EXPECT_EQ(read("two.off", as_off(two)).report.genus, 2);
}

// glTF instances: the nodes' transforms count, and a mirrored one must have its winding turned back.
TEST_F(ReadMesh, NodeTransformsAreAppliedAndMirrorsTurned) {
  const auto base64 = [](const std::string& bytes) {
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t triple = 0;
      for (std::size_t k = 0; k < 3; ++k)
        triple = triple << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
      for (std::size_t k = 0; k < 4; ++k)
        out += k <= bytes.size() - i ? letters[triple >> (18 - 6 * k) & 63U] : '=';
    }
    return out;
  };
  std::string buffer;
  const auto append = [&](const auto& value) {
    buffer.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const Vector<3>& v : box.vertices)
    for (int k = 0; k < 3; ++k) append(static_cast<float>(v[k]));
  for (const auto& t : box.triangles)
    for (const std::uint32_t i : t) append(i);
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"children":[1,2],"scale":[2,2,2]},{"mesh":0},{"mesh":0,"scale":[-1,1,1],"translation":[7,0,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[-1,-2,-3],"max":[0,0,0]},
{"bufferView":1,"componentType":5125,"count":36,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":144}],
"buffers":[{"byteLength":240,"uri":"data:application/octet-stream;base64,)" +
      base64(buffer) + "\"}]}";
  const MeshReport report = read("twins.gltf", gltf).report;
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.components, 2U);
  EXPECT_EQ(report.orientation, "outward");
  EXPECT_NEAR(report.volume, 2 * 8 * 6, 1e-12);
  EXPECT_EQ(report.bounds.lower, Vector<3>(-2, -4, -6));
  EXPECT_EQ(report.bounds.upper, Vector<3>(16, 0, 0));
}

TEST_F(ReadMesh, AContainerIsScaledAndAProblemIsOneLine) {
  const ImportedMesh mesh =
      read_container_mesh({.file = folder.write("box.off", as_off(box)), .unit = Unit::mm}, {Unit::cm});
  EXPECT_NEAR(volume_of(mesh.mesh), 6.0 / 1000, 1e-17);

  Mesh open = box;
  open.triangles.pop_back();
  const auto file = folder.write("open.off", as_off(open));
  try {
    read_container_mesh({.file = file}, {});
    FAIL() << "an open box is no container";
  } catch (const Error& error) {
    EXPECT_EQ(
        error.what(),
        file.string() + ": cannot be a container: 3 open edges (in [container], cap = \"z = 0\" helps)");
  }
}

TEST_F(ReadMesh, TheHelixOfTheDataFolder) {
  const MeshReport report = read_mesh({.file = BERNAL_DATA "/meshes/lib3mf_helix.stl"}).report;
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.faces, 500U);
  EXPECT_EQ(report.vertices, 252U);
  EXPECT_EQ(report.genus, 0);
  EXPECT_NEAR(report.volume, 108197, 0.5);
}

TEST_F(ReadMesh, FacesOfManyCornersAreNotLeftOut) {
  constexpr int corners = 24;
  std::string points, bottom = fmt::format("{}", corners), top = bottom, sides;
  for (const double z : {0.0, 2.0})
    for (int k = 0; k < corners; ++k)
      points += fmt::format("{} {} {}\n", std::cos(2 * std::numbers::pi * k / corners),
                            std::sin(2 * std::numbers::pi * k / corners), z);
  for (int k = 0; k < corners; ++k) {
    bottom += fmt::format(" {}", corners - 1 - k);
    top += fmt::format(" {}", corners + k);
    const int next = (k + 1) % corners;
    sides += fmt::format("4 {} {} {} {}\n", k, next, corners + next, corners + k);
  }
  const MeshReport prism = read("prism.off", fmt::format("OFF\n{} {} 0\n{}{}\n{}\n{}", 2 * corners,
                                                         corners + 2, points, bottom, top, sides))
                               .report;
  EXPECT_TRUE(prism.usable());
  EXPECT_NEAR(prism.volume, corners * std::sin(2 * std::numbers::pi / corners), 1e-12);
}

}  // namespace read_mesh_test
}  // namespace bernal

// What files say of their units, axes and parts, coordinates as in the file; and files that are no meshes, by
// name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "cad/read/polygon_soup.hpp"
#include "support/cad_formats.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace file_units_test {

using namespace test;
using cad::PolygonSoup;
using cad::ReadAttempt;

Bounds<3> bounds_of_soup(const PolygonSoup& soup) {
  Bounds<3> bounds{Vector<3>::Constant(1e300), Vector<3>::Constant(-1e300)};
  for (const auto& polygon : soup.polygons) {
    for (const std::uint32_t i : polygon) {
      bounds.lower = bounds.lower.cwiseMin(soup.points[i]);
      bounds.upper = bounds.upper.cwiseMax(soup.points[i]);
    }
  }
  return bounds;
}

void expect_bounds(const ReadAttempt& attempt, const Vector<3>& lower, const Vector<3>& upper) {
  ASSERT_TRUE(attempt.ok()) << attempt.failure;
  const Bounds<3> bounds = bounds_of_soup(attempt.soup);
  EXPECT_LT((bounds.lower - lower).norm(), 1e-5) << bounds.lower.transpose();
  EXPECT_LT((bounds.upper - upper).norm(), 1e-5) << bounds.upper.transpose();
}

std::vector<std::string> names_of(const ReadAttempt& attempt) {
  std::vector<std::string> names;
  for (const cad::Solid& solid : attempt.soup.solids) names.push_back(solid.name);
  return names;
}

using Names = std::vector<std::string>;

class FileUnits : public ::testing::Test {
 protected:
  ReadAttempt read(std::string_view name, std::string_view content) {
    const auto file = folder.write(name, content);
    return name.ends_with(".3mf")   ? cad::read_3mf(file)
           : name.ends_with(".amf") ? cad::read_amf(file)
           : name.ends_with(".obj") ? cad::read_obj(file)
           : name.ends_with(".off") ? cad::read_with_cgal(file)
                                    : cad::read_with_assimp(file);
  }

  /// A tetrahedron with legs of 1, 2 and 3 along the axes.
  static std::string collada(std::string_view asset, std::string_view nodes = part) {
    return fmt::format(
        R"(<?xml version="1.0" encoding="utf-8"?>
<!-- <unit name="furlong" meter="201"/> -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{}</asset>
<library_geometries><geometry id="g" name="tet"><asset><unit name="mile" meter="1609"/><up_axis>X_UP</up_axis></asset>
<mesh><source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">{}</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)",
        asset, nodes);
  }
  static constexpr std::string_view part =
      R"(<node id="n" name="part"><translate>10 20 30</translate><instance_geometry url="#g"/></node>)";

  static std::string tetrahedron_xml() {
    return R"(<mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="2" z="0"/>)"
           R"(<vertex x="0" y="0" z="3"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>)"
           R"(<triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/>)"
           "</triangles></mesh>";
  }

  ReadAttempt read_3mf(std::string_view name, std::string_view unit, std::string_view objects,
                       std::string_view items) {
    const std::string model =
        fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?><model {} xml:lang="en-US" )"
                    R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">)"
                    R"(<resources>{}</resources><build>{}</build></model>)",
                    unit, objects, items);
    return read(name, archived_3mf(model));
  }

  static std::string fbx(std::string_view settings, std::string_view place = "") {
    return fmt::format(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\n\tFBXHeaderVersion: 1003\n\tFBXVersion: "
        "7400\n}}\n"
        "GlobalSettings:  {{\n\tVersion: 1000\n\tProperties70:  {{\n{}\n\t}}\n}}\n"
        "Definitions:  {{\n\tVersion: 100\n\tCount: 2\n}}\nObjects:  {{\n"
        "\tGeometry: 1001, \"Geometry::tet\", \"Mesh\" {{\n\t\tVertices: *12 {{\n\t\t\ta: "
        "0,0,0,1,0,0,0,2,0,0,0,3\n"
        "\t\t}}\n\t\tPolygonVertexIndex: *12 {{\n\t\t\ta: 0,2,-2,0,1,-4,0,3,-3,1,2,-4\n\t\t}}\n"
        "\t\tGeometryVersion: 124\n\t}}\n"
        "\tModel: 1002, \"Model::part\", \"Mesh\" {{\n\t\tVersion: 232\n\t\tProperties70:  "
        "{{\n{}\n\t\t}}\n\t}}\n}}\n"
        "Connections:  {{\n\tC: \"OO\",1002,0\n\tC: \"OO\",1001,1002\n}}\n",
        settings, place);
  }

  std::string refusal(std::string_view name, std::string_view content) {
    try {
      read_mesh({.file = folder.write(name, content)});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_mesh);
      return std::string(error.what()).substr((folder / name).string().size());
    }
    return "was read";
  }

  bernal::testing::Folder folder;
};

// assimp scales and turns a Collada document by its root; what comes out is as the file says.
TEST_F(FileUnits, ColladaStaysAsInTheFileWhateverItsAxisAndUnit) {
  const std::string mm = R"(<unit name="millimeter" meter="0.001"/>)";
  for (const auto& [asset, metres, up] :
       {std::tuple<std::string, double, char>{"", 1, 0},
        {mm, 1e-3, 0},
        {mm + "<up_axis>X_UP</up_axis>", 1e-3, 'x'},
        {mm + "<up_axis> Y_UP </up_axis>", 1e-3, 'y'},
        {"<up_axis>Z_UP</up_axis>" + mm, 1e-3, 'z'},
        {"<up_axis>Z_UP</up_axis>", 1, 'z'},
        {"<contributor><author>unit</author></contributor><unit meter='0.0254' name='inch' />", 0.0254, 0}}) {
    const ReadAttempt read_part = read("part.dae", collada(asset));
    expect_bounds(read_part, {10, 20, 30}, {11, 22, 33});
    ASSERT_TRUE(read_part.facts.unit.has_value()) << asset;
    EXPECT_EQ(read_part.facts.unit->metres, metres) << asset;
    EXPECT_EQ(read_part.facts.up, up) << asset;
  }
  EXPECT_EQ(read("mm.dae", collada(mm)).facts.unit->name, "millimeter");
  EXPECT_FALSE(read("none.dae", collada(R"(<unit name="naught" meter="0"/>)")).facts.unit.has_value());
}

TEST_F(FileUnits, ColladaNodesAreParts) {
  const std::string nodes =
      std::string(part) +
      R"(<node id="m" name="other"><rotate>0 0 1 90</rotate><instance_geometry url="#g"/></node>)";
  const ReadAttempt two = read("two.dae", collada("<up_axis>Z_UP</up_axis>", nodes));
  expect_bounds(two, {-2, 0, 0}, {11, 22, 33});
  EXPECT_EQ(names_of(two), (Names{"part", "other"}));
  ASSERT_EQ(two.soup.solids.size(), 2U);
  EXPECT_EQ(two.soup.solids[1].first, 4U);
}

TEST_F(FileUnits, ThreeMfSaysItsUnitAndItsObjects) {
  const std::string alpha =
      R"(<object id="1" type="model" name="alpha &amp; omega">)" + tetrahedron_xml() + "</object>";
  for (const auto& [unit, metres] : {std::pair{R"(unit="micron")", 1e-6},
                                     {R"(unit="millimeter")", 1e-3},
                                     {R"(unit="centimeter")", 1e-2},
                                     {R"(unit="inch")", 0.0254},
                                     {R"(unit='foot')", 0.3048},
                                     {R"(unit="meter")", 1.0},
                                     {"", 1e-3}}) {
    const ReadAttempt one = read_3mf("one.3mf", unit, alpha, R"(<item objectid="1"/>)");
    expect_bounds(one, {0, 0, 0}, {1, 2, 3});
    ASSERT_TRUE(one.facts.unit.has_value()) << unit;
    EXPECT_EQ(one.facts.unit->metres, metres) << unit;
    EXPECT_EQ(names_of(one), Names{"alpha & omega"});
  }
  EXPECT_FALSE(
      read_3mf("cubit.3mf", R"(unit="cubit")", alpha, R"(<item objectid="1"/>)").facts.unit.has_value());

  const ReadAttempt turned =
      read_3mf("turned.3mf", "", alpha,
               R"(<item objectid="1"/><item objectid="1" transform="0 1 0 -1 0 0 0 0 1 10 20 30"/>)");
  expect_bounds(turned, {0, 0, 0}, {10, 21, 33});
  EXPECT_EQ(names_of(turned), (Names{"alpha & omega", "alpha & omega"}));

  const ReadAttempt assembled =
      read_3mf("component.3mf", "",
               alpha +
                   R"(<object id="2" type="model" name="both"><components><component objectid="1" )"
                   R"(transform="1 0 0 0 1 0 0 0 1 0 0 100"/><component objectid="1"/></components></object>)"
                   R"(<object id="3" type="model" name="spare">)" +
                   tetrahedron_xml() + "</object>",
               R"(<item objectid="2" transform="1 0 0 0 1 0 0 0 1 1000 0 0"/>)");
  expect_bounds(assembled, {1000, 0, 0}, {1001, 2, 103});
  EXPECT_EQ(assembled.soup.polygons.size(), 8U);  // what is not built is no part
}

TEST_F(FileUnits, FbxCountsCentimetresTimesItsFactor) {
  const auto settings = [](std::string_view factor, int up) {
    return fmt::format(
        "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\",{}\n\t\tP: \"UnitScaleFactor\", \"double\", "
        "\"Number\", \"\",{}",
        up, factor);
  };
  const std::string place = "\t\t\tP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",10,20,30";
  for (const auto& [factor, up, metres] : {std::tuple<std::string, int, double>{"1", 1, 0.01},
                                           {"0.1", 2, 0.001},
                                           {"2.54", 0, 0.0254},
                                           {"100", 2, 1.0}}) {
    const ReadAttempt read_part = read("part.fbx", fbx(settings(factor, up), place));
    expect_bounds(read_part, {10, 20, 30}, {11, 22, 33});
    ASSERT_TRUE(read_part.facts.unit.has_value()) << factor;
    EXPECT_NEAR(read_part.facts.unit->metres, metres, 1e-15) << factor;
    EXPECT_EQ(read_part.facts.up, "xyz"[up]) << factor;
    EXPECT_EQ(names_of(read_part), Names{"part"});
  }
}

TEST_F(FileUnits, AmfSaysItsUnit) {
  std::string amf = R"(<?xml version="1.0"?><amf unit="inch"><object id="0"><mesh><vertices>)";
  for (const char* v : {"<x>0</x><y>0</y><z>0</z>", "<x>1</x><y>0</y><z>0</z>", "<x>0</x><y>2</y><z>0</z>",
                        "<x>0</x><y>0</y><z>3</z>"})
    amf += fmt::format("<vertex><coordinates>{}</coordinates></vertex>", v);
  amf += "</vertices><volume>";
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
    amf += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", a, b, c);
  amf += "</volume></mesh></object></amf>";
  const ReadAttempt part_read = read("part.amf", amf);
  expect_bounds(part_read, {0, 0, 0}, {1, 2, 3});
  ASSERT_TRUE(part_read.facts.unit.has_value());
  EXPECT_EQ(part_read.facts.unit->metres, 0.0254);
}

TEST_F(FileUnits, AGreaterSignInAnAttributeEndsNoTag) {
  std::string model = model_3mf(box_mesh({0, 0, 0}, {1, 2, 3}), "inch");
  const std::string_view start = R"(<model unit="inch" xml:lang="en-US")";
  ASSERT_NE(model.find(start), std::string::npos);
  model.replace(model.find(start), start.size(), R"(<model xml:lang="2 > 1" unit="inch")");
  const ReadAttempt part_read = read("part.3mf", archived_3mf(model));
  ASSERT_TRUE(part_read.facts.unit.has_value()) << part_read.failure;
  EXPECT_EQ(part_read.facts.unit->metres, 0.0254);
}

TEST_F(FileUnits, GltfIsInMetres) {
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0,"name":"left"},)"
      R"({"mesh":0,"name":"right","translation":[5,0,0]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,)"
      R"(AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]})";
  const ReadAttempt two = read("two.gltf", gltf);
  expect_bounds(two, {0, 0, 0}, {6, 1, 0});
  ASSERT_TRUE(two.facts.unit.has_value());
  EXPECT_EQ(two.facts.unit->metres, 1);
  EXPECT_EQ(two.facts.up, 0);
  EXPECT_EQ(names_of(two), (Names{"left", "right"}));
}

TEST_F(FileUnits, FormatsWithoutUnitsSayNothing) {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  for (const auto& [name, content] : {std::pair{"box.off", as_off(box)}, {"box.obj", as_obj(box)}}) {
    const ReadAttempt read_box = read(name, content);
    ASSERT_TRUE(read_box.ok()) << read_box.failure;
    EXPECT_FALSE(read_box.facts.unit.has_value()) << name;
    EXPECT_EQ(read_box.facts.up, 0) << name;
  }
}

TEST_F(FileUnits, StlKeepsTheNamesOfItsSolids) {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  std::string text = as_text_stl(box, "Inlet Pipe") + as_text_stl(translated(box, {5, 0, 0}), "OUTLET");
  const ReadAttempt two = cad::read_stl(folder.write("two.stl", text));
  EXPECT_EQ(names_of(two), (Names{"Inlet Pipe", "OUTLET"}));
  ASSERT_EQ(two.soup.solids.size(), 2U);
  EXPECT_EQ(two.soup.solids[1].first, 12U);
  for (const std::uint32_t i : two.soup.polygons[12]) EXPECT_GE(two.soup.points[i][0], 5);
  EXPECT_TRUE(cad::read_stl(folder.write("none.stl", as_text_stl(box, ""))).soup.solids.empty());
}

TEST_F(FileUnits, ObjObjectsAndGroupsAreParts) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n";
  const std::string objects =
      corners + "o first one\ng a\nf 1 3 2\ng b\nf 1 2 4\no empty\no Second\r\nf 1 4 3\nf 2 3 4\n";
  ReadAttempt obj = cad::read_obj(folder.write("o.obj", objects));
  EXPECT_EQ(names_of(obj), (Names{"first one", "Second"}));
  ASSERT_EQ(obj.soup.solids.size(), 2U);
  EXPECT_EQ(obj.soup.solids[1].first, 2U);
  obj = cad::read_obj(folder.write("g.obj", corners + "f 1 3 2\ng lid\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"));
  EXPECT_EQ(names_of(obj), (Names{"", "lid"}));
  EXPECT_TRUE(cad::read_obj(folder.write("n.obj", corners + "f 1 3 2\n")).soup.solids.empty());
}

TEST_F(FileUnits, AnObjGoesOnInTheNextLineAndCountsBackwards) {
  const ReadAttempt obj =
      cad::read_obj(folder.write("o.obj",
                                 "v 0 0 0\nv 1 0 \\\n0\n  v 0 2 0 1\nv 0 0 3 0.5 0.5 0.5\nvn 0 0 1\n# f 1\n"
                                 "f 1/1 2/2/2 \\\n4//7 -2\nl 1 2\nf 1 2\n"));
  ASSERT_TRUE(obj.ok()) << obj.failure;
  EXPECT_EQ(obj.soup.points, (std::vector<Vector<3>>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}));
  EXPECT_EQ(obj.soup.polygons, (std::vector<std::vector<std::uint32_t>>{{0, 1, 3, 2}}));
  EXPECT_EQ(cad::read_obj(folder.write("zero.obj", "v 0 0 0\nf 1 1 0\n")).failure,
            "a corner of a face is \"0\", no vertex that exists (line 2)");
  EXPECT_EQ(cad::read_obj(folder.write("back.obj", "v 0 0 0\nf 1 1 -2\n")).failure,
            "a corner of a face is \"-2\", no vertex that exists (line 2)");
  EXPECT_EQ(cad::read_obj(folder.write("far.obj", "v 0 0 0\nf 1 1 2\n")).failure,
            "a face names a vertex that does not exist");
  EXPECT_EQ(cad::read_obj(folder.write("short.obj", "v 0 0\n")).failure,
            "a coordinate is \"\", no finite number (line 1)");
}

TEST_F(FileUnits, AMarkOfUtf8InFrontIsNoMatter) {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n0 0 3\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  for (const auto& [name, content] : {std::pair{"box.off", as_off(box)},
                                      {"box.obj", as_obj(box)},
                                      {"box.stl", as_text_stl(box)},
                                      {"tetrahedron.ply", ply}}) {
    const MeshReport plain = read_mesh({.file = folder.write(name, content)}).report;
    const MeshReport marked = read_mesh({.file = folder.write(name, "\xEF\xBB\xBF" + content)}).report;
    EXPECT_TRUE(marked.usable()) << name;
    EXPECT_EQ(marked.volume, plain.volume) << name;
    EXPECT_EQ(marked.reader, plain.reader) << name;
  }
}

TEST_F(FileUnits, BytesBehindABinaryStlAreIgnoredAndSaid) {
  const std::string whole = as_binary_stl(box_mesh({0, 0, 0}, {1, 2, 3}));
  const ReadAttempt stl = cad::read_stl(folder.write("long.stl", whole + "twelve bytes"));
  EXPECT_NE(stl.reader.find("binary"), std::string::npos);
  EXPECT_EQ(stl.facts.notes, Names{"12 bytes after the last triangle are ignored"});
  EXPECT_NEAR(read_mesh({.file = folder / "long.stl"}).report.volume, 6, 1e-12);
  // Where whole triangles would fit, the header is what is wrong.
  EXPECT_NE(refusal("more.stl", whole + std::string(100, ' ')).find("malformed binary STL"),
            std::string::npos);
}

TEST_F(FileUnits, WhatFollowsTheLastSolidOfATextStlIsIgnoredAndSaid) {
  const std::string whole = as_text_stl(box_mesh({0, 0, 0}, {1, 2, 3})),
                    small = as_text_stl({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}});
  for (const std::string& text : {whole, small}) {
    for (const std::string& rest :
         {std::string(37, '\0'), std::string("\x1A"), std::string("signed by hand\n")}) {
      const ReadAttempt stl = cad::read_stl(folder.write("long.stl", text + rest));
      EXPECT_EQ(stl.reader.find("binary"), std::string::npos);
      ASSERT_EQ(stl.facts.notes.size(), 1U);
      EXPECT_NE(stl.facts.notes[0].find("after the last solid are ignored"), std::string::npos);
    }
  }
  EXPECT_NEAR(read_mesh({.file = folder.write("long.stl", whole + std::string(37, '\0'))}).report.volume, 6,
              1e-12);
  // A solid whose first word is spoilt is none to be ignored.
  EXPECT_NE(refusal("two.stl", whole + "s" + small).find("malformed text STL"), std::string::npos);
}

TEST_F(FileUnits, NativeCadFormatsAreNamedWithTheExportToMake) {
  for (const auto& [name, what] : {std::pair{"a.SLDPRT", "is a SolidWorks part; export STEP or STL"},
                                   {"a.sldasm", "is a SolidWorks assembly; export STEP or STL"},
                                   {"a.prt", "is a part of NX or Creo; export STEP or STL"},
                                   {"a.prt.12", "is a part of NX or Creo; export STEP or STL"},
                                   {"a.ipt", "is an Inventor part; export STEP or STL"},
                                   {"a.CATPart", "is a CATIA part; export STEP or STL"},
                                   {"a.x_t", "is a Parasolid file; export STEP or STL"},
                                   {"a.sat", "is an ACIS file; export STEP or STL"},
                                   {"a.f3d", "is a Fusion design; export STEP or STL"},
                                   {"a.3dm", "is a Rhino model; export STEP or STL"},
                                   {"a.dwg", "is an AutoCAD drawing; export STEP or STL"},
                                   {"a.jt", "is a JT file; export STEP or STL"},
                                   {"a.FCStd", "is a FreeCAD document; export STEP or STL"},
                                   {"a.scad", "is an OpenSCAD program; export STEP or STL"},
                                   {"a.blend", "is a Blender scene; export STEP or STL"}}) {
    EXPECT_EQ(refusal(name, "some bytes"), std::string(": ") + what);
  }
  const std::string ole = "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";
  EXPECT_EQ(refusal("b.sldprt", ole), ": is a SolidWorks part; export STEP or STL");
  EXPECT_NE(refusal("renamed.stl", ole).find("a native document"), std::string::npos);
  EXPECT_EQ(refusal("drawing.dxf", "0\nSECTION\n"), ": is a drawing (DXF); export STEP or STL");
}

TEST_F(FileUnits, WhatWasDownloadedInsteadIsNamed) {
  EXPECT_EQ(refusal("part.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2\nsize 12345\n"),
            ": is a pointer of git-lfs, not the file itself; run git lfs pull");
  EXPECT_EQ(
      refusal("part.step", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2\nsize 12345\n"),
      ": is a pointer of git-lfs, not the file itself; run git lfs pull");
  EXPECT_EQ(refusal("part.obj", "\n<!DOCTYPE html>\n<html><body>Sign in</body></html>"),
            ": is a web page, not a CAD file; download the file itself");
  EXPECT_EQ(refusal("part.stl.gz", "\x1f\x8b\x08 and so on"),
            ": is compressed by gzip; run gunzip on it first");
  EXPECT_EQ(refusal("part.stl", "PK\x03\x04 and so on"),
            ": is a zip archive; unpack it and name the file inside");
  EXPECT_EQ(refusal("part.stl", "ISO-10303-21;\nHEADER;\n"),
            ": is a STEP file by its content; rename it to .step");
  // A binary STL may begin with anything.
  EXPECT_EQ(refusal("odd.stl", as_binary_stl(box_mesh({0, 0, 0}, {1, 2, 3}), "PK\x03\x04")), "was read");
}

}  // namespace file_units_test
}  // namespace bernal

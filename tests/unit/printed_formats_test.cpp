// 3MF and AMF as slicers, modellers and their libraries write them: the volume, the box and the number of
// parts that each means; and what is wrong with those that mean nothing, with its place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <utility>

#include "support/printed_files.hpp"

namespace bernal {
namespace printed_formats_test {

using namespace test::printed;

TEST_F(PrintedFormats, PicturesAndSettingsAroundTheModelAreNoMatter) {
  const std::string settings =
      R"(<config><object id="1"><metadata type="object" key="name" value="Shape"/><volume firstid="0" lastid="11">)"
      R"(<metadata type="volume" key="name" value="Box"/><metadata type="volume" key="volume_type" value="ModelPart"/>)"
      R"(</volume></object></config>)";
  const std::string picture = "\x89PNG\r\n\x1a\n and no more";
  for (const char* name : {"Metadata/thumbnail.png", "Thumbnails/thumbnail.png", "Metadata/plate_1.png",
                           "3D/thumbnail.model.png"})
    expect_cube("thumbnail.3mf", test::packaged_3mf({{root, model(object(1, mesh_3mf(cube)), item_1)},
                                                     {name, picture},
                                                     {"Metadata/Slic3r_PE_model.config", settings},
                                                     {"Cura/version.ini", "x"}}));
  expect_cube("picture_first.3mf", test::packaged_3mf({{"Metadata/thumbnail.png", picture},
                                                       {root, model(object(1, mesh_3mf(cube)), item_1)}}));
}

TEST_F(PrintedFormats, PrefixesEncodingsAndMarks) {
  const std::string plain = model(object(1, mesh_3mf(cube)), item_1);
  expect_cube("mark.3mf", test::archived_3mf("\xEF\xBB\xBF" + plain));
  std::string wide = "\xFF\xFE";
  for (const char c : plain) wide += c, wide += '\0';
  expect_cube("utf16.3mf", test::archived_3mf(wide));
  expect_cube("prefix.3mf",
              test::archived_3mf(fmt::format(
                  R"(<c:model xmlns:c="{}" unit="millimeter"><c:resources><c:object id="7">{})"
                  R"(</c:object></c:resources><c:build><c:item objectid="7"/></c:build></c:model>)",
                  core, mesh_3mf(cube, "c:"))));
  expect_cube("comments.3mf",
              test::archived_3mf(model(
                  "<!-- <object id='1'/> -->" + object(1, mesh_3mf(cube)) +
                      R"(<basematerials id="9"><base name="PLA" displaycolor="#FF0000FF"/></basematerials>)",
                  item_1)));
  expect_cube(
      "sets.3mf",
      test::archived_3mf(model(
          object(1, mesh_3mf(cube, "", R"(<t:trianglesets xmlns:t="t"><t:triangleset/></t:trianglesets>)")),
          item_1)));
}

TEST_F(PrintedFormats, TheRootIsWhatTheRelationshipsName) {
  const std::string right = model(object(1, mesh_3mf(cube)), item_1),
                    wrong = model(object(1, mesh_3mf(small)), item_1);
  expect_cube("other.3mf",
              test::packaged_3mf({{root, wrong}, {"Model/part.model", right}}, "Model/part.model"));
  expect_cube("encoded.3mf",
              test::packaged_3mf({{root, wrong}, {"3D/my part.model", right}}, "/3D/my%20part.model"));
  expect_cube("case.3mf", test::packaged_3mf({{"3d/3DModel.Model", right}}));
  expect_cube("backslash.3mf", test::packaged_3mf({{"3D\\3dmodel.model", right}}));
  expect_cube("alone.3mf", test::archived({{"3D/3dmodel.model", right}}));
}

TEST_F(PrintedFormats, BambuStudioAndOrcaSlicerPutObjectsIntoOtherParts) {
  for (const std::string p : {"p:", "prod:"}) {
    const std::string assembly = object(
        2, fmt::format(
               R"(<components><component {0}path="/3D/Objects/object_1.model" objectid="1" {0}UUID="u"/>)"
               R"(<component {0}path="/3D/Objects/object_1.model" objectid="3" {0}UUID="v" )"
               R"(transform="1 0 0 0 1 0 0 0 1 20 0 0"/></components>)",
               p));
    const std::string main =
        model(assembly, R"(<item objectid="2" transform="1 0 0 0 1 0 0 0 1 100 0 5" printable="1"/>)",
              fmt::format(R"(unit="millimeter" requiredextensions="p" xmlns:prod="{}")", production));
    const std::string parts = model(object(1, mesh_3mf(cube)) + object(3, mesh_3mf(small)), "");
    const auto settings = [](std::string_view type) {
      return fmt::format(
          R"(<config><object id="2"><metadata key="name" value="Cube"/><part id="1" subtype="normal_part"/>)"
          R"(<part id="3" subtype="{}"/></object></config>)",
          type);
    };
    const auto package = [&](std::string_view type) {
      return test::packaged_3mf({{root, main},
                                 {"3D/Objects/object_1.model", parts},
                                 {"Metadata/model_settings.config", settings(type)},
                                 {"Metadata/plate_1_small.png", "x"}});
    };
    expect("bambu.3mf", package("normal_part"), 1008, 2, {100, 0, 5}, {122, 10, 15});
    expect("modifier.3mf", package("modifier_part"), 1000, 1, {100, 0, 5}, {110, 10, 15});
    EXPECT_EQ(attempt(folder / "modifier.3mf").soup.solids.front().name, "Cube");
  }
  const std::string far =
      model("", R"(<item objectid="5" p:path="/3D/a.model" transform="1 0 0 0 1 0 0 0 1 5 5 5"/>)");
  expect("item.3mf", test::packaged_3mf({{root, far}, {"3D/a.model", model(object(5, mesh_3mf(cube)), "")}}),
         1000, 1, {5, 5, 5}, {15, 15, 15});
}

TEST_F(PrintedFormats, WhatChangesThePrintIsNoPart) {
  Mesh both = cube;
  const Mesh inside = test::box_mesh({3, 3, 8}, {5, 5, 12});
  both.vertices.insert(both.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& [i, j, k] : inside.triangles) both.triangles.push_back({i + 8, j + 8, k + 8});
  const std::string settings =
      R"(<config><object id="1"><volume firstid="0" lastid="11"><metadata key="volume_type" value="ModelPart"/></volume>)"
      R"(<volume firstid="12" lastid="23"><metadata key="volume_type" value="ParameterModifier"/></volume></object></config>)";
  expect_cube("modifier.3mf", test::packaged_3mf({{root, model(object(1, mesh_3mf(both)), item_1)},
                                                  {"Metadata/Slic3r_PE_model.config", settings}}));
  expect_cube("support.3mf", test::archived_3mf(model(
                                 object(1, mesh_3mf(cube)) + object(2, mesh_3mf(small), R"(type="support")") +
                                     object(3, mesh_3mf(small), R"(type="solidsupport")"),
                                 R"(<item objectid="1"/><item objectid="2"/><item objectid="3"/>)")));
  expect_cube("unprinted.3mf",
              test::archived_3mf(model(object(1, mesh_3mf(cube)) + object(2, mesh_3mf(small)),
                                       R"(<item objectid="1"/><item objectid="2" printable="0"/>)")));
  expect_cube(
      "modifier.amf",
      fmt::format("<amf>{}</amf>",
                  object(1, mesh_amf(both).replace(
                                mesh_amf(both).find("<triangle><v1>8"), 0,
                                R"(</volume><volume><metadata type="slic3r.modifier">1</metadata>)"))));
}

TEST_F(PrintedFormats, PlacementsAreNestedAndMayMirror) {
  const std::string nested =
      object(1, mesh_3mf(cube)) +
      object(2, R"(<components><component objectid="1" transform="0 1 0 -1 0 0 0 0 1 0 0 0"/>)"
                R"(<component objectid="1" transform="2 0 0 0 1 0 0 0 1 50 0 0"/></components>)") +
      object(3, R"(<components><component objectid="2"/>)"
                R"(<component objectid="2" transform="-1 0 0 0 1 0 0 0 1 -100 0 0"/></components>)") +
      object(9, mesh_3mf(small));
  expect_model("nested.3mf", model(nested, R"(<item objectid="3"/>)"), 6000, 4, {-170, 0, 0}, {70, 10, 10});
  expect_model("turned.3mf", model(nested, R"(<item objectid="3" transform="0 0 1 1 0 0 0 1 0 1 2 3"/>)"),
               6000, 4, {1, 2, -167}, {11, 12, 73});
  expect_model("mirrored.3mf", model(nested, R"(<item objectid="1" transform="1 0 0 0 -1 0 0 0 1 0 0 0"/>)"),
               1000, 1, {0, -10, 0}, {10, 0, 10});
  expect_model("nothing_built.3mf", model(nested, ""), 6008, 5, {-170, 0, 0}, {70, 10, 10});
  expect_model(
      "flat.3mf",
      model(nested, R"(<item objectid="1"/><item objectid="9" transform="1 0 0 0 0 0 0 0 1 0 0 0"/>)"), 1000,
      1, {0, 0, 0}, {10, 10, 10});
}

TEST_F(PrintedFormats, ArchivesWithFieldsOf64Bits) {
  const std::string part = test::archived_3mf(model(object(1, mesh_3mf(cube)), item_1));
  const std::string same = in_fields_of_64_bits(part);
  EXPECT_NE(part, same);
  expect_cube("long.3mf", same);
  expect_cube("long.amf", in_fields_of_64_bits(test::archived(
                              {{"part.amf", fmt::format("<amf>{}</amf>", object(0, mesh_amf(cube)))}})));
  std::string damaged = same;
  damaged[damaged.find(root) + 60] ^= 0x55;
  EXPECT_EQ(refusal("damaged.3mf", damaged), "a zip archive that is cut short or damaged");
}

TEST_F(PrintedFormats, AmfPlainZippedAndOfUndefinedMaterial) {
  const std::string amf =
      fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?><amf unit="millimeter" version="1.1">{}</amf>)",
                  object(0, mesh_amf(cube, R"(<volume materialid="9"><color><r>1</r></color>)")));
  expect_cube("plain.amf", amf);
  expect_cube("mark.amf", "\xEF\xBB\xBF" + amf);
  expect_cube("blanks.amf", fmt::format("<amf>\r\n{}\r\n</amf>", object(0, mesh_amf(cube)).insert(0, "\t")));
  for (const char* entry : {"part.amf", "PART.AMF", "folder/part.amf", "part.amf.xml", "part"})
    expect_cube("zipped.amf", test::archived({{entry, amf}}));
  expect_cube("mac.zip.amf", test::archived({{"__MACOSX/._part.amf", "\x05\x16"}, {"part.amf", amf}}));
  expect("two.amf", fmt::format("<amf>{}{}</amf>", object(0, mesh_amf(cube)), object(1, mesh_amf(small))),
         1008, 2, {0, 0, 0}, {10, 10, 10});
}

TEST_F(PrintedFormats, AmfConstellations) {
  const std::string one = object(1, mesh_amf(cube));
  expect(
      "moved.amf",
      fmt::format(
          R"(<amf>{}<constellation id="2"><instance objectid="1"><deltax>5</deltax><deltay>1</deltay><rz>90</rz>)"
          R"(</instance><instance objectid="1"><deltaz>50</deltaz></instance></constellation></amf>)",
          one),
      2000, 2, {-5, 0, 0}, {10, 11, 60});
  // About x first, then y, then z.
  expect(
      "turned.amf",
      fmt::format(
          R"(<amf>{}<constellation id="2"><instance objectid="1"><rx>90</rx><ry>180</ry><rz>-90</rz></instance>)"
          R"(</constellation></amf>)",
          object(1, mesh_amf(test::box_mesh({0, 0, 0}, {1, 2, 3})))),
      6, 1, {-3, 0, -2}, {0, 1, 0});
  expect(
      "nested.amf",
      fmt::format(
          R"(<amf>{}<constellation id="1"><instance objectid="1"/></constellation><constellation id="3">)"
          R"(<instance objectid="2"><deltax>20</deltax></instance><instance objectid="2"/></constellation>)"
          R"(<constellation id="2"><instance objectid="1"><deltax>100</deltax></instance></constellation></amf>)",
          one),
      3000, 3, {0, 0, 0}, {130, 10, 10});
  expect(
      "prusa.amf",
      fmt::format(
          R"(<amf><metadata type="slic3rpe_amf_version">2</metadata>{}<constellation id="1"><instance objectid="1">)"
          R"(<deltax>100</deltax><rz>{}</rz><scalex>2</scalex><scaley>1</scaley><scalez>1</scalez>)"
          R"(<mirrorx>-1</mirrorx><printable>1</printable></instance></constellation></amf>)",
          one, std::numbers::pi / 2),
      2000, 1, {90, -20, 0}, {100, 0, 10});
}

TEST_F(PrintedFormats, UnitsInAnyCaseAndNone) {
  for (const auto& [unit, metres] : {std::pair{R"(unit="Inch")", 0.0254},
                                     {R"(unit="feet")", 0.3048},
                                     {R"(unit="micron")", 1e-6},
                                     {"", 1e-3}}) {
    const cad::ReadAttempt read =
        attempt(folder.write("unit.amf", fmt::format("<amf {}>{}</amf>", unit, object(0, mesh_amf(cube)))));
    ASSERT_TRUE(read.facts.unit.has_value()) << unit;
    EXPECT_EQ(read.facts.unit->metres, metres) << unit;
  }
}

TEST_F(PrintedFormats, WhatIsWrongIsToldWithItsPlace) {
  const auto with = [](std::string text, std::string_view from, std::string_view to) {
    return text.replace(text.find(from), from.size(), to);
  };
  const std::string good = mesh_3mf(cube);
  const auto refused = [&](const std::string& mesh) {
    return refusal_of_model(model(object(3, mesh), R"(<item objectid="3"/>)"));
  };
  EXPECT_EQ(refused(with(good, R"(v3=")", R"(v3="1000000000)")).substr(0, 43),
            "triangle 0 of object 3 names vertex \"100000");
  EXPECT_NE(refused(with(good, R"(v3=")", R"(v3="-)"))
                .find(", and there are 8, from 0 on (line 9 of 3D/3dmodel.model)"),
            std::string::npos);
  for (const char* bad : {"nan", "1e999", "", "1,5", "inf", "0x10", "1 2"})
    EXPECT_EQ(refused(with(good, R"(y="0")", fmt::format(R"(y="{}")", bad))),
              fmt::format(
                  "y of vertex 0 of object 3 is \"{}\", no finite number (line 1 of 3D/3dmodel.model)", bad));
  EXPECT_EQ(
      refusal_of_model(model(object(1, good), R"(<item objectid="1" transform="1 0 0 0 1 0 0 0 1 0 0"/>)")),
      "the transform of item 1 has 11 numbers, not 12 (line 21 of 3D/3dmodel.model)");
  EXPECT_EQ(refusal_of_model(model(object(1, good), R"(<item objectid="7"/>)")),
            "item 1 names object \"7\", which 3D/3dmodel.model does not hold (line 21 of 3D/3dmodel.model)");
  EXPECT_EQ(
      refusal_of_model(model(
          object(1, R"(<components><component p:path="/3D/b.model" objectid="1"/></components>)"), item_1)),
      "a component of object 1 names the part /3D/b.model, which is not there (line 1 of 3D/3dmodel.model)");
  EXPECT_EQ(refusal_of_model(model(object(1, R"(<b:booleans xmlns:b="b" objectid="1"/>)"), item_1)),
            "object 1 is given as <b:booleans>, which is no mesh (line 1 of 3D/3dmodel.model)");
  EXPECT_NE(refusal_of_model(model(object(1, good), item_1).substr(0, 500)).find("no well-formed XML"),
            std::string::npos);
  EXPECT_NE(refusal_of_model(model(object(1, good) + object(1, good), item_1))
                .find("two of its objects have the id 1"),
            std::string::npos);

  const std::string amf = mesh_amf(cube);
  EXPECT_EQ(refusal("index.amf", fmt::format("<amf>{}</amf>", object(0, with(amf, "<v3>", "<v3>1000000000"))))
                .substr(0, 43),
            "triangle 0 of object 0 names vertex \"100000");
  EXPECT_EQ(refusal("nan.amf", fmt::format("<amf>{}</amf>", object(0, with(amf, "<x>0", "<x>NaN")))),
            "x of vertex 0 of object 0 is \"NaN\", no finite number (line 1)");
  EXPECT_EQ(
      refusal("instance.amf",
              fmt::format(R"(<amf>{}<constellation id="1"><instance objectid="5"/></constellation></amf>)",
                          object(0, amf))),
      "an instance names object \"5\", which is not there (line 21)");
  EXPECT_EQ(refusal("cycle.amf", R"(<amf><constellation id="1"><instance objectid="2"/></constellation>)"
                                 R"(<constellation id="2"><instance objectid="1"/></constellation></amf>)"),
            "one of its objects is a part of itself");
  EXPECT_EQ(refusal("root.amf", "<b/>"), "its root is <b>, not <amf> (line 1)");
}

}  // namespace printed_formats_test
}  // namespace bernal

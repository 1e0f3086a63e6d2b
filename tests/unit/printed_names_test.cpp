// What names and declarations of a 3MF mean: namespaces, extensions, what may be there once, and what slicers
// say of its parts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>

#include "support/printed_files.hpp"

namespace bernal {
namespace printed_names_test {

using namespace test::printed;

class PrintedNames : public PrintedFormats {};

// A name is one of 3MF by its namespace: under any prefix, and not because a foreign one sounds alike.
TEST_F(PrintedNames, NamesCountByTheirNamespaces) {
  const auto with = [](std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
      text.replace(at, from.size(), to);
    return text;
  };
  const std::string foreign = R"(<f:object xmlns:f="foreign" id="1"/><object xmlns="foreign" id="1"/>)";
  const std::string model_of_cube = model(object(1, mesh_3mf(cube)), item_1);
  expect_cube("objects.3mf", test::archived_3mf(with(model_of_cube, "<resources>", "<resources>" + foreign)));
  expect_cube("items.3mf",
              test::archived_3mf(with(model_of_cube, "<build>",
                                      R"(<build xmlns:f="f"><f:item objectid="1"/><f:item objectid="7"/>)")));
  expect_cube("meshes.3mf",
              test::archived_3mf(with(model_of_cube, "<mesh>", R"(<f:mesh xmlns:f="f"/><mesh>)")));
  for (const char* attribute : {R"(f:x="7" )", R"(f:y="nan" )", R"(f:v1="5" )"})
    expect_cube("attributes.3mf",
                test::archived_3mf(with(with(with(model_of_cube, "<model ", R"(<model xmlns:f="f" )"),
                                             "<vertex ", fmt::format("<vertex {}", attribute)),
                                        "<triangle ", fmt::format("<triangle {}", attribute))));
  expect_cube(
      "transform.3mf",
      test::archived_3mf(model(object(1, mesh_3mf(cube)),
                               R"(<item xmlns:f="f" f:transform="2 0 0 0 2 0 0 0 2 0 0 0" f:printable="0" )"
                               R"(f:objectid="7" objectid="1"/>)")));
  // A prefix is what the innermost declaration makes of it.
  expect_cube(
      "inner.3mf",
      test::archived_3mf(fmt::format(
          R"(<a:model xmlns:a="{0}" xmlns:b="f" unit="millimeter"><b:resources/><b:resources xmlns:b="{0}">)"
          R"(<b:object id="7">{1}</b:object></b:resources><a:build xmlns="{0}"><item objectid="7"/>)"
          R"(<a:item xmlns:a="f" objectid="8"/><b:item objectid="9"/></a:build></a:model>)",
          core, mesh_3mf(cube, "b:"))));
  // The path of an object counts under any prefix of its extension, and under no other.
  for (const auto& [uri, path] : {std::pair{production, "/3D/a.model"}, {"f", "/3D/none.model"}})
    expect("path.3mf",
           test::packaged_3mf(
               {{root, model(object(5, mesh_3mf(cube)),
                             fmt::format(R"(<item xmlns:p="{}" objectid="5" p:path="{}"/>)", uri, path))},
                {"3D/a.model", model(object(5, mesh_3mf(small)), "")}}),
           uri == std::string(production) ? 8 : 1000, 1, {0, 0, 0},
           Vector<3>::Constant(uri == std::string(production) ? 2 : 10));
  EXPECT_EQ(refusal_of_model(with(model_of_cube, "<item ", R"(<item q:path="/3D/a.model" )")),
            "the prefix \"q\" stands for no namespace: xmlns:q is missing (line 21 of 3D/3dmodel.model)");
  std::string deep;
  for (int k = 0; k < 200'000; ++k) deep += "<f:a>";
  for (int k = 0; k < 200'000; ++k) deep += "</f:a>";
  expect_cube("deep.3mf", test::archived_3mf(with(model_of_cube, "<resources>",
                                                  R"(<f:b xmlns:f="f">)" + deep + "</f:b><resources>")));
}

TEST_F(PrintedNames, ExtensionsThatAreRequiredAreReadOrNamed) {
  const auto requiring = [&](std::string_view prefixes, std::string_view uri) {
    return model(object(1, mesh_3mf(cube)), item_1,
                 fmt::format(R"(unit="millimeter" xmlns:e="{}" requiredextensions="{}")", uri, prefixes));
  };
  const std::string microsoft = "http://schemas.microsoft.com/3dmanufacturing/";
  for (const char* known : {"material/2015/02", "slice/2015/07", "beamlattice/2017/02", "production/2015/06"})
    expect_cube("known.3mf", test::archived_3mf(requiring("p  e", microsoft + known)));
  for (const std::string& unknown :
       {microsoft + "securecontent/2019/07",
        std::string("http://schemas.3mf.io/3dmanufacturing/displacement/2023/10"),
        std::string("http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07"), std::string("mine")})
    EXPECT_EQ(refusal_of_model(requiring("p e", unknown)),
              fmt::format("it requires the extension {}, which is not read; export plain meshes "
                          "(line 1 of 3D/3dmodel.model)",
                          unknown));
  EXPECT_EQ(refusal_of_model(requiring("p x", "mine")),
            "it requires the extension \"x\", and xmlns:x is missing (line 1 of 3D/3dmodel.model)");
  // So does a part that the root names.
  const std::string far = model("", R"(<item objectid="1" p:path="/3D/a.model"/>)");
  EXPECT_NE(refusal("part.3mf", test::packaged_3mf({{root, far}, {"3D/a.model", requiring("e", "mine")}}))
                .find("(line 1 of 3D/a.model)"),
            std::string::npos);
}

TEST_F(PrintedNames, WhatIsThereTwiceIsRefused) {
  const auto twice = [](const std::string& text) { return text + text; };
  const std::string mesh = mesh_3mf(cube),
                    components = R"(<components><component objectid="2"/></components>)";
  const auto expect_said = [&](const std::string& xml, std::string_view what) {
    const std::string said = refusal_of_model(xml);
    EXPECT_TRUE(said.starts_with(what)) << said;
    EXPECT_NE(said.find("(line "), said.npos) << said;
  };
  const std::string second = object(2, mesh_3mf(small));
  for (const auto& inside : {mesh + components, components + mesh})
    expect_said(model(second + object(1, inside), item_1),
                "object 1 has a mesh and components, and may have one of them");
  expect_said(model(object(1, twice(mesh)), item_1), "a second <mesh> in one <object>");
  expect_said(model(second + object(1, twice(components)), item_1), "a second <components> in one <object>");
  expect_said(model(object(1, mesh), item_1 + std::string("</build><build>")),
              "a second <build> in one <model>");
  std::string vertices = mesh;
  vertices.insert(vertices.find("<triangles>"), "<vertices/>");
  expect_said(model(object(1, vertices), item_1), "a second <vertices> in one <mesh>");
}

// It would be left out, and the part would be full where it is to be empty.
TEST_F(PrintedNames, PartsThatAreCutOutOfOthersAreRefused) {
  const std::string remedy = "cut it out there (mesh boolean), and export the result";
  Mesh both = cube;
  const Mesh inside = test::box_mesh({3, 3, 3}, {5, 5, 12});
  both.vertices.insert(both.vertices.end(), inside.vertices.begin(), inside.vertices.end());
  for (const auto& [i, j, k] : inside.triangles) both.triangles.push_back({i + 8, j + 8, k + 8});
  const std::string prusa =
      R"(<config><object id="1"><volume firstid="0" lastid="11"><metadata key="volume_type" value="ModelPart"/></volume>)"
      R"(<volume firstid="12" lastid="23"><metadata key="name" value="Bore"/>)"
      R"(<metadata key="volume_type" value="NegativeVolume"/></volume></object></config>)";
  const std::string bambu =
      R"(<config><object id="1"><part id="2" subtype="normal_part"/><part id="3" subtype="negative_part">)"
      R"(<metadata key="name" value="Bore"/></part></object></config>)";
  const std::string assembly =
      object(2, mesh_3mf(cube)) + object(3, mesh_3mf(inside)) +
      object(1, R"(<components><component objectid="2"/><component objectid="3"/></components>)");
  for (const auto& [objects, settings, name] :
       {std::tuple{object(1, mesh_3mf(both)), prusa, "Metadata/Slic3r_PE_model.config"},
        std::tuple{assembly, bambu, "Metadata/model_settings.config"}}) {
    const std::string said =
        refusal("negative.3mf", test::packaged_3mf({{root, model(objects, item_1)}, {name, settings}}));
    EXPECT_TRUE(said.starts_with("of object 1 its part \"Bore\" is negative")) << said;
    EXPECT_NE(said.find(remedy), std::string::npos) << said;
  }
  std::string amf = mesh_amf(both);
  amf.insert(amf.find("<triangle><v1>8"), R"(</volume><volume><metadata type="name">Bore</metadata>)"
                                          R"(<metadata type="slic3r.volume_type">NegativeVolume</metadata>)");
  EXPECT_TRUE(refusal("negative.amf", fmt::format("<amf>{}</amf>", object(0, amf)))
                  .starts_with("of object 0 its part \"Bore\" is negative"));
  // Of an object that is not built it is no matter.
  expect_cube(
      "unbuilt.3mf",
      test::packaged_3mf({{root, model(object(4, mesh_3mf(cube)) + assembly, R"(<item objectid="4"/>)")},
                          {"Metadata/model_settings.config", bambu}}));
}

TEST_F(PrintedNames, SettingsThatSayNothingOfTheirModelAreNoted) {
  const std::string parts = model(object(1, mesh_3mf(cube)), item_1);
  const auto note_with = [&](std::string_view settings) {
    const auto file = folder.write(
        "settings.3mf",
        test::packaged_3mf({{root, parts}, {"Metadata/Slic3r_PE_model.config", std::string(settings)}}));
    const cad::ReadAttempt read = attempt(file);
    EXPECT_TRUE(read.ok()) << read.failure;
    return read.facts.notes.empty() ? std::string() : read.facts.notes.front();
  };
  EXPECT_NE(note_with("<config><object").find("cannot be read"), std::string::npos);
  EXPECT_NE(note_with(R"(<config><object id="1"><volume firstid="0" lastid="5"/></object></config>)")
                .find("is of another mesh"),
            std::string::npos);
}

}  // namespace printed_names_test
}  // namespace bernal

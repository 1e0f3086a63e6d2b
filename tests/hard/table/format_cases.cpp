#include <fmt/format.h>

#include "hard/table/hard_case.hpp"
#include "support/broken_meshes.hpp"
#include "support/cad_formats.hpp"
#include "support/folder.hpp"

// One part in every format, with units and axes as files name them; and files that are not what they seem.
namespace bernal::hard {

using namespace test;

std::vector<Case> format_cases() {
  std::vector<Case> cases;
  // An L of 20 x 20 x 30 mm, beside the origin; 9,000 mm³.
  Mesh part = scaled(l_shape_mesh(1), 10);
  for (Vector<3>& v : part.vertices) v = Vector<3>(v[0] + 10, v[1] + 20, 3 * v[2] - 30);
  const auto in = [&](double millimetres) { return scaled(part, 1 / millimetres); };

  const auto add = [&](const std::string& name, const char* why, std::vector<File> files, Expected expected,
                       const std::string& line = "") {
    cases.push_back(
        {"Files", name, why,
         scene(fmt::format("kind = \"mesh\"\nfile = \"{}\"\n{}", files[0].name, line), "diameter = 3.0"),
         std::move(expected), std::move(files)});
  };
  const auto file = [](const char* name, std::string content) {
    return std::vector<File>{{name, [content = std::move(content)] { return content; }}};
  };
  Expected whole = of_volume(at_least(200), 9000);
  whole.lower = Vector<3>(10, 20, -30);

  add("TextStl", "the part as it is", file("part.stl", as_text_stl(part)), whole);
  add("BinaryStl", "single precision, no corner is named twice", file("part.stl", as_binary_stl(part)),
      whole);
  add("BinaryStlThatSaysSolid", "its header begins as a text file does",
      file("part.stl", as_binary_stl(part, "solid part")), whole);
  add("UpperCaseStl", "words in capitals",
      file("part.STL",
           [&] {
             std::string text = as_text_stl(part);
             for (char& c : text) c = static_cast<char>(std::toupper(c));
             return text;
           }()),
      whole);
  add("StlWithCarriageReturns", "lines end as on Windows",
      file("part.stl",
           [&] {
             std::string text;
             for (const char c : as_text_stl(part))
               text += c == '\n' ? std::string("\r\n") : std::string(1, c);
             return text;
           }()),
      whole);
  add("StlWithAByteOrderMark", "three bytes before the first word",
      file("part.stl", "\xEF\xBB\xBF" + as_text_stl(part)), whole);
  add("BinaryStlWithTrailingBytes", "somebody appended a line",
      file("part.stl", as_binary_stl(part) + "made by hand\n"), whole);
  add("TextStlWithZerosAtItsEnd", "padded to a block",
      file("part.stl", as_text_stl(part) + std::string(37, '\0')), whole);
  add("Obj", "one index further", file("part.obj", as_obj(part)), whole);
  add("Off", "all digits", file("part.off", as_off(part)), whole);
  add("Ply", "double precision", file("part.ply", as_text_ply(part)), whole);
  add("ThreeMfInInches", "the file names its unit", file("part.3mf", as_3mf(in(25.4), "inch")), whole);
  add("ThreeMfInMicrons", "the file names its unit", file("part.3mf", as_3mf(in(1e-3), "micron")), whole);
  add("ThreeMfUnitContradicted", "the scene says otherwise", file("part.3mf", as_3mf(in(25.4), "inch")),
      refused("inch"), "unit = \"cm\"");
  add("ThreeMfUnitOverruled", "the scene says otherwise, and means it",
      file("part.3mf", as_3mf(in(10), "inch")), whole, "unit = \"cm\"\nignore_unit_of_file = true");
  add("GltfInMetres", "its unit is always the metre",
      {{"part.gltf", [m = in(1000)] { return as_gltf(m); }},
       {"part.bin", [m = in(1000)] { return as_gltf_numbers(m); }}},
      whole);
  add("ThreeMfWithASupport", "what holds the part while it is printed is none of it",
      file("part.3mf", as_3mf(part, "millimeter", box_mesh({10, 20, -40}, {20, 30, -20}))), whole);
  add("ThreeMfWithAThumbnail", "a picture whose path makes assimp crash",
      file("part.3mf", packaged_3mf({{"3D/3dmodel.model", model_3mf(part, "millimeter")},
                                     {"Metadata/thumbnail.png", "\x89PNG"}})),
      whole);
  add("ZippedAmf", "an archive, as its format allows",
      file("part.amf", archived({{"part.amf", as_amf(part)}})), whole);
  add("AmfOfAnUndefinedMaterial", "its volume names a material that is not there",
      file("part.amf", as_amf(part)), whole);
  add("TextStlWithNumbers", "a number behind each endfacet",
      file("part.stl",
           [&] {
             std::string text = as_text_stl(part);
             for (std::size_t at = text.find("endfacet"); at != text.npos; at = text.find("endfacet", at + 1))
               text.insert(at + 8, " 7");
             return text;
           }()),
      whole);
  add("GltfWithAHiddenInstance", "a node scaled to nothing is not to be seen",
      {{"part.gltf",
        [m = in(1000)] {
          const std::string text = as_gltf(m), one = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";
          return std::string(text).replace(
              text.find(one), one.size(),
              R"("scenes":[{"nodes":[0,1]}],"nodes":[{"mesh":0},{"mesh":0,"scale":[1,1,0]}])");
        }},
       {"part.bin", [m = in(1000)] { return as_gltf_numbers(m); }}},
      whole);
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"})
    add(fmt::format("ColladaInMillimetres{}", std::string(up, 1)), "readers turn and scale it",
        file("part.dae", as_collada(part, 1e-3, up)), whole);
  add("ColladaInInches", "the file names its unit", file("part.dae", as_collada(in(25.4), 0.0254, "Z_UP")),
      whole);
  Expected turned = of_volume(at_least(200), 9000);
  turned.lower = Vector<3>(10, 0, 20);
  add("StlWithYUp", "the axis is the user's to say", file("part.stl", as_text_stl(part)), turned,
      "up = \"y\"");
  add("StlInInches", "the unit is the user's to say", file("part.stl", as_text_stl(in(25.4))), whole,
      "unit = \"in\"");

  add("EmptyFile", "nothing in it", file("part.stl", ""), refused(""));
  add("TextInTheNameOfStl", "a letter", file("part.stl", "Dear Sir or Madam,\n"), refused(""));
  add("LargeFilePointer", "git-lfs has not fetched it",
      file("part.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n"),
      refused("git"));
  add("SolidWorks", "a native file",
      file("part.sldprt", std::string("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", 8) + std::string(600, 'x')),
      refused("export"));
  add("Dwg", "a native file", file("part.dwg", "AC1032" + std::string(600, '\0')), refused("export"));
  add("CutTextStl", "the end is missing", file("part.stl", as_text_stl(part).substr(0, 1000)), refused(""));
  add("CutBinaryStl", "the end is missing", file("part.stl", as_binary_stl(part).substr(0, 700)),
      refused(""));
  add("CutThreeMf", "the archive's directory is missing",
      file("part.3mf", as_3mf(part, "inch").substr(0, 500)), refused(""));
  const auto step = [](const auto& change) {
    return std::vector<File>{
        {"part.step",
         [change] { return change(testing::text_of(BERNAL_SOURCE "/tests/hard/models/screw.step")); }}};
  };
  add("CutStep", "the end is missing",
      step([](const std::string& text) { return text.substr(0, text.size() * 4 / 5); }), refused("cut off"));
  add("StepBehindAByteOrderMark", "three bytes before the first word",
      step([](const std::string& text) { return "\xEF\xBB\xBF" + text; }), refused("in front of"));
  add("NotANumber", "a coordinate is nan",
      file("part.off",
           [&] {
             std::string text = as_off(part);
             return text.replace(text.find("10 "), 2, "nan");
           }()),
      refused(""));
  add("IndexBeyondTheLast", "a face names a corner that is not there", file("part.off", as_off(part) + ""),
      whole);
  cases.back().files = file("part.off", [&] {
    std::string text = as_off(part);
    return text.replace(text.rfind("3 "), 3, "3 999");
  }());
  cases.back().expected = refused("");
  cases.push_back({"Files", "NoSuchFile", "the path leads nowhere",
                   scene("kind = \"mesh\"\nfile = \"nowhere.stl\"", "diameter = 3.0"),
                   refused("nowhere.stl")});
  cases.push_back({"Files", "AFolder", "the path is a folder",
                   scene("kind = \"mesh\"\nfile = \".\"", "diameter = 3.0"), refused("")});
  return cases;
}

}  // namespace bernal::hard

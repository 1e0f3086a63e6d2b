// [[output]] in a scene: read, checked, written with the result.
#include <gtest/gtest.h>

#include <set>

#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "bernal/scene/read_scene.hpp"
#include "support/exports.hpp"
#include "support/scene_texts.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace output_scene_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::error_of;
using testing::example;
using testing::expect_equal;
using testing::Folder;
using testing::text_of;

const std::string box =
    "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10.0, 10.0, 10.0]\n"
    "[spheres]\nfill = true\nradius = 0.5\n";

Scene with_output(const std::string& body) {
  return parse_scene(box + "[[output]]\n" + body + "\n", "s.toml");
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename());
  return names;
}

Packing packing_with(const std::string& outputs) {
  Packing packing = example();
  packing.scene = parse_scene(box + outputs, "s.toml");
  return packing;
}

TEST(OutputScene, IsReadAndWritten) {
  const Scene scene = with_output("format = \"lammps\"\nfile = \"mine.data\"\ndensity = 1200\ntypes = 3");
  ASSERT_EQ(scene.outputs.size(), 1u);
  EXPECT_EQ(scene.outputs[0].file, "mine.data");
  EXPECT_EQ(scene.outputs[0].material_density, 1200);
  EXPECT_EQ(scene.outputs[0].types, 3);
  EXPECT_EQ(scene.outputs[0].unit, Unit::m);
  expect_equal(scene, parse_scene(scene_as_toml(scene), "s.toml"));
  const Scene own = with_output("format = \"extxyz\"");
  EXPECT_EQ(own.outputs[0].file, "extxyz.xyz");
  EXPECT_EQ(own.outputs[0].unit, Unit::mm);
  EXPECT_NE(
      scene_as_toml(own).find("[[output]]\nformat = \"extxyz\"\nfile = \"extxyz.xyz\"\nunit = \"mm\"\n"),
      std::string::npos)
      << scene_as_toml(own);
}

TEST(OutputScene, IsRefusedAtItsLine) {
  const auto refused = [](const std::string& text, int line, const std::vector<std::string>& words) {
    const Error error = error_of([&] { parse_scene(box + text, "s.toml"); });
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_EQ(error.location().line, line) << error.what();
    const std::string what = error.what();
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), std::string::npos) << word << ": " << what;
  };
  refused("[[output]]\nformat = \"lamps\"\n", 9, {"unknown format \"lamps\"", "\"lammps\""});
  refused("[[output]]\nfile = \"a\"\n", 8, {"missing \"format\"", "\"yade\""});
  refused("[output]\nformat = \"yade\"\n", 8, {"[[output]]", "an output"});
  refused("[[output]]\nformat = \"yade\"\ndensity = 7\n", 10, {"unknown key \"density\"", "[[output]] yade"});
  refused("[[output]]\nformat = \"lammps\"\ndensity = -7\n", 10, {"\"density\"", "-7"});
  refused("[[output]]\nformat = \"lammps\"\nunit = \"mile\"\n", 10, {"\"unit\"", "mile"});
  refused("[[output]]\nformat = \"lammps\"\nfile = \"a/b\"\n", 10, {"\"file\"", "a/b"});
  for (const std::string name : {"..", ".", ".bernal-complete"})
    refused("[[output]]\nformat = \"lammps\"\nfile = \"" + name + "\"\n", 10,
            {"\"file\"", "\"" + name + "\""});
  refused("[[output]]\nformat = \"npy\"\nfile = \"spheres.csv\"\n", 10, {"spheres.csv", "every result"});
  refused("[[output]]\nformat = \"npy\"\nfile = \"a\"\n[[output]]\nformat = \"yade\"\nfile = \"a\"\n", 13,
          {"\"a\"", "before it"});
  refused(
      "[[output]]\nformat = \"npy\"\nfile = \"a.py\"\n[[output]]\nformat = \"openmc\"\nfile = \"a.npy\"\n",
      13, {"\"a.py\"", "before it"});
  const Error flat = error_of([] {
    parse_scene(
        "[container]\nkind = \"box\"\nsize = [9, 9]\n[spheres]\nradius = 1\n[[output]]\n"
        "format = \"povray\"\n",
        "s.toml");
  });
  EXPECT_EQ(flat.location().line, 6);
  EXPECT_NE(std::string(flat.what()).find("2 dimensions"), std::string::npos) << flat.what();
}

TEST(OutputScene, IsWrittenWithTheResultAndGoesWithIt) {
  const Folder folder;
  const Packing packing = packing_with(
      "[[output]]\nformat = \"lammps\"\nfile = \"mine.data\"\n"
      "[[output]]\nformat = \"openmc\"\n");
  check_writable(folder.path(), packing.scene);
  const WrittenPacking written = write_packing(packing, folder.path());
  ASSERT_EQ(written.notes.size(), 2u);
  EXPECT_NE(written.notes[1].find("lengths in cm"), std::string::npos);
  double density = 0;
  EXPECT_EQ(read_lammps(folder / "mine.data", density).radii.size(), packing.spheres.size());
  EXPECT_EQ(read_npy(folder / "openmc_radii.npy").shape.at(0), packing.spheres.size());
  const std::set<std::string> first = names_in(folder.path());
  for (const char* name : {"mine.data", "openmc.npy", "openmc_radii.npy", "openmc.py"})
    EXPECT_TRUE(first.contains(name)) << name;
  // The scene of the result asks for the same again.
  EXPECT_EQ(read_packing(folder.path()).scene.outputs.size(), 2u);

  const Packing second = packing_with("[[output]]\nformat = \"yade\"\n");
  check_writable(folder.path(), second.scene);
  write_packing(second, folder.path());
  const std::set<std::string> then = names_in(folder.path());
  EXPECT_TRUE(then.contains("yade.txt"));
  EXPECT_FALSE(then.contains("mine.data"));
  EXPECT_FALSE(then.contains("openmc.py"));
}

TEST(OutputScene, TakesNoPlaceOfAFileOfSomebodyElse) {
  const Folder folder;
  folder.write("openmc.py", "mine");
  const Packing packing = packing_with("[[output]]\nformat = \"openmc\"\n");
  const Error error = error_of([&] { check_writable(folder.path(), packing.scene); });
  EXPECT_EQ(error.location().file, (folder / "openmc.py").string());
  EXPECT_EQ(text_of(folder / "openmc.py"), "mine");
}

TEST(OutputScene, TakesNoPlaceOfWhatTheSceneStartsFrom) {
  const Folder folder;
  folder.write("a.csv", "x,y,z,r\n5,5,5,1\n");
  const Scene scene = read_scene(
      folder.write("s.toml",
                   "[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\nradius = 1\nstart = \"a.csv\"\n"
                   "[[output]]\nformat = \"npy\"\nfile = \"a.csv\"\n"));
  const Error error = error_of([&] { check_writable(folder.path(), scene); });
  EXPECT_NE(std::string(error.what()).find("starts from"), std::string::npos) << error.what();
}

// Whatever folders and lists the writing itself needs have other names.
TEST(OutputScene, AnyOtherNameIsOneForAFile) {
  const Folder folder;
  for (const char* name : {"earlier", "replaced", "a \"b\" \\c", "é"}) {
    Packing packing = packing_with("[[output]]\nformat = \"npy\"\n");
    packing.scene.outputs[0].file = name;
    write_packing(packing, folder.path());
    EXPECT_EQ(read_npy(folder / name).shape.at(0), packing.spheres.size()) << name;
    EXPECT_EQ(read_packing(folder.path()).scene.outputs.at(0).file, name);
  }
}

TEST(OutputScene, AResultAppearsWithAllItsOutputsOrNotAtAll) {
  const Folder folder;
  fs::create_directory(folder / "yade.txt");
  EXPECT_THROW(write_packing(packing_with("[[output]]\nformat = \"yade\"\n"), folder.path()), Error);
  EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"yade.txt"});
}

TEST(OutputScene, SaysInCppWhatNoFileCouldHold) {
  Scene scene = parse_scene(box, "");
  scene.outputs = {{.format = "none"}};
  EXPECT_NE(std::string(error_of([&] { complete(scene); }).what()).find("unknown format"), std::string::npos);
  scene.outputs = {{.format = "lammps", .types = 0}};
  EXPECT_NE(std::string(error_of([&] { complete(scene); }).what()).find("\"types\""), std::string::npos);
}

}  // namespace output_scene_test
}  // namespace bernal

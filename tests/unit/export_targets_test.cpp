// Where export writes, and where it does not.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "bernal/core/error.hpp"
#include "bernal/result/read_packing.hpp"
#include "bernal/result/write_packing.hpp"
#include "files/seal.hpp"
#include "support/export_packings.hpp"
#include "support/exports.hpp"
#include "support/written_files.hpp"

namespace bernal {
namespace export_targets_test {

namespace fs = std::filesystem;
using namespace testing::exports;
using testing::error_of;
using testing::Folder;
using testing::text_of;

/// Refused, and what stands there is as before.
void expect_refused(const Packing& packing, const std::string& format, const fs::path& file,
                    const std::vector<std::string>& words) {
  const Error error = error_of([&] { write_export(packing, output_of(format), file); });
  for (const std::string& word : words)
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << word << ": " << error.what();
  EXPECT_EQ(std::string(error.what()).find(".bernal-staging"), std::string::npos) << error.what();
}

TEST(ExportTargets, FilesAreWrittenThroughLinks) {
  const Folder folder;
  const Packing packing = periodic();
  fs::create_directory(folder / "data");
  folder.write("data/far.npy", "mine");
  fs::create_symlink("data/far.npy", folder / "one");
  fs::create_symlink("one", folder / "two");
  fs::create_symlink("data/new.npy", folder / "not yet");
  write_export(packing, output_of("npy"), folder / "two");
  write_export(packing, output_of("npy"), folder / "not yet");
  for (const char* link : {"one", "two", "not yet"}) EXPECT_TRUE(fs::is_symlink(folder / link)) << link;
  for (const char* file : {"data/far.npy", "data/new.npy"})
    EXPECT_EQ(read_npy(folder / file).shape.at(0), packing.spheres.size()) << file;
}

TEST(ExportTargets, WhatIsNoFileStays) {
  const Folder folder;
  const Packing packing = periodic();
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_directory(folder / "folder");
  fs::create_symlink("loop", folder / "loop");
  fs::create_symlink("pipe", folder / "to a pipe");
  expect_refused(packing, "npy", folder / "pipe", {"pipe", "a device or a pipe"});
  expect_refused(packing, "npy", folder / "to a pipe", {"a device or a pipe"});
  expect_refused(packing, "npy", folder / "loop", {"leads to itself"});
  expect_refused(packing, "npy", folder / "folder", {"is a folder"});
  expect_refused(packing, "npy", folder / ".", {"is a folder"});
  expect_refused(packing, "npy", folder / "folder/..", {"is a folder"});
  // Neither do those that go with the file that is named.
  ASSERT_EQ(mkfifo((folder / "a_radii.npy").c_str(), 0600), 0);
  expect_refused(packing, "openmc", folder / "a.npy", {"a_radii.npy", "goes with a.npy"});
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
  EXPECT_TRUE(fs::is_fifo(folder / "a_radii.npy"));
  EXPECT_TRUE(fs::is_symlink(folder / "loop"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 5);
}

TEST(ExportTargets, NamesAreThoseThatFilesCanHold) {
  const Folder folder;
  const Packing packing = periodic();
  for (const char* name : {"new", "line.npy"}) folder.write(name, "mine");
  expect_refused(packing, "npy", folder / "new\nline.npy", {"control characters", "new\\u000Aline.npy"});
  expect_refused(packing, "npy", folder / ".bernal-complete", {"bernal needs"});
  expect_refused(packing, "openmc", folder / "foo.py", {"\"foo.py\" ends as the file does"});
  expect_refused(packing, "raw", folder / "v.json", {"\"v.json\" ends as"});
  expect_refused(packing, "liggghts", folder / "w.in", {"\"w.in\" ends as"});
  expect_refused(packing, "openmc", folder / "a\xff.npy", {"not UTF-8"});
  expect_refused(packing, "liggghts", folder / "it's \"this\".data", {"both kinds of quotation marks"});
  for (const char* name : {"new", "line.npy"}) EXPECT_EQ(text_of(folder / name), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
  write_export(packing, output_of("npy"), folder / "a\xff.npy");  // which no other file names
}

// What goes with a file takes no place but that of its own kind, as bernal wrote it.
TEST(ExportTargets, FilesBesideAreNobodyElses) {
  const Mesh walls{{{0, 0, 0}, {90, 0, 0}, {0, 90, 0}, {0, 0, 90}},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const Packing in_mesh = packing_in(walls, "kind = \"box\"\nsize = [9, 9, 9]"), box = periodic();
  for (const auto& [format, main, beside] :
       std::vector<std::array<std::string, 3>>{{"openmc", "model.npy", "model.py"},
                                               {"openmc", "model.npy", "model_radii.npy"},
                                               {"liggghts", "bed.data", "bed.in"},
                                               {"liggghts", "bed.data", "bed.stl"},
                                               {"raw", "v.raw", "v.json"}}) {
    const Packing& packing = format == "liggghts" ? in_mesh : box;
    const Folder folder;
    folder.write(beside, "# bernal is what this is for\n");
    expect_refused(packing, format, folder / main, {beside, "goes with " + main});
    EXPECT_EQ(text_of(folder / beside), "# bernal is what this is for\n");
    EXPECT_FALSE(fs::exists(folder / main));
    // In the place of its own, again and again, until somebody changes it.
    fs::remove(folder / beside);
    for (int k = 0; k < 3; ++k) write_export(packing, output_of(format), folder / main);
    std::string changed = text_of(folder / beside);
    changed[changed.size() / 2] ^= 1;
    folder.write(beside, changed);
    expect_refused(packing, format, folder / main, {beside, "somebody has changed it"});
    EXPECT_EQ(text_of(folder / beside), changed);
    folder.write(beside, text_of(folder / beside) + "# mine\n");
    expect_refused(packing, format, folder / main, {beside});
  }
}

// A format that forgets the seal cannot be exported twice.
TEST(ExportTargets, EveryFormatTakesItsOwnPlace) {
  for (const ExportFormat& format : export_formats()) {
    const Folder folder;
    const auto write = [&] { write_export(in_cylinder(), output_of(format.name), folder / format.file); };
    EXPECT_NO_THROW(write()) << format.name;
    if (std::filesystem::is_directory(folder / format.file)) {
      EXPECT_THROW(write(), Error) << format.name;  // which somebody may have worked in
    } else {
      EXPECT_NO_THROW(write()) << format.name;
    }
  }
}

TEST(ExportTargets, ASealHoldsUntilSomethingIsChanged) {
  const std::string text = sealed_script("a = 1\n");
  EXPECT_TRUE(is_sealed(text));
  for (std::size_t k = 0; k < text.size(); ++k) {
    std::string changed = text;
    changed[k] ^= 1;
    EXPECT_FALSE(is_sealed(changed)) << k;
  }
  EXPECT_FALSE(is_sealed(text + "b = 2\n"));
  EXPECT_FALSE(is_sealed("b = 2\n" + text));
  EXPECT_FALSE(is_sealed(""));
  EXPECT_FALSE(is_sealed(text.substr(0, text.size() / 2)));
  EXPECT_TRUE(is_sealed(sealed("{\"a\": 1, \"seal\": \"", "", "\"}\n")));
}

const std::string sieved =
    "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10.0, 10.0, 10.0]\n[spheres]\ncount = 60\n"
    "radius = { distribution = \"sieve\", file = \"sieve.csv\" }\n";

TEST(ExportTargets, SourcesOfThePackingStay) {
  const Folder folder;
  folder.write("sieve.csv", "sizes,passing\n0.1,0\n0.2,0.5\n0.4,1\n");
  Packing packing = testing::example();
  packing.scene = read_scene(folder.write("m.toml", sieved));
  write_packing(packing, folder / "out");
  const Packing read = read_packing(folder / "out");
  for (const char* name : {"m.toml", "sieve.csv", "out/scene.toml", "out/spheres.csv", "out/report.html"}) {
    const std::string before = text_of(folder / name);
    expect_refused(read, "npy", folder / name, {name, "made from"});
    expect_refused(packing, "npy", folder / "sieve.csv", {"made from"});
    EXPECT_EQ(text_of(folder / name), before);
  }
  // Through a link, and the whole wherever it has been moved.
  fs::create_symlink("m.toml", folder / "link");
  expect_refused(read, "npy", folder / "link", {"m.toml"});
  fs::create_directory(folder / "deep");
  for (const char* name : {"m.toml", "sieve.csv", "out"}) fs::rename(folder / name, folder / "deep" / name);
  expect_refused(read_packing(folder / "deep/out"), "npy", folder / "deep/sieve.csv", {"made from"});
}

TEST(ExportTargets, FilesOfAnotherResultStay) {
  const Folder folder;
  Packing other = testing::example(2);
  other.scene = parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10, 10, 10]\n[spheres]\nfill = true\n"
      "radius = 0.5\n[[output]]\nformat = \"yade\"\n",
      "");
  write_packing(other, folder / "other");
  for (const char* name : {"other/spheres.csv", "other/report.json", "other/yade.txt"}) {
    const std::string before = text_of(folder / name);
    expect_refused(periodic(), "yade", folder / name, {name, "belongs to the result"});
    EXPECT_EQ(text_of(folder / name), before);
  }
}

// A script is there to be changed; the next run of the scene asks first.
TEST(ExportTargets, AScriptThatWasChangedIsNoLongerTheResults) {
  const Folder folder;
  Packing packing = testing::example();
  packing.scene = parse_scene(
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [10, 10, 10]\n[spheres]\nfill = true\n"
      "radius = 0.5\n[[output]]\nformat = \"liggghts\"\nfile = \"bed.data\"\n"
      "[[output]]\nformat = \"povray\"\n",
      "");
  for (int k = 0; k < 2; ++k) {
    check_writable(folder.path(), packing.scene);
    write_packing(packing, folder.path());
  }
  for (const char* name : {"bed.in", "povray.pov"}) {
    const std::string written = text_of(folder / name), mine = written + "\n# mine\n";
    folder.write(name, mine);
    const Error error = error_of([&] { check_writable(folder.path(), packing.scene); });
    EXPECT_EQ(error.location().file, (folder / name).string()) << error.what();
    // Whoever changes it during the run keeps it too.
    write_packing(packing, folder.path());
    EXPECT_EQ(text_of(folder / (std::string(name) + ".kept")), mine);
    EXPECT_EQ(text_of(folder / name), written);
  }
}

}  // namespace export_targets_test
}  // namespace bernal

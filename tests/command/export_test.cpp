#include <algorithm>
#include <set>

#include "bernal/export/export.hpp"
#include "check.hpp"

namespace bernal::testing {
namespace export_command_test {

namespace fs = std::filesystem;

constexpr const char* debian_python = "/usr/bin/python3";  ///< which has what python3-gsd installs

/// A folder with a small result in "out".
struct Packed {
  Folder folder;
  Packed() {
    const Ended packed = bernal({"pack", folder.write("scene.toml", small_scene).string(), "-o", out()});
    EXPECT_EQ(packed.status, 0) << packed.err;
  }
  std::string out() const { return folder / "out"; }
};

std::string sizes_in_words(const ExportFormat& format) {
  return format.sizes == "radius" ? "radii" : format.sizes == "diameter" ? "diameters" : format.sizes;
}

TEST(ExportCommand, WritesEveryFormatAndSaysWhatItIs) {
  const Packed result;
  for (const ExportFormat& format : export_formats()) {
    const std::string file = result.folder / ("x_" + format.file);
    const Ended ended = bernal({"export", result.out(), "--to", format.name, "-o", file});
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.out, "");
    EXPECT_TRUE(fs::is_regular_file(file));
    const std::string unit = format.unit == "the scene's" ? "mm" : format.unit;
    for (const std::string& word : {std::string("300 spheres"), "lengths in " + unit, sizes_in_words(format)})
      EXPECT_NE(ended.err.find(word), std::string::npos) << word << "\nis not in: " << ended.err;
  }
}

TEST(ExportCommand, HelpListsEveryFormatWithItsUnitAndSizes) {
  const std::string help = bernal({"export", "--help"}).out;
  for (const ExportFormat& format : export_formats()) {
    const std::size_t at = help.find("\n  " + format.name + " ");
    ASSERT_NE(at, std::string::npos) << format.name;
    const std::string about = help.substr(at, help.find("dimensions", at) - at);
    EXPECT_NE(about.find(format.what), std::string::npos);
    EXPECT_NE(about.find("lengths in " + format.unit), std::string::npos) << about;
    EXPECT_NE(about.find(sizes_in_words(format)), std::string::npos) << about;
  }
  for (const ExportKey& key : export_keys()) EXPECT_NE(help.find("--" + key.name), std::string::npos);
}

TEST(ExportCommand, RefusesInOneLine) {
  const Packed result;
  const std::string file = result.folder / "a.data";
  const auto refused = [&](std::vector<std::string> words, const std::vector<std::string>& said) {
    words.insert(words.begin(), {"export", result.out()});
    expect_refused_in_one_line(bernal(words), said);
  };
  refused({"--to", "lamps", "-o", file}, {"\"lamps\"", "did you mean \"lammps\"?"});
  refused({"--to", "yade", "-o", file, "--density", "7"}, {"yade takes no density", "lammps"});
  refused({"--to", "lammps", "-o", file, "--types", "many"}, {"types", "many"});
  refused({"--to", "lammps"}, {"--output"});
  refused({"--to", "lammps", "-o", "-"}, {"-o"});
  EXPECT_FALSE(fs::exists(file));
  expect_refused_in_one_line(bernal({"export", result.folder / "none", "--to", "npy", "-o", file}), {"none"});
  // What the packing is read from stays.
  for (const char* name : {"spheres.csv", "scene.toml", "report.json"}) {
    const std::string own = result.out() + "/" + name, before = text_of(own);
    refused({"--to", "npy", "-o", own}, {name, "another name"});
    EXPECT_EQ(text_of(own), before);
  }
}

TEST(ExportCommand, APackWritesWhatTheSceneAsksFor) {
  const Folder folder;
  const std::string scene = folder.write(
      "scene.toml",
      std::string(small_scene) + "[[output]]\nformat = \"lammps\"\nfile = \"bed.data\"\ndensity = 1000\n");
  const Ended explained = bernal({"explain", scene});
  EXPECT_NE(explained.out.find("output     bed.data, for lammps, in m"), std::string::npos) << explained.out;
  const Ended packed = bernal({"pack", scene, "-o", folder / "out"});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_NE(packed.err.find("output     bed.data: 300 spheres, lengths in m, diameters, density 1000 kg/m3"),
            std::string::npos)
      << packed.err;
  EXPECT_TRUE(text_of(folder / "out/bed.data").find("\n300 atoms\n") != std::string::npos);
  // The same file by hand.
  EXPECT_EQ(
      bernal({"export", folder / "out", "--to", "lammps", "--density", "1000", "-o", folder / "bed.data"})
          .status,
      0);
  EXPECT_EQ(text_of(folder / "bed.data"), text_of(folder / "out/bed.data"));
}

TEST(ExportCommand, TheGsdIsOneForItsOwnLibrary) {
  if (Process({debian_python, "-c", "import gsd.hoomd"}).wait().status != 0)
    GTEST_SKIP() << "python3-gsd is not installed";
  const Packed result;
  const std::string file = result.folder / "a.gsd";
  ASSERT_EQ(bernal({"export", result.out(), "--to", "gsd", "-o", file}).status, 0);
  const Ended read =
      Process({debian_python, "-c",
               "import sys, gsd.hoomd\n"
               "frames = gsd.hoomd.open(sys.argv[1])\n"
               "f = frames[0]\n"
               "p = f.particles\n"
               "print(len(frames), p.N, f.configuration.dimensions, p.types, p.diameter.min(), "
               "p.diameter.max(), p.position.shape, f.configuration.box[3])",
               file})
          .wait();
  EXPECT_EQ(read.out, "1 300 3 ['1'] 1.0 1.0 (300, 3) 0.0\n") << read.err;
}

}  // namespace export_command_test
}  // namespace bernal::testing

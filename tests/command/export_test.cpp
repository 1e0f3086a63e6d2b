#include <algorithm>
#include <csignal>
#include <fstream>
#include <memory>
#include <regex>

#include "bernal/formats/export.hpp"
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
    EXPECT_TRUE(fs::exists(file)) << file;
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
    const std::string about =  // however its lines are broken
        std::regex_replace(help.substr(at, help.find("dimensions", at) - at), std::regex("\\s+"), " ");
    EXPECT_NE(about.find(format.what), std::string::npos);
    EXPECT_NE(about.find("lengths in " + format.unit), std::string::npos) << about;
    EXPECT_NE(about.find(sizes_in_words(format)), std::string::npos) << about;
  }
  for (ExportKey key : export_keys()) {
    std::ranges::replace(key.name, '_', '-');
    EXPECT_NE(help.find("--" + key.name), std::string::npos) << key.name;
  }
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

// As make -j does it.
TEST(ExportCommand, SideBySideIntoOneFolderAllAreWritten) {
  const Packed result;
  constexpr int at_once = 4, rounds = 6;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::unique_ptr<Process>> running;
    for (int k = 0; k < at_once; ++k)
      running.push_back(std::make_unique<Process>(
          std::vector<std::string>{BERNAL_COMMAND, "export", result.out(), "--to", "npy", "-o",
                                   result.folder / ("made/q" + std::to_string(k) + ".npy")}));
    for (const auto& process : running) {
      const Ended ended = process->wait();
      EXPECT_EQ(ended.status, 0) << ended.err;
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(result.folder / "made"), {}), at_once);
}

TEST(ExportCommand, KeysTellsOfEveryFormat) {
  const Ended ended = bernal({"keys", "output"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const ExportFormat& format : export_formats())
    EXPECT_NE(ended.out.find("\n  " + format.name + " "), std::string::npos) << format.name;
  EXPECT_EQ(ended.out.find("relax"), std::string::npos);
  EXPECT_NE(bernal({"keys", "stage"}).out.find("relax"), std::string::npos);
}

TEST(ExportCommand, AnImageThatNoDiskHoldsIsRefusedBefore) {
  const Packed result;
  if (fs::space(result.folder.path()).available > 4'000'000'000'000u) GTEST_SKIP() << "there is room";
  expect_refused_in_one_line(bernal({"export", result.out(), "--to", "nrrd", "--resolution", "10000",
                                     "--values", "labels", "-o", result.folder / "v.nrrd"}),
                             {"4e+03 GB are to be written", "free"});
  EXPECT_FALSE(fs::exists(result.folder / "v.nrrd"));
}

// The module that goes with the centres: images are those that reach into the box, and no others.
TEST(ExportCommand, TheModuleForOpenmcKnowsTheImages) {
  if (Process({debian_python, "-c", "import numpy"}).wait().status != 0)
    GTEST_SKIP() << "numpy is not installed";
  const Folder folder;
  const std::string scene = folder.write(
      "scene.toml",
      "[container]\nkind = \"periodic\"\nsize = [3, 4, 5]\n[spheres]\ncount = 40\nradius = 0.4\n");
  ASSERT_EQ(bernal({"pack", scene, "-o", folder / "out"}).status, 0);
  ASSERT_EQ(bernal({"export", folder / "out", "--to", "openmc", "-o", folder / "m.npy"}).status, 0);
  const Ended read =
      Process(
          {debian_python, "-c",
           "import sys, types, itertools\n"
           "import numpy as np\n"
           "for name in ('openmc', 'openmc.model'): sys.modules[name] = types.ModuleType(name)\n"
           "sys.modules['openmc'].model = sys.modules['openmc.model']\n"
           "sys.path.insert(0, sys.argv[1])\n"
           "import m\n"
           "c, r = m.with_images()\n"
           "L = m.upper - m.lower\n"
           "want = set()\n"
           "for k in itertools.product((-1, 0, 1), repeat=3):\n"
           "    for p, q in zip(m.centers + np.array(k) * L, m.radii):\n"
           "        gap = np.maximum(np.maximum(m.lower - p, p - m.upper), 0)\n"
           "        if (gap**2).sum() < q * q: want.add(tuple(np.round(p, 9)))\n"
           "got = [tuple(np.round(p, 9)) for p in c]\n"
           "print(len(got) == len(set(got)), set(got) == want, len(got) > len(m.centers), len(r) == len(c))",
           folder.path().string()})
          .wait();
  EXPECT_EQ(read.out, "True True True True\n") << read.err;
}

// It is listened to before the packing is read, which may take long.
TEST(ExportCommand, AnInterruptWhileReadingEndsInOrder) {
  const Packed result;
  const auto with_spheres = [&](const std::string& last) {
    std::ofstream spheres(result.folder / "out/spheres.csv");
    spheres << "# unit: mm\nx,y,z,r\n";
    for (int i = 0; i < 300'000; ++i) spheres << "0.5,0.5,0.5,0.1\n";
    spheres << last;
  };
  const std::vector<std::string> words = {BERNAL_COMMAND, "export", result.out(),           "--to",
                                          "npy",          "-o",     result.folder / "a.npy"};
  with_spheres("");
  const Process stopped(words);
  ASSERT_TRUE(stopped.listens_to(SIGINT));
  stopped.signal(SIGINT);
  const Ended ended = stopped.wait();
  EXPECT_EQ(ended.status, 3) << ended.err;
  EXPECT_FALSE(fs::exists(result.folder / "a.npy"));
  with_spheres("broken\n");  // which ends the reading, and the run
  const Process broken(words);
  EXPECT_TRUE(broken.listens_to(SIGINT));
  EXPECT_EQ(broken.wait().status, 2);
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

TEST(ExportCommand, ACaseOfASceneIsReplacedUnlessSomebodyWorkedInIt) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml",
                                         std::string(small_scene) + "[[output]]\nformat = \"snappy\"\n"),
                    out = folder / "out";
  const auto pack = [&] { return bernal({"pack", scene, "-o", out, "--quiet"}); };
  for (int k = 0; k < 2; ++k) {
    const Ended packed = pack();
    EXPECT_EQ(packed.status, 0) << packed.err;
  }
  std::ofstream(out + "/snappy/notes.txt") << "mine\n";
  expect_refused_in_one_line(pack(), {"snappy", "more in it than bernal wrote"});
  fs::remove(out + "/snappy/notes.txt");
  std::ofstream(out + "/snappy/system/controlDict", std::ios::app) << "// mine\n";
  expect_refused_in_one_line(pack(), {"snappy", "changed since"});
  EXPECT_TRUE(fs::exists(out + "/snappy/Allmesh"));
}

}  // namespace export_command_test
}  // namespace bernal::testing

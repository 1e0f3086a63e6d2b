#include <sys/stat.h>
#include <cctype>
#include <filesystem>
#include <regex>
#include <sstream>
#include <utility>

#include "check.hpp"

namespace bernal::testing {
namespace usage_test {

TEST(Usage, HelpNamesEverySubcommandWithExamples) {
  const Ended help = bernal({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string command : {"pack", "verify", "inspect", "explain", "keys", "cost", "measure",
                                    "export", "predict", "design", "map"}) {
    EXPECT_NE(help.out.find("\n  " + command), std::string::npos) << command;
    const Ended own = bernal({command, "--help"});
    EXPECT_EQ(own.status, 0);
    EXPECT_GT(own.out.size(), 100u) << own.out;
    EXPECT_EQ(own.err, "");
  }
  EXPECT_NE(help.out.find("Examples:"), std::string::npos);
}

TEST(Usage, NothingAtAllIsHelp) {
  const Ended alone = bernal({}), help = bernal({"--help"});
  EXPECT_EQ(alone.status, 0);
  EXPECT_EQ(alone.out, help.out);
}

TEST(Usage, AnUnknownCommandNamesTheNearest) {
  expect_refused_in_one_line(bernal({"pak"}), {"unknown command \"pak\"; did you mean \"pack\"?"});
  expect_refused_in_one_line(bernal({"design", "maximize"}), {"\"maximize\"; did you mean \"maximise\"?"});
  expect_refused_in_one_line(bernal({"qqqqqqqq"}), {"known: \"pack\", \"verify\""});
}

// The library names options between these marks; what users call their files is not changed by that.
TEST(Usage, MarksOfOptionsInNamesOfFilesStayInData) {
  const Folder folder;
  const std::string file = (folder / "\u2039unit\u203a.stl").string();
  std::filesystem::copy_file(std::filesystem::path(BERNAL_SOURCE) / "data/meshes/hopper.stl", file);
  const Ended inspected = bernal({"inspect", file, "--json"});
  EXPECT_NE(inspected.out.find(file), std::string::npos) << inspected.out;
}

TEST(Usage, NumbersThatAreNoneAreRefused) {
  for (const char* word : {"nan", "-nan", "NaN", "inf", "-1", "1e300"})
    expect_refused_in_one_line(bernal({"pack", "none.toml", "--checkpoint-every", word}),
                               {"--checkpoint-every"});
  expect_refused_in_one_line(bernal({"pack", "none.toml", "--threads", "1000000"}), {"--threads"});
}

TEST(Usage, KeysSaysWhatASceneMayHold) {
  const Ended all = bernal({"keys"}), one = bernal({"keys", "relax"});
  EXPECT_EQ(all.status, 0);
  EXPECT_NE(all.out.find("\n  relax "), std::string::npos) << all.out;
  EXPECT_EQ(one.status, 0);
  EXPECT_NE(one.out.find("patience = 12"), std::string::npos) << one.out;
  expect_refused_in_one_line(bernal({"keys", "relaks"}), {"did you mean \"relax\"?"});
}

TEST(Usage, KeysOfAGroupHasThoseOfItsTables) {
  const std::string all = bernal({"keys", "container"}).out, mesh = bernal({"keys", "mesh"}).out;
  std::istringstream lines(mesh);
  int keys = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  ") || line[2] == ' ') continue;
    const std::string name = line.substr(0, line.find_first_of(" ;", 2));
    EXPECT_NE(all.find("\n" + name), std::string::npos) << name;
    ++keys;
  }
  EXPECT_GT(keys, 10);
}

TEST(Usage, KeysFindsByWords) {
  // What people say, and the first key that they are to see.
  const std::pair<const char*, const char*> wishes[] = {{"roundness of the top", "top"},
                                                        {"heap", "heap_angle"},
                                                        {"porosity", "porosity"},
                                                        {"cap", "cap"},
                                                        {"how many spheres", "count"},
                                                        {"kg", "material_density"},
                                                        {"watertight", "cap"},
                                                        {"reproducible", "seed"},
                                                        {"void", "porosity"}};
  for (const auto& [words, key] : wishes) {
    const Ended found = bernal({"keys", words});
    EXPECT_EQ(found.status, 0) << found.err;
    EXPECT_TRUE(found.out.starts_with("Keys of a scene:\n  ")) << words << "\n" << found.out;
    EXPECT_NE(found.out.find(std::string("\n  ") + key), std::string::npos) << words << "\n" << found.out;
    EXPECT_NE(found.out.find("; in "), std::string::npos) << found.out;  // where it stands
  }
  // What is chosen by a word, too: shapes as people call them.
  for (const auto& [words, kind] :
       {std::pair{"frustum", "cone"}, {"annulus", "tube"}, {"hopper", "revolved"}})
    EXPECT_NE(bernal({"keys", words}).out.find(std::string("  kind = \"") + kind + "\"; in [container]"),
              std::string::npos)
        << words;
  // As one word or as several; an exact name of a table is that table.
  EXPECT_EQ(bernal({"keys", "top", "of", "bed"}).out, bernal({"keys", "top of bed"}).out);
  EXPECT_TRUE(bernal({"keys", "mesh"}).out.starts_with("mesh: "));
  // Options of commands, too.
  const Ended contacts = bernal({"keys", "neighbours"});
  EXPECT_NE(contacts.out.find("contact"), std::string::npos) << contacts.out;
  EXPECT_NE(bernal({"keys", "checkpoint"}).out.find("Options of commands:\n  bernal pack --"),
            std::string::npos);
  expect_refused_in_one_line(bernal({"keys", "xylophone"}), {"nothing in a scene is called \"xylophone\""});
}

TEST(Usage, HelpOfACommandIsItsHelp) {
  EXPECT_EQ(bernal({"help"}).out, bernal({"--help"}).out);
  EXPECT_EQ(bernal({"help", "pack"}).out, bernal({"pack", "--help"}).out);
  EXPECT_EQ(bernal({"help", "design", "target"}).out, bernal({"design", "target", "--help"}).out);
  EXPECT_EQ(bernal({"help", "pack"}).status, 0);
  expect_refused_in_one_line(bernal({"help", "pak"}), {"unknown command \"pak\"; did you mean \"pack\"?"});
  expect_refused_in_one_line(bernal({"help", "pack", "on"}),
                             {"bernal pack has no command", "leave \"on\" out"});
}

TEST(Usage, VersionIsOneLine) {
  const Ended version = bernal({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(std::ranges::count(version.out, '\n'), 1);
  const std::regex form(
      R"(bernal \d+\.\d+\.\d+ \(packings \d+, commit ([0-9a-f]{12}(\+changes)?|unknown)\)\n)");
  EXPECT_TRUE(std::regex_match(version.out, form)) << version.out;
  // A result says the same.
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene), out = folder / "out";
  ASSERT_EQ(bernal({"pack", scene, "-o", out, "--quiet"}).status, 0);
  const nlohmann::json report = report_of(out);
  const std::string said = report["version"].get<std::string>() + " (packings " +
                           std::to_string(report["packings_number"].get<int>()) + ", commit " +
                           report["commit"].get<std::string>() + ")";
  EXPECT_EQ("bernal " + said + "\n", version.out);
  EXPECT_NE(text_of(out + "/report.html").find("packed by bernal " + said), std::string::npos);
}

TEST(Usage, WrongOnesAreOneLineAndExitTwo) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string();
  const std::string out = (folder / "out").string();
  const std::vector<std::vector<std::string>> wrong = {
      {"--frobnicate"},
      {"pack"},
      {"pack", "-o", out},
      {"pack", scene, "-o", out, "--frobnicate"},
      {"pack", scene, "-o", out, "--threads", "0"},
      {"pack", scene, "-o", out, "--threads", "many"},
      {"pack", scene, "-o", out, "--threads", "-1"},
      {"pack", scene, "-o", out, "--seed", "-1"},
      {"pack", scene, "-o", out, "--seed", "1.5"},
      {"pack", scene, "-o", out, "--seed", "99999999999999999999"},
      {"pack", scene, "extra", "-o", out},
      {"verify"},
      {"explain"},
      {"explain", scene, "--jason"},
  };
  for (const auto& words : wrong) {
    std::string call;
    for (const std::string& word : words) call += word + " ";
    SCOPED_TRACE(call);
    expect_refused_in_one_line(bernal(words), {"see bernal", "--help"});
    EXPECT_EQ(std::filesystem::remove_all(out), 0u) << "something was written";
  }
}

TEST(Usage, NumbersThatAreNoneAndThoseBeyondAllBoundsAreRefused) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string();
  const std::string out = (folder / "out").string();
  for (const std::string number : {"nan", "-nan", "inf", "-inf", "1e300", "-1e101", "1e400"}) {
    const std::vector<std::vector<std::string>> wrong = {
        {"measure", out, "--gap", number},
        {"pack", scene, "-o", out, "--checkpoint-every", number},
        {"pack", "part.stl", "--unit", "mm", "-o", out, "--diameter", number},
        {"pack", "part.stl", "--unit", "mm", "-o", out, "--lognormal", "1," + number},
        {"map", "0.1", number, "-o", out},
        {"map", "0.1", "0.1", "-o", out, "--ratios", "1," + number},
        {"predict", "--lognormal", "0.5", "--gap-factor", number},
        {"predict", "--lognormal", "0.5", "--solids", number},
        {"design", "target", "--phi", number, "--family", "lognormal"},
        {"design", "best", "--min", "1", "--max", number},
        {"import", scene, "-o", out, "--diameter", number},
    };
    for (const auto& words : wrong) {
      SCOPED_TRACE(words.front() + " " + number);
      if (words[0] == "map" && words[2].starts_with('-') && !std::isdigit(words[2][1]))
        continue;  // an option
      expect_refused_in_one_line(bernal(words), {"must be a number from -1e+100 to 1e+100", "--help"});
    }
    EXPECT_FALSE(std::filesystem::exists(out));
  }
  for (const std::string number : {"-0.1", "1.5"})
    expect_refused_in_one_line(bernal({"measure", out, "--gap", number}), {"not in range"});
}

TEST(Usage, AFullDeviceIsNoSuccess) {
  for (const char* words : {"--version", "--help", "keys", "predict --lognormal 0.3"}) {
    const Ended full =
        Process({"sh", "-c", std::string("'" BERNAL_COMMAND "' ") + words + " > /dev/full"}).wait();
    expect_refused_in_one_line(full, {"standard output cannot be written"});
  }
}

// What a run says is not the run.
TEST(Usage, NoRunIsLostBecauseNobodyTakesItsWords) {
  const Folder folder;
  const std::string scene = folder.write("small.toml", small_scene), out = folder / "out";
  const std::string pack = "'" BERNAL_COMMAND "' pack '" + scene + "' -o '" + out + "' ";
  for (const char* nowhere :
       {"2> /dev/full", "> /dev/full 2>&1", "2>&- >&-", "2>&1 | true", "2>&1 | head -c 1"}) {
    std::filesystem::remove_all(out);
    const Ended ended = Process({"sh", "-c", "{ " + pack + nowhere + "; }"}).wait();
    EXPECT_EQ(ended.err, "") << nowhere;
    EXPECT_TRUE(std::filesystem::exists(out + "/report.json")) << nowhere;
  }
}

TEST(Usage, AReaderThatHasSeenEnoughIsNoFailure) {
  for (const char* words : {"keys", "--help", "predict --lognormal 0.3", "predict --lognormal 0.3 --json"})
    for (const char* reader : {"true", "head -c 1"}) {
      const Ended ended =
          Process(
              {"bash", "-c", std::string("set -o pipefail; '" BERNAL_COMMAND "' ") + words + " | " + reader})
              .wait();
      EXPECT_EQ(ended.status, 0) << words << " | " << reader;
      EXPECT_EQ(ended.err, "") << words << " | " << reader;
    }
}

TEST(Usage, NoNameIsNoFile) {
  expect_refused_in_one_line(bernal({"inspect", ""}), {"is the name of no file"});
  expect_refused_in_one_line(bernal({"pack", "scene.toml", "-o", ""}),
                             {"--output", "is the name of no file"});
}

std::string sizes_from(const std::string& table) {
  return "[container]\nkind = \"box\"\nsize = [9, 9, 9]\n[spheres]\ncount = 3\n"
         "diameter = { distribution = \"table\", file = \"" +
         table + "\" }\n";
}

// A reader of a pipe that nobody writes to would wait for ever, one of a device would never end.
TEST(Usage, PipesAndDevicesAreNoInput) {
  const Folder folder;
  const std::string pipe = folder / "pipe", scene = folder.write("small.toml", small_scene);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& file : {pipe, std::string("/dev/zero")}) {
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{"explain", file},
                                               {"pack", file, "--quiet"},
                                               {"inspect", file},
                                               {"verify", file, "--scene", scene},
                                               {"measure", file}})
      expect_refused_in_one_line(bernal(words), {file});
    folder.write("sizes.toml", sizes_from(file));
    expect_refused_in_one_line(bernal({"explain", folder / "sizes.toml"}), {file, "is a pipe or a device"});
  }
  // A glTF names other files, so that it is looked into before a reader has refused it.
  std::filesystem::create_symlink(pipe, folder / "pipe.gltf");
  std::filesystem::create_symlink("/dev/zero", folder / "zero.gltf");
  for (const char* name : {"pipe.gltf", "zero.gltf"}) {
    folder.write("part.toml", std::string("unit = \"mm\"\n[container]\nkind = \"mesh\"\nfile = \"") + name +
                                  "\"\n[spheres]\ncount = 3\nradius = 1\n");
    expect_refused_in_one_line(bernal({"explain", folder / "part.toml"}), {name, "is a pipe or a device"});
  }
  folder.write("sizes.toml", sizes_from("."));
  expect_refused_in_one_line(bernal({"explain", folder / "sizes.toml"}), {"is a folder"});
  folder.write("sizes.toml", sizes_from("none.csv"));
  expect_refused_in_one_line(bernal({"explain", folder / "sizes.toml"}), {"there is no file"});
}

}  // namespace usage_test
}  // namespace bernal::testing

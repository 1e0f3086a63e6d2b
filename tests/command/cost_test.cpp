#include <csignal>
#include <fstream>
#include <string>
#include <thread>

#include "check.hpp"

namespace bernal::testing {
namespace cost_command_test {

using nlohmann::json;

constexpr const char* tiny_box = R"([container]
kind = "periodic"
[spheres]
count = 60
radius = 1
)";

TEST(CostCommand, WritesItsFilesAndItsAdviceRuns) {
  const Folder folder;
  const std::string scene = folder.write("tiny.toml", tiny_box).string(), out = (folder / "out").string();
  const Ended ended = bernal({"cost", scene, "-o", out, "--time", "3s", "--seeds", "1"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  std::string files;
  for (const char* name : {"cost.csv", "cost.md", "cost.svg", "cost.html", "recommended.toml"})
    files += out + "/" + name + "\n";
  EXPECT_EQ(ended.out, files);
  EXPECT_NE(ended.err.find("advice"), std::string::npos) << ended.err;
  const std::string csv = text_of(out + "/cost.csv");
  EXPECT_TRUE(csv.starts_with("setting,phi,phi_scatter,seconds,seconds_scatter,largest_overlap,pareto,"))
      << csv;
  EXPECT_NE(csv.find("\"as it is\","), std::string::npos);
  EXPECT_TRUE(text_of(out + "/cost.html").ends_with("</body></html>\n"));

  // What is advised is what was measured.
  const Ended packed = bernal({"pack", out + "/recommended.toml", "-o", (folder / "packed").string()});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_NE(text_of(out + "/cost.md").find(report_of(folder / "packed")["hash"]), std::string::npos);
  const Ended again = bernal({"cost", scene, "-o", out, "--time", "1s", "--seeds", "1", "--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  const json report = json::parse(again.out);
  EXPECT_GT(report["runs_kept"], 0);
  EXPECT_FALSE(report["settings"].empty());
}

// What is expected of a mesh, by explain and by cost, beside what it is.
TEST(CostCommand, MeshesAreAboutAsExpected) {
  if (!std::filesystem::exists("/usr/bin/tetgen")) GTEST_SKIP() << "tetgen is not installed";
  const Folder folder;
  const std::string scene =
      folder
          .write("few.toml",
                 "unit = \"mm\"\n[container]\nkind = \"cylinder\"\nradius = 1.5\nheight = 3\n[spheres]\n"
                 "count = 15\ndiameter = 1\n")
          .string();
  const std::string out = (folder / "out").string();
  const Ended ended = bernal({"cost", scene, "-o", out, "--meshes", "--time", "20s", "--json", "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json report = json::parse(ended.out);
  EXPECT_EQ(report["spheres"], 15);
  ASSERT_EQ(report["meshes"].size(), 5U);
  ASSERT_FALSE(report["meshes"][0]["measured"].is_null());
  double before = 0, error_before = 1;
  for (const json& mesh : report["meshes"]) {
    EXPECT_EQ(mesh["neck_size"].get<double>(), mesh["mesh_size"].get<double>() / 2);
    const json &expected = mesh["expected"], &measured = mesh["measured"];
    EXPECT_GT(expected["tetrahedra"], before);
    before = expected["tetrahedra"];
    if (measured.is_null()) continue;
    for (const char* what : {"tetrahedra", "memory_bytes"}) {
      const double ratio = measured[what].get<double>() / expected[what].get<double>();
      EXPECT_GT(ratio, 0.5) << what << " at " << mesh["mesh_size"];
      EXPECT_LT(ratio, 2) << what << " at " << mesh["mesh_size"];
    }
    const double error = measured["meshed_porosity"].get<double>() - measured["porosity"].get<double>();
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 1.1 * error_before);
    error_before = error;
    if (mesh["mesh_size"] == 0.3) {
      const Ended explained = bernal({"explain", scene, "--json"});
      EXPECT_EQ(json::parse(explained.out)["expected"]["mesh"]["tetrahedra"], expected["tetrahedra"]);
    }
  }
  EXPECT_TRUE(text_of(out + "/meshes.csv").starts_with("sphere_edge,neck_edge,expected_tetrahedra,"));
  // Its own file it writes again, another one not.
  folder.write("out/meshes.csv", "mine");
  expect_refused_in_one_line(bernal({"cost", scene, "-o", out, "--meshes", "--time", "1s"}), {"meshes.csv"});
}

TEST(CostCommand, RefusesAbsurdInputInOneLine) {
  const Folder folder;
  const std::string scene = folder.write("tiny.toml", tiny_box).string(), out = (folder / "out").string();
  for (const char* time : {"0", "-3m", "10 minutes", "nan", "inf", "1e9h", "", "m"})
    expect_refused_in_one_line(bernal({"cost", scene, "-o", out, "--time", time}), {"--time"});
  expect_refused_in_one_line(bernal({"cost", scene, "-o", out, "--seeds", "0"}), {"--seeds"});
  expect_refused_in_one_line(bernal({"cost", scene}), {"output"});
  expect_refused_in_one_line(bernal({"cost", (folder / "none.toml").string(), "-o", out}), {"none.toml"});
  expect_refused_in_one_line(bernal({"cost", scene, "-o", "/proc/none"}), {"/proc/none"});
  const std::string wide =
      folder.write("wide.toml", "container = { kind = \"sphere\", radius = 1 }\n[spheres]\nradius = 3\n")
          .string();
  expect_refused_in_one_line(bernal({"cost", wide, "-o", out}), {"wide.toml"});
  const std::string large =
      folder.write("large.toml", std::string(tiny_box) + "[[stage]]\ndo = \"relax\"\nalpha = 1000\n")
          .string();
  std::string text = text_of(large);
  text.replace(text.find("60"), 2, "60000");
  folder.write("large.toml", text);
  expect_refused_in_one_line(bernal({"cost", large, "-o", out, "--time", "0.2"}), {"--time"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out" / "cost.md"));
  std::filesystem::create_directories(out);  // what was refused has left none
  std::ofstream(folder / "out" / "trials.csv") << "x,y,z,r\n";
  expect_refused_in_one_line(bernal({"cost", scene, "-o", out}), {"trials.csv"});
  expect_refused_in_one_line(bernal({"cost", scene, "-o", out, "--fresh"}), {"trials.csv", "remove it"});
  EXPECT_EQ(text_of(out + "/trials.csv"), "x,y,z,r\n") << "neither is what somebody else wrote removed";
}

TEST(CostCommand, WhatIsRefusedLeavesNoFolder) {
  const Folder folder;
  const std::string scene = folder.write("tiny.toml", tiny_box).string(),
                    bad = folder
                              .write("bad.toml",
                                     "[container]\nkind = \"box\"\nsize = [1, 1, 1]\n[spheres]\nradius = 9\n")
                              .string();
  const std::string out = (folder / "a/b").string();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{scene, "-o", out, "--time", "0.0001s"},
        {scene, "-o", out, "--seeds", "0"},
        {scene, "-o", out, "--threads", "2000"},
        {bad, "-o", out},
        {(folder / "none.toml").string(), "-o", out}}) {
    std::vector<std::string> call = {"cost"};
    call.insert(call.end(), words.begin(), words.end());
    const Ended ended = bernal(call);
    EXPECT_EQ(ended.status, 2) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "a")) << ended.err;
  }
  std::filesystem::create_directories(out);  // what was there stays
  EXPECT_EQ(bernal({"cost", bad, "-o", out}).status, 2);
  EXPECT_TRUE(std::filesystem::exists(out));
}

TEST(CostCommand, RefusesToReplaceWhatItDidNotWrite) {
  const Folder folder;
  const std::string scene = folder.write("tiny.toml", tiny_box).string(), out = (folder / "out").string();
  const std::vector<std::string> again = {"cost", scene, "-o", out, "--time", "0.5s", "--seeds", "1"};
  ASSERT_EQ(bernal(again).status, 0);
  ASSERT_EQ(bernal(again).status, 0) << "its own files it replaces";
  std::vector<std::string> afresh = again;
  afresh.push_back("--fresh");
  ASSERT_EQ(bernal(afresh).status, 0);
  // The scene that it reads it never replaces.
  const std::string advised = out + "/recommended.toml", text = text_of(advised);
  expect_refused_in_one_line(bernal({"cost", advised, "-o", out}), {"recommended.toml", "-o"});
  EXPECT_EQ(text_of(advised), text);
  std::ofstream(advised, std::ios::app) << "# mine\n";
  expect_refused_in_one_line(bernal(again), {"recommended.toml", "remove it", "-o"});
  EXPECT_EQ(text_of(advised), text + "# mine\n");
  std::filesystem::remove(advised);
  ASSERT_EQ(bernal(again).status, 0);
  // What is in the way is seen before anything runs.
  std::filesystem::remove(out + "/cost.md");
  std::filesystem::create_directory(out + "/cost.md");
  expect_refused_in_one_line(bernal({"cost", scene, "-o", out, "--time", "10m"}), {"cost.md", "folder"});
  const std::string other = (folder / "other").string();
  std::filesystem::create_directory(other);
  std::ofstream(other + "/cost.csv") << "costs,of,something,else";
  expect_refused_in_one_line(bernal({"cost", scene, "-o", other, "--time", "10m"}), {"cost.csv"});
  EXPECT_EQ(text_of(other + "/cost.csv"), "costs,of,something,else");
  EXPECT_FALSE(std::filesystem::exists(other + "/trials.csv"));
}

TEST(CostCommand, ShowsNamesAsTextAndSaysNothingOfThreads) {
  const Folder folder;
  const std::string scene = folder.write("a<script>x.toml", tiny_box).string(),
                    out = (folder / "out").string();
  const Ended ended =
      bernal({"cost", scene, "-o", out, "--time", "0.5s", "--seeds", "1", "--threads", "300"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err.find("TBB"), std::string::npos) << ended.err;
  for (const char* file : {"cost.md", "cost.html", "cost.svg"})
    EXPECT_EQ(text_of(out + "/" + file).find("<script>"), std::string::npos) << file;
}

TEST(CostCommand, AnInterruptKeepsWhatIsMeasured) {
  const Folder folder;
  std::string text = tiny_box;
  text.replace(text.find("60"), 2, "600");
  const std::string scene = folder.write("scene.toml", text).string(), out = (folder / "out").string();
  const Process cost = start_bernal({"cost", scene, "-o", out, "--time", "10m"});
  const auto lines = [&] {
    std::ifstream in(folder / "out" / "trials.csv");
    return std::count(std::istreambuf_iterator<char>(in), {}, '\n');
  };
  for (int k = 0; k < 600 && lines() < 6; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  cost.signal(SIGINT);
  const Ended ended = cost.wait();
  EXPECT_EQ(ended.status, 3) << ended.err;
  EXPECT_NE(ended.err.find("goes on from here"), std::string::npos) << ended.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "cost.md"));
  EXPECT_GE(lines(), 6);
}

}  // namespace cost_command_test
}  // namespace bernal::testing

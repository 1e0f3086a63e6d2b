#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <thread>

#include "check.hpp"
#include "support/scenes.hpp"

namespace bernal::testing {
namespace pack_test {

/// Name and text of every file of a folder.
std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = text_of(entry.path());
  return files;
}

void expect_certified(const std::filesystem::path& folder) {
  const Ended verified = bernal({"verify", folder.string()});
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
}

TEST(Pack, WritesEveryFileOfTheContract) {
  const Folder folder;
  const Ended packed =
      bernal({"pack", folder.write("scene.toml", small_scene).string(), "-o", (folder / "out").string()});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_EQ(packed.out, "");
  const auto files = files_in(folder / "out");
  std::vector<std::string> names;
  for (const auto& [name, text] : files) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"packing.svg", "report.html", "report.json", "scene.toml",
                                             "section.svg", "spheres.csv", "spheres.vtp"}));
  EXPECT_TRUE(files.at("spheres.csv").starts_with("# unit: mm\nx,y,z,r\n"));
  EXPECT_EQ(std::ranges::count(files.at("spheres.csv"), '\n'), 302);

  const auto report = report_of(folder / "out");
  EXPECT_EQ(report["outcome"], "converged");
  EXPECT_EQ(report["n"], 300);
  EXPECT_EQ(report["certified"], true);
  EXPECT_EQ(report["unit"], "mm");
  EXPECT_LE(report["max_overlap"].get<double>(), 0);
  expect_certified(folder / "out");

  // What was understood, and where the files are.
  for (const std::string word : {"box", "mm", "diameter", "300", "spheres.csv"})
    EXPECT_NE(packed.err.find(word), std::string::npos) << word << "\nis not in:\n" << packed.err;
}

TEST(Pack, SaysOnceHowTheSceneIsUnderstood) {
  const Folder folder;
  const Ended packed =
      bernal({"pack", folder.write("scene.toml", small_scene).string(), "-o", (folder / "out").string()});
  const std::string note = "note       300 spheres will float in the container";
  ASSERT_NE(packed.err.find(note), std::string::npos) << packed.err;
  EXPECT_EQ(packed.err.find(note), packed.err.rfind(note));
  const Ended explained = bernal({"explain", (folder / "scene.toml").string()});
  EXPECT_NE(explained.out.find(note), std::string::npos) << explained.out;
  EXPECT_EQ(report_of(folder / "out")["notes"].size(), 1U);
}

// A name may hold what moves a terminal's cursor or turns the direction of writing.
TEST(Pack, TheNameOfAMeshReachesNoTerminalAndNoPageRaw) {
  const Folder folder;
  const std::string mesh = folder / "a\x1b[31m\xe2\x80\xaelts\xc2\x9b.stl";
  std::filesystem::copy(BERNAL_DATA "/meshes/hopper.stl", mesh);
  const Ended packed = bernal({"pack", mesh, "--unit", "m", "--diameter", "0.5", "-o", folder / "out"});
  EXPECT_EQ(packed.status, 0) << packed.err;
  for (const std::string& text : {packed.out, packed.err, text_of(folder / "out/report.html"),
                                  text_of(folder / "out/scene.toml"), text_of(folder / "out/report.json")})
    for (const char* raw : {"\x1b[31m", "\xe2\x80\xae", "\xc2\x9b"}) EXPECT_EQ(text.find(raw), text.npos);
  EXPECT_EQ(bernal({"verify", folder / "out"}).status, 0);  // which finds the mesh by its name
}

/// The command called from within a folder.
Ended bernal_in(const Folder& folder, const std::string& words) {
  return Process({"sh", "-c", "cd '" + folder.path().string() + "' && '" BERNAL_COMMAND "' " + words}).wait();
}

TEST(Pack, NamesTheFolderAfterTheScene) {
  const Folder folder;
  folder.write("small.toml", small_scene);
  const Ended packed = bernal_in(folder, "pack small.toml --quiet");
  EXPECT_EQ(packed.status, 0) << packed.err;
  expect_certified(folder / "small");
}

TEST(Pack, AMeshNeedsNoScene) {
  const Folder folder;
  const std::string mesh = BERNAL_DATA "/meshes/hopper.stl";
  const Ended packed = bernal_in(folder, "pack " + mesh + " --unit m --lognormal 0.12,0.1");
  EXPECT_EQ(packed.status, 0) << packed.err;
  expect_certified(folder / "hopper");

  // It prints the scene that the flags stand for.
  folder.write("again.toml", packed.out);
  EXPECT_EQ(bernal_in(folder, "pack again.toml --quiet").status, 0);
  EXPECT_EQ(report_of(folder / "again")["hash"], report_of(folder / "hopper")["hash"]);

  expect_refused_in_one_line(bernal_in(folder, "pack " + mesh + " --diameter 30"), {"such as --unit mm"});
  expect_refused_in_one_line(bernal_in(folder, "pack " + mesh + " --unit mm --diameter -2"),
                             {"positive length, not -2"});
  expect_refused_in_one_line(bernal_in(folder, "pack again.toml --diameter 2"), {"leave out --diameter"});
  expect_refused_in_one_line(bernal_in(folder, "pack again.toml --unit mm"), {"--unit is for a mesh"});
  expect_refused_in_one_line(bernal_in(folder, "pack again.toml --fill --count 3"),
                             {"--count excludes --fill"});
  expect_refused_in_one_line(bernal_in(folder, "explain again.toml --radius 2"), {"leave out --radius"});
}

TEST(Pack, AMeshTakesCountFillRadiusCapAndItsOwnUnit) {
  const Folder folder;
  // A cube of 10 mm, without its top, in inches.
  std::string open = "OFF\n8 5 0\n";
  for (const char* corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1"})
    open += std::string(corner) + "\n";
  for (const char* face : {"4 0 3 2 1", "4 0 1 5 4", "4 1 2 6 5", "4 2 3 7 6", "4 3 0 4 7"})
    open += std::string(face) + "\n";
  folder.write("open.off", open);
  const std::string flags = "open.off --unit mm --file-unit in --cap 'z = 12.7'";
  const Ended packed = bernal_in(folder, "pack " + flags + " --radius 1 --count 50");
  EXPECT_EQ(packed.status, 0) << packed.err;
  expect_certified(folder / "open");
  const auto report = report_of(folder / "open");
  EXPECT_EQ(report["n"], 50);
  EXPECT_EQ(report["unit"], "mm");
  EXPECT_NEAR(report["container"]["volume"].get<double>(), 25.4 * 25.4 * 12.7, 1e-9);
  EXPECT_NE(packed.out.find("radius = { distribution = \"constant\", value = 1 }"), std::string::npos)
      << packed.out;

  EXPECT_EQ(bernal_in(folder, "pack " + flags + " --diameter 5 --fill --quiet -o filled").status, 0);
  EXPECT_NE(text_of(folder / "filled/scene.toml").find("fill = true"), std::string::npos);
  expect_certified(folder / "filled");

  // Lengths may carry units of their own.
  const Ended mixed = bernal_in(
      folder, "explain open.off --unit mm --file-unit in --cap 'z = 0.5 in' --radius '0.1 cm' --count 50");
  EXPECT_EQ(mixed.out, bernal_in(folder, "explain " + flags + " --radius 1 --count 50").out) << mixed.err;
  const Ended lognormal = bernal_in(folder, "explain " + flags + " --lognormal '1 phi,0.3 phi' --json");
  EXPECT_NE(lognormal.out.find("lognormal, median 0.5, sigma 0.2079"), std::string::npos) << lognormal.out;
  expect_refused_in_one_line(bernal_in(folder, "explain " + flags + " --radius '3 ells'"),
                             {"--radius must be", "unit \"ells\" is unknown; use one of nm, um, mm"});
  expect_refused_in_one_line(bernal_in(folder, "explain " + flags + " --diameter 2,5"),
                             {"--diameter must be", "it has a decimal comma; write a point, \"2.5\""});

  // The unit of the file alone is that of all lengths.
  const Ended inches = bernal_in(folder, "explain open.off --file-unit in --cap z=1 --diameter 0.1 --json");
  EXPECT_EQ(inches.status, 0) << inches.err;
  EXPECT_EQ(nlohmann::json::parse(inches.out)["unit"], "in");
}

TEST(Explain, AMeshIsExplainedAsItIsPackedAndWithoutSizesSaysWhatIsMissing) {
  const Folder folder;
  const std::string mesh = BERNAL_DATA "/meshes/hopper.stl";
  const Ended explained = bernal({"explain", mesh, "--unit", "m", "--diameter", "0.12", "--count", "100"});
  EXPECT_EQ(explained.status, 0) << explained.err;
  EXPECT_NE(explained.out.find("spheres    100; diameter in m"), std::string::npos) << explained.out;
  expect_refused_in_one_line(bernal({"explain", mesh}), {"is a mesh, not a scene", "--unit mm --diameter 2"});
  expect_refused_in_one_line(bernal({"pack", mesh, "--count", "5"}),
                             {"is a mesh, not a scene", "--diameter 2"});
}

TEST(Pack, AFileThatSaysItsUnitNeedsNone) {
  const Folder folder;
  folder.write("cube.amf",
               R"(<amf unit="inch"><object id="0"><mesh><vertices>
<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>2</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>2</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>0</y><z>2</z></coordinates></vertex></vertices><volume>
<triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle><triangle><v1>0</v1><v2>1</v2><v3>3</v3></triangle>
<triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle><triangle><v1>1</v1><v2>2</v2><v3>3</v3></triangle>
</volume></mesh></object></amf>)");
  const Ended packed = bernal_in(folder, "pack cube.amf --diameter 0.2");
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_EQ(report_of(folder / "cube")["unit"], "in");
  EXPECT_NEAR(report_of(folder / "cube")["container"]["volume"].get<double>(), 8.0 / 6, 1e-12);

  // OpenCASCADE converts to millimetres, and the diameter is in inches all the same.
  if (bernal({"inspect", BERNAL_DATA "/meshes/round_bodies_inch.step"}).status == 0) {
    EXPECT_EQ(
        bernal_in(folder, "pack " BERNAL_DATA "/meshes/round_bodies_inch.step --diameter 5 -o step").status,
        0);
    EXPECT_EQ(report_of(folder / "step")["unit"], "in");
  }

  std::filesystem::copy(BERNAL_DATA "/meshes/hopper.stl", folder / "hopper.stl");
  expect_refused_in_one_line(bernal_in(folder, "pack hopper.stl --diameter 30"),
                             {"hopper.stl", "does not say its unit", "units large", "such as --unit mm"});
}

TEST(Pack, QuietSaysNothing) {
  const Folder folder;
  const Ended packed = bernal(
      {"pack", folder.write("scene.toml", small_scene).string(), "-o", (folder / "out").string(), "--quiet"});
  EXPECT_EQ(packed.status, 0);
  EXPECT_EQ(packed.out + packed.err, "");
}

TEST(Pack, WrittenSceneGivesTheSamePacking) {
  const Folder folder;
  const std::string first = (folder / "first").string(), second = (folder / "second").string();
  ASSERT_EQ(
      bernal({"pack", folder.write("scene.toml", small_scene).string(), "-o", first, "--seed", "7"}).status,
      0);
  ASSERT_EQ(bernal({"pack", first + "/scene.toml", "-o", second}).status, 0);
  EXPECT_EQ(report_of(first)["seed"], 7);
  EXPECT_EQ(text_of(first + "/spheres.csv"), text_of(second + "/spheres.csv"));
  EXPECT_EQ(text_of(first + "/scene.toml"), text_of(second + "/scene.toml"));
}

TEST(Pack, OneSeedGivesOneHashForAnyNumberOfThreads) {
  const Folder folder;
  const std::string file =
      folder
          .write("scene.toml",
                 "[container]\nkind = \"cylinder\"\nradius = 3\nheight = 6\n[spheres]\nradius = 0.5\n")
          .string();
  const auto hash = [&](const std::string& name, const std::string& threads, const std::string& seed) {
    const std::string out = (folder / name).string();
    EXPECT_EQ(bernal({"pack", file, "-o", out, "--threads", threads, "--seed", seed}).status, 0);
    return report_of(out)["hash"].get<std::string>();
  };
  const std::string one = hash("one", "1", "5");
  EXPECT_EQ(one, hash("two", "2", "5"));
  EXPECT_NE(one, hash("other", "1", "6"));
}

TEST(Pack, CountThatDoesNotFitIsAnOutcome) {
  const Folder folder;
  std::string scene = small_scene;
  scene.replace(scene.find("count = 300"), 11, "count = 3000");
  const std::string out = (folder / "out").string();
  const Ended packed = bernal({"pack", folder.write("scene.toml", scene).string(), "-o", out});
  EXPECT_EQ(packed.status, 3) << packed.err;
  EXPECT_EQ(report_of(out)["outcome"], "full");
  EXPECT_EQ(report_of(out)["certified"], true);
  expect_certified(out);
}

TEST(Pack, EveryExampleSceneSmall) {
  for (const auto& file : example_scenes()) {
    SCOPED_TRACE(file.string());
    const Folder folder;
    const Scene few = small(read_scene(file), 200);  // or as many as a list has
    const auto scene = folder.write("scene.toml", scene_as_toml(few, folder.path()));
    const std::string out = (folder / "out").string();
    const Ended packed = bernal({"pack", scene.string(), "-o", out});
    EXPECT_EQ(packed.status, 0) << packed.err;
    EXPECT_EQ(report_of(out)["n"], *few.target.count);
    expect_certified(out);
  }
}

TEST(Pack, UnwritableOutputIsRefusedBeforeTheRun) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string();
  const std::string in_the_way = folder.write("in_the_way", "precious").string();
  for (const std::string& out :
       {in_the_way, in_the_way + "/deeper", std::string("/dev/full/x"), std::string("/proc/x")})
    expect_refused_in_one_line(bernal({"pack", scene, "-o", out}), {out});
  EXPECT_EQ(text_of(in_the_way), "precious");
}

TEST(Pack, FullDiskLeavesEarlierOutputUntouched) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string(), out = (folder / "out").string();
  ASSERT_EQ(bernal({"pack", scene, "-o", out}).status, 0);
  const auto earlier = files_in(out);
  // A limit of one block on the size of files stops writing as a full disk does.
  const Ended full = Process({"/bin/sh", "-c", "ulimit -f 1; exec \"$@\"", "sh", BERNAL_COMMAND, "pack",
                              scene, "-o", out, "--seed", "2"})
                         .wait();
  expect_refused(full, {out});
  EXPECT_EQ(files_in(out), earlier);
  expect_certified(out);
}

TEST(Pack, InterruptLeavesAValidPartialResult) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Folder folder;
    const std::string out = (folder / "out").string();
    const Process pack = start_bernal({"pack", BERNAL_DATA "/scenes/cylinder_han.toml", "-o", out});
    while (pack.said().find("spheres ") == std::string::npos)  // the plan: from here on it listens
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    pack.signal(signal);
    const Ended ended = pack.wait();
    EXPECT_EQ(ended.status, 3) << ended.err;
    const auto report = report_of(out);
    EXPECT_EQ(report["outcome"], "cancelled");
    EXPECT_EQ(report["certified"], true);
    EXPECT_GT(report["n"], 0);
    expect_certified(out);
  }
}

}  // namespace pack_test
}  // namespace bernal::testing

#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "bernal/core/text.hpp"
#include "bernal/formats/import.hpp"
#include "check.hpp"
#include "support/packings.hpp"

namespace bernal::testing {
namespace import_command_test {

namespace fs = std::filesystem;

/// 300 spheres anywhere in a periodic box of 10 x 10 x 10, which overlap, as a dump whose lines come in no
/// order.
std::string overlapping_dump() {
  Random random(3, stream(Stream::test));
  std::string text =
      "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n300\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 10\n"
      "ITEM: ATOMS id x y z radius\n";
  for (int i = 300; i > 0; --i) {
    const Vector<3> c = uniform_point(random, Bounds<3>{Vector<3>::Zero(), Vector<3>::Constant(10)});
    text += fmt::format("{} {} {} {} {}\n", i, c[0], c[1], c[2], i % 2 ? 0.6 : 0.7);
  }
  return text;
}

std::size_t lines_that_begin(const std::string& text, const std::string& word) {
  std::size_t count = text.starts_with(word);
  for (std::size_t at = 0; (at = text.find("\n" + word, at)) != text.npos; ++at) ++count;
  return count;
}

// The whole way of another program's packing: imported, refused, densified from there, certified.
TEST(ImportCommand, ImportedRefusedDensifiedCertified) {
  const Folder folder;
  const std::string dump = folder.write("a.dump", overlapping_dump()), out = folder / "out",
                    dense = folder / "dense";
  const Ended imported = bernal({"import", dump, "--unit", "mm", "-o", out});
  EXPECT_EQ(imported.status, 0) << imported.err;
  EXPECT_EQ(imported.out, "");
  EXPECT_EQ(lines_that_begin(imported.err, "overlap "), 10U) << imported.err;
  EXPECT_EQ(lines_that_begin(imported.err, "certified  NO"), 1U) << imported.err;
  for (const char* word : {"dump: frame 1 of 1, step \"5\"", "300", "periodic box", "as the file says"})
    EXPECT_NE(imported.err.find(word), std::string::npos) << word << "\nis not in: " << imported.err;
  const nlohmann::json report = report_of(out);
  EXPECT_EQ(report["outcome"], "imported");
  EXPECT_EQ(report["certified"], false);
  EXPECT_EQ(report["n"], 300);
  EXPECT_TRUE(report["expected_phi"].is_null());
  ASSERT_EQ(report["certificate"]["overlaps"].size(), 10U);
  EXPECT_EQ(report["certificate"]["overlaps"][0]["ratio"], report["max_overlap"]);

  const std::string page = text_of(folder / "out/report.html");
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = page.find("<td>overlap</td>", at)) != page.npos; ++at) ++rows;
  EXPECT_EQ(rows, 10U);

  const Ended refused = bernal({"verify", out, "--list=10"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(lines_that_begin(refused.out, "overlap "), 10U) << refused.out;
  const Ended measured = bernal({"measure", out});
  EXPECT_EQ(measured.status, 0);
  EXPECT_EQ(measured.out.find("asked for"), std::string::npos);  // of nobody
  EXPECT_EQ(bernal({"export", out, "--to", "lammps", "-o", folder / "a.data"}).status, 0);

  const std::string scene =
      folder.write("dense.toml",
                   "unit = \"mm\"\n[container]\nkind = \"periodic\"\nscalable = true\n"
                   "[spheres]\nstart = \"out\"\n[[stage]]\ndo = \"relax\"\nalpha = 1\n");
  const Ended packed = bernal({"pack", scene, "-o", dense});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_GT(report_of(dense)["phi"], report["phi"]);
  EXPECT_EQ(report_of(dense)["n"], 300);
  EXPECT_EQ(bernal({"verify", dense}).status, 0);
}

// The scene of the result goes on from its spheres by itself.
TEST(ImportCommand, ItsSceneFreesTheSpheresWhereTheyAre) {
  const Folder folder;
  const std::string table =
                        folder.write("a.csv", "x,y,z,d\n1,1,1,1\n1.5,1,1,1\n3,3,3,1\n3,3.2,3,1\n0.2,2,2,1\n"),
                    out = folder / "out";
  const Ended imported = bernal({"import", table, "--columns", "x,y,z,d", "--unit", "mm", "--box", "4,4,4",
                                 "--periodic", "xy", "-o", out});
  EXPECT_EQ(imported.status, 0) << imported.err;
  EXPECT_EQ(lines_that_begin(imported.err, "overlap "), 2U) << imported.err;
  EXPECT_EQ(bernal({"verify", out}).status, 1);
  const Ended packed = bernal({"pack", out + "/scene.toml", "-o", folder / "freed"});
  EXPECT_EQ(packed.status, 0) << packed.err;
  EXPECT_EQ(report_of(folder / "freed")["n"], 5);
  EXPECT_EQ(bernal({"verify", folder / "freed"}).status, 0);
  const Ended protruding = bernal(
      {"import", table, "--unit", "mm", "--box", "0.4 cm,4,4 mm", "--periodic", "none", "-o", folder / "walls"});
  EXPECT_EQ(protruding.status, 0) << protruding.err;
  EXPECT_NE(protruding.err.find("\nprotrudes  4, gap -0.6 of its radius"), std::string::npos)
      << protruding.err;
}

TEST(ImportCommand, HelpListsEveryFormat) {
  const std::string help = bernal({"import", "--help"}).out;
  const auto in_words = [](const std::string& text) {
    return with_options(text,
                        [](std::string_view name, std::string_view) { return "--" + std::string(name); });
  };
  for (const ImportFormat& format : import_formats()) {
    const std::size_t at = help.find("\n  " + format.name + " ");
    ASSERT_NE(at, std::string::npos) << format.name;
    EXPECT_NE(help.find("unit: " + in_words(format.unit), at), std::string::npos);
    for (const std::string& option : format.options)
      EXPECT_NE(help.find("--" + option, at), std::string::npos) << option;
  }
}

TEST(ImportCommand, RefusesInOneLine) {
  const Folder folder;
  const std::string file = folder.write("a.csv", "x,y,z,r\n1,1,1,1\n"), out = folder / "out";
  const auto refused = [&](std::vector<std::string> words, const std::vector<std::string>& said) {
    words.insert(words.begin(), "import");
    words.insert(words.end(), {"-o", out});
    expect_refused_in_one_line(bernal(words), said);
    EXPECT_FALSE(fs::exists(out));
  };
  refused({file}, {"a.csv", "--unit mm"});
  refused({file, "--unit", "parsec"}, {"parsec", "nm"});
  refused({file, "--unit", "mm", "--box", "1,1"}, {"--box", "3 dimensions"});
  refused({file, "--unit", "mm", "--box", "1,1,0"}, {"--box"});
  refused({file, "--unit", "mm", "--box", "0.1,0.1,0.1"}, {"times the volume", "--unit"});
  refused({file, "--unit", "mm", "--periodic", "xyz"}, {"--periodic needs a box", "--box"});
  refused({file, "--unit", "mm", "--box", "9,9,9", "--periodic", "xw"}, {"--periodic", "xyz"});
  refused({file, "--unit", "mm", "--box", "9,9,9", "--periodic", ""}, {"--periodic", "none"});
  refused({file, "--unit", "mm", "--shift", "1"}, {"--shift", "3 dimensions"});
  refused({file, "--unit", "mm", "--container", folder / "none.toml"}, {"none.toml"});
  refused({file, "--unit", "mm", "--from", "gsd"}, {"a.csv"});
  std::string piled = "x,y,z,r\n";  // in a box so wide that their volume says nothing
  for (int i = 0; i < 1700; ++i) piled += "1,1,1,0.1\n";
  refused({folder.write("piled.csv", piled).string(), "--unit", "mm", "--box", "99,99,99", "--quiet"},
          {"piled.csv", "pairs", "check its sizes"});
  refused({"/dev/stdin", "--unit", "mm"}, {"/dev/stdin", "save"});
  refused({folder.path().string(), "--unit", "mm"}, {"is a folder"});
  // What is read from stays.
  const fs::path own = folder.path() / "own";
  fs::create_directory(own);
  const std::string spheres = folder.write("own/spheres.csv", "x,y,z,r\n1,1,1,1\n");
  expect_refused_in_one_line(bernal({"import", spheres, "--unit", "mm", "-o", own}),
                             {"spheres.csv", "is the file being imported", "another folder"});
  EXPECT_EQ(text_of(spheres), "x,y,z,r\n1,1,1,1\n");
}

TEST(ImportCommand, ASceneSaysTheContainer) {
  const Folder folder;
  const std::string file = folder.write("a.csv", "# unit: cm\nx,y,z,r\n0.5,0.5,0.5,0.1\n0.5,0.5,0.98,0.1\n");
  const std::string scene = folder.write("s.toml", small_scene);
  const Ended imported = bernal({"import", file, "--container", scene, "-o", folder / "out"});
  EXPECT_EQ(imported.status, 0) << imported.err;
  EXPECT_EQ(report_of(folder / "out")["unit"], "mm");
  EXPECT_EQ(report_of(folder / "out")["container"]["volume"], 1000);
  EXPECT_NE(imported.err.find("protrudes  1, gap -0.8"), std::string::npos) << imported.err;
}

// Reading takes a blink: the interrupt comes while the spheres are certified or measured.
TEST(ImportCommand, AnInterruptLeavesTheEarlierResult) {
  const Folder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(bernal({"import", folder.write("a.csv", "# unit: mm\nx,y,z,r\n1,1,1,1\n"), "-o", out}).status, 0);
  const std::string before = text_of(folder / "out/report.json");
  std::string grid = "# unit: mm\nx,y,z,r\n";
  for (int i = 0; i < 512000; ++i) grid += fmt::format("{},{},{},0.5\n", i % 80, i / 80 % 80, i / 6400);
  const std::string file = folder.write("b.csv", grid);
  for (const int signal : {SIGINT, SIGTERM}) {
    const Process stopped = start_bernal({"import", file, "-o", out});
    ASSERT_TRUE(stopped.listens_to(signal));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stopped.signal(signal);
    const Ended ended = stopped.wait();
    EXPECT_EQ(ended.status, 3) << ended.err;
    EXPECT_NE(ended.err.find("nothing is written"), std::string::npos) << ended.err;
    EXPECT_EQ(text_of(folder / "out/report.json"), before);
  }
}

}  // namespace import_command_test
}  // namespace bernal::testing

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "scene/schema.hpp"
#include "support/folder.hpp"
#include "support/scenes.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;
using schema::Type;

/// A whole scene around the part that a test is about; that part stands from line 2 on.
std::string with_container(const std::string& body) {
  return "unit = \"mm\"\n[container]\n" + body + "\n[spheres]\nradius = 1\n";
}
std::string with_spheres(const std::string& body) {
  return "container = { kind = \"sphere\", radius = 9 }\n[spheres]\n" + body + "\n";
}
std::string with_stage(const std::string& body) {
  return with_spheres("radius = 1") + "[[stage]]\n" + body + "\n";
}

/// The same values; where they stand does not count.
void expect_equal(const Spec& a, const Spec& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.parameters.size(), b.parameters.size());
  for (const auto& [key, parameter] : a.parameters) {
    ASSERT_TRUE(b.has(key)) << key;
    // A double that is whole is written as 1 and read back as 1.0.
    EXPECT_EQ(parameter.value, b.parameters.find(key)->second.value) << a.name << " " << key;
  }
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) expect_equal(a.parts[i], b.parts[i]);
}

void expect_equal(const Scene& a, const Scene& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.seed, b.seed);
  expect_equal(a.container, b.container);
  expect_equal(a.sizes, b.sizes);
  EXPECT_EQ(a.sizes_are_diameters, b.sizes_are_diameters);
  EXPECT_EQ(a.draw, b.draw);
  EXPECT_EQ(a.target.count, b.target.count);
  EXPECT_EQ(a.target.packing_fraction, b.target.packing_fraction);
  EXPECT_EQ(a.target.predicted, b.target.predicted);
  EXPECT_EQ(a.target.fill, b.target.fill);
  EXPECT_EQ(a.walls, b.walls);
  EXPECT_EQ(a.overlap, b.overlap);
  ASSERT_EQ(a.stages.size(), b.stages.size());
  for (std::size_t i = 0; i < a.stages.size(); ++i) expect_equal(a.stages[i], b.stages[i]);
}

TEST(Scene, TheLeastOneHasEveryDefault) {
  const Scene scene =
      parse_scene("[container]\nkind = \"box\"\nsize = [1, 2, 3]\n[spheres]\ndiameter = 0.1\n", "s.toml");
  EXPECT_EQ(scene.file, "s.toml");
  EXPECT_EQ(scene.unit, "m");
  EXPECT_EQ(scene.seed, 1u);
  EXPECT_EQ(scene.container.name, "box");
  EXPECT_EQ(scene.container.numbers("size"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(scene.container.numbers("corner"), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(scene.container.location("size").text(), "s.toml:3");
  EXPECT_EQ(scene.container.location("corner").text(), "s.toml");
  EXPECT_EQ(scene.sizes.name, "constant");
  EXPECT_EQ(scene.sizes.number("value"), 0.1);
  EXPECT_TRUE(scene.sizes_are_diameters);
  EXPECT_TRUE(scene.target.is_open());
  EXPECT_FALSE(scene.target.fill);
  EXPECT_EQ(scene.walls, "filtered");
  EXPECT_EQ(scene.overlap, 0);
  EXPECT_TRUE(scene.stages_are_default);
  std::vector<std::string> protocol;
  for (const Spec& stage : scene.stages) protocol.push_back(stage.name);
  EXPECT_EQ(protocol, (std::vector<std::string>{"relax"}));
  EXPECT_EQ(scene.stages[0].integer("patience"), 12);
  EXPECT_EQ(scene.draw, "quantiles");
}

TEST(Scene, KeepsWhatTheUserWrote) {
  const Scene scene = parse_scene(R"(unit = "mm"
seed = 9223372036854775807
[container]
kind = "mesh"
file = "../parts/a b.stl"
[spheres]
packing_fraction = 0.4
radius = { distribution = "lognormal", median = 1, sigma = 0.3, max = 2, basis = "volume" }
[accuracy]
walls = "exact"
overlap = 1e-3
[[stage]]
do = "refill"
max_rounds = 7
[[stage]]
do = "compress"
direction = [1, 0.5, -2]
)",
                                  "/tmp/scenes/s.toml");
  EXPECT_EQ(scene.seed, 9223372036854775807u);
  EXPECT_EQ(scene.container.text("file"), "/tmp/parts/a b.stl");
  EXPECT_EQ(scene.container.text("unit"), "mm");
  EXPECT_EQ(scene.target.packing_fraction, 0.4);
  EXPECT_FALSE(scene.target.fill);
  EXPECT_FALSE(scene.sizes_are_diameters);
  EXPECT_EQ(scene.sizes.number("max"), 2);
  EXPECT_FALSE(scene.sizes.has("min"));
  EXPECT_EQ(scene.sizes.text("basis"), "volume");
  EXPECT_EQ(scene.walls, "exact");
  EXPECT_EQ(scene.overlap, 1e-3);
  EXPECT_FALSE(scene.stages_are_default);
  ASSERT_EQ(scene.stages.size(), 2u);
  EXPECT_EQ(scene.stages[0].integer("max_rounds"), 7);
  EXPECT_EQ(scene.stages[1].numbers("direction"), (std::vector<double>{1, 0.5, -2}));
  EXPECT_EQ(scene.stages[1].where.line, 15);
}

TEST(Scene, MeanDiametersNeedNoBasis) {
  const Scene scene =
      parse_scene(with_spheres(R"(diameter = { distribution = "lognormal", d43 = 2, d32 = 0.5 })"), "s.toml");
  EXPECT_EQ(scene.sizes.number("d43"), 2);
  EXPECT_FALSE(scene.sizes.has("median"));
  EXPECT_FALSE(scene.sizes.has("basis"));
}

TEST(Scene, AMixtureHasPartsOfAnyKind) {
  const Scene scene = parse_scene(with_spheres(R"(draw = "quantiles"
[spheres.diameter]
distribution = "mixture"
shares = [1, 2, 3]
basis = "volume"
of = [
  1.5,
  { distribution = "fuller", max = 8, min = 1 },
  { distribution = "mixture", shares = [1], of = [{ distribution = "normal", mean = 1, sd = 0.1 }] },
])"),
                                  "s.toml");
  EXPECT_EQ(scene.draw, "quantiles");
  EXPECT_EQ(scene.sizes.numbers("shares"), (std::vector<double>{1, 2, 3}));
  ASSERT_EQ(scene.sizes.parts.size(), 3u);
  EXPECT_EQ(scene.sizes.parts[0].name, "constant");
  EXPECT_EQ(scene.sizes.parts[0].number("value"), 1.5);
  EXPECT_EQ(scene.sizes.parts[1].number("exponent"), 0.5);
  EXPECT_EQ(scene.sizes.parts[2].parts.at(0).number("sd"), 0.1);
  EXPECT_EQ(scene.sizes.parts[2].parts.at(0).text("basis"), "number");
  expect_equal(scene, parse_scene(scene_as_toml(scene), "s.toml"));
}

TEST(Scene, TakesTheColumnsOfAFileForItsOwn) {
  const testing::Folder folder;
  std::filesystem::create_directories(folder / "lab");
  folder.write("lab/sieve.csv",
               "\xEF\xBB\xBFopening,passing  # mm, %\r\n\r\n# by hand\r\n0.5, 100\r\n"
               "0.063;0\r\n .125\t3e1 # wet\r\n");
  const Scene scene = read_scene(folder.write(
      "scene.toml", with_spheres("diameter = { distribution = \"sieve\", file = \"lab/sieve.csv\" }")));
  EXPECT_EQ(scene.sizes.numbers("sizes"), (std::vector<double>{0.5, 0.063, 0.125}));
  EXPECT_EQ(scene.sizes.numbers("passing"), (std::vector<double>{100, 0, 30}));
  EXPECT_FALSE(scene.sizes.has("file"));
  expect_equal(scene, parse_scene(scene_as_toml(scene), "elsewhere.toml"));
}

TEST(Scene, SaysWhatIsWrongInAFileOfColumns) {
  const testing::Folder folder;
  const auto refusal = [&](const std::string& content) -> std::string {
    if (!content.empty()) folder.write("t.csv", content);
    try {
      read_scene(folder.write("scene.toml",
                              with_spheres("radius = { distribution = \"table\", file = \"t.csv\" }")));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      return error.what();
    }
    return "accepted";
  };
  const auto expect = [&](const std::string& content, const std::vector<std::string>& words) {
    const std::string what = refusal(content);
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
    for (const std::string& word : words)
      EXPECT_NE(what.find(word), std::string::npos) << word << "\nis not in: " << what;
  };
  expect("", {"scene.toml:3", "\"file\" in radius of [spheres]", "no file", "t.csv"});
  expect("#\n", {"t.csv: ", "no line has two numbers, x and density"});
  expect("x, density\nsize, share\n", {"t.csv:2", "two numbers", "\"size, share\""});
  expect("1, 2\nx, y\n", {"t.csv:2"});
  expect("1\n", {"t.csv:1", "two numbers"});
  expect("1, 2, 3\n", {"t.csv:1"});
  expect("1,5;2\n", {"t.csv:1", "decimal points"});
  expect("1, 2\n\n3, nan\n", {"t.csv:3"});
  expect("1, 2\n3, -1\n", {"t.csv:2", "\"density\"", "at least 0, not -1"});
  expect("1, 2\n0, 1\n", {"t.csv:2", "\"x\"", "positive lengths, not 0"});
  expect(std::string(2000, 'x'), {"t.csv:1", "too long"});
  expect("1, 2\n", {"scene.toml:3", "\"x\"", "two sizes"});
  expect("1, 2\n1, 3\n", {"scene.toml:3", "1 is there twice"});
  std::string long_table;
  for (int i = 1; i < 5000; ++i) long_table += fmt::format("{},1\n", i);
  expect(long_table, {"t.csv:4097", "4096"});
}

TEST(Scene, GettersRefuseWhatIsNotThere) {
  const Spec spec{"box", {{"size", {std::vector<double>{1, 2, 3}, {}}}}, {}};
  EXPECT_THROW(spec.number("size"), Error);
  EXPECT_THROW(spec.numbers("corner"), Error);
}

struct Bad {
  std::string scene;
  int line;                        ///< 0 where it is the whole file's fault
  std::vector<std::string> words;  ///< that the message contains
};

TEST(BadScene, IsOneLineWithTheFileTheLineAndTheRemedy) {
  const std::string box = "kind = \"box\"\n";
  const std::vector<Bad> bad = {
      // what is no scene at all
      {"", 0, {"empty"}},
      {" \n\t\r\n", 0, {"empty"}},
      {"[container\n", 1, {"TOML"}},
      {"a = 1\na = 2\n", 2, {"TOML"}},
      {"seed = 1\n\n[container]\nkind = \"box\n", 4, {"TOML"}},
      {std::string("\x7f"
                   "ELF\0\1",
                   6),
       1,
       {"TOML"}},
      {"a = \"\xff\xfe\"\n", 1, {"TOML"}},
      // unknown names
      {"sead = 3\n", 1, {"unknown key \"sead\"", "did you mean \"seed\"?"}},
      {"[sphere]\nradius = 1\n", 1, {"\"sphere\"", "did you mean \"spheres\"?"}},
      {"[container]\nkind = \"box\"\n\n[periodic]\n", 4, {"unknown key \"periodic\""}},
      {with_spheres("diametre = 1"),
       3,
       {"unknown key \"diametre\" in [spheres]", "did you mean \"diameter\"?"}},
      {with_spheres("qqqqqqqq = 1"), 3, {"known: \"count\", \"packing_fraction\""}},
      {with_spheres("radius = { distribution = \"uniform\", min = 1, max = 2, \"ba\\nsis\" = 1 }"),
       3,
       {"ba\\u000Asis"}},
      {with_container("kind = \"cylindre\""), 3, {"unknown kind \"cylindre\"", "\"cylinder\"?"}},
      {with_container("kind = \"plane\""), 3, {"unknown kind \"plane\"", "known: \"box\""}},
      {with_container("kind = \"periodic\""), 4, {"needs a \"count\"", "\"size\""}},
      {with_container("kind = \"periodic\"\nsize = [1.0, 2.0]"), 4, {"\"size\"", "3 dimensions", "has 2"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nedge = 2"), 5, {"exclude each other"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [3]"), 5, {"axes", "from 0 to 2"}},
      {with_container("kind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [1, 1]"), 5, {"each once"}},
      {with_container(box + "size = [1, 1, 1]\nradius = 1"), 5, {"unknown key \"radius\" in [container]"}},
      {with_stage("do = \"squeeze\""), 5, {"unknown stage \"squeeze\"", "\"insert\""}},
      {with_stage("do = \"shake\"\nround = 3"), 6, {"[[stage]] shake", "did you mean \"rounds\"?"}},
      {with_spheres("radius = { distribution = \"log-normal\", median = 1 }"),
       3,
       {"did you mean \"lognormal\"?"}},
      // what is missing
      {"[spheres]\nradius = 1\n", 0, {"no [container]"}},
      {"[container]\nkind = \"sphere\"\nradius = 1\n", 0, {"no [spheres]"}},
      {with_container("radius = 1"), 2, {"missing \"kind\"", "\"box\", \"cylinder\", \"mesh\", \"sphere\""}},
      {with_container("kind = \"cylinder\"\nradius = 1"), 2, {"missing \"height\"", "positive length"}},
      {with_spheres("count = 3"), 2, {"exactly one of \"radius\", \"diameter\""}},
      {with_spheres("radius = { median = 1 }"), 3, {"missing \"distribution\"", "\"lognormal\""}},
      {with_spheres("radius = { distribution = \"lognormal\", sigma = 1 }"), 3, {"missing \"median\""}},
      {with_spheres("diameter = { distribution = \"lognormal\" }"),
       3,
       {"exactly one of", "\"d43\" and \"d32\""}},
      {with_spheres("diameter = { distribution = \"lognormal\", d43 = 1 }"), 3, {"missing \"d32\""}},
      {"[container]\nkind = \"mesh\"\nfile = \"a.stl\"\n[spheres]\nradius = 1\n", 1, {"unit = \"mm\""}},
      {with_stage("rounds = 1"), 4, {"missing \"do\""}},
      // alternatives
      {with_spheres("count = 3\nfill = true\nradius = 1"),
       4,
       {"\"count\" and \"fill\"", "exclude each other"}},
      {with_spheres("radius = 1\ndiameter = 1"), 4, {"\"radius\" and \"diameter\"", "exclude each other"}},
      {with_spheres("diameter = { distribution = \"lognormal\", median = 1, d43 = 2 }"),
       3,
       {"exclude each other"}},
      {with_spheres("fill = false\nradius = 1"), 3, {"\"fill\"", "\"count\""}},
      // values out of range
      {with_container("kind = \"cylinder\"\nradius = -3\nheight = 1"),
       4,
       {"\"radius\" in [container] must be a positive length, not -3"}},
      {with_container("kind = \"cylinder\"\nradius = nan\nheight = 1"), 4, {"not nan"}},
      {with_container("kind = \"cylinder\"\nradius = inf\nheight = 1"), 4, {"not inf"}},
      {with_container("kind = \"sphere\"\nradius = 0"), 4, {"positive length, not 0"}},
      {with_container("kind = \"sphere\"\nradius = 1e200"), 4, {"1e-30", "1e+30"}},
      {with_container("kind = \"sphere\"\nradius = 1\ncenter = [0, 0, nan]"), 5, {"[0, 0, nan]"}},
      {with_container(box + "size = [1, 2]"), 4, {"three positive lengths", "not [1, 2]"}},
      {with_container(box + "size = [1, 2, 0]"), 4, {"three positive lengths"}},
      {with_container("kind = \"cylinder\"\nradius = 1\nheight = 1\naxis = [0, 0, 0]"),
       6,
       {"\"axis\"", "direction"}},
      {with_container("kind = \"mesh\"\nfile = \"\""), 4, {"path of a file"}},
      {with_container("kind = \"mesh\"\nfile = \"a.stl\"\nunit = \"mn\""),
       5,
       {"\"unit\" in [container] is not \"mn\""}},
      {"unit = \"furlong\"\n" + with_spheres("radius = 1"), 1, {"\"furlong\"", "\"mm\""}},
      {"seed = -1\n" + with_spheres("radius = 1"), 1, {"\"seed\"", "at least 0, not -1"}},
      {with_spheres("count = 0\nradius = 1"), 3, {"whole number from 1 to 2147483647, not 0"}},
      {with_spheres("count = 2147483648\nradius = 1"), 3, {"not 2147483648"}},
      {with_spheres("count = 99999999999999999999\nradius = 1"), 3, {"TOML"}},
      {with_spheres("packing_fraction = 1.0\nradius = 1"), 3, {"above 0 and below 1 or \"predicted\", not 1"}},
      {with_spheres("radius = -0.5"), 3, {"\"radius\" in [spheres]", "positive length", "not -0.5"}},
      {with_spheres("radius = { distribution = \"uniform\", min = 2, max = 1 }"), 3, {"2 is not below 1"}},
      {with_spheres("radius = { distribution = \"uniform\", min = 2, max = 2 }"),
       3,
       {"\"min\"", "below \"max\""}},
      {with_spheres("radius = { distribution = \"classes\", values = [], shares = [] }"), 3, {"\"values\""}},
      {with_spheres("radius = { distribution = \"classes\", values = [1, 2], shares = [1] }"),
       3,
       {"1 for 2"}},
      {with_spheres("radius = { distribution = \"classes\", values = [2, 1, 2], shares = [1, 1, 1] }"),
       3,
       {"2 is there twice"}},
      {with_spheres("radius = { distribution = \"classes\", values = [1, 2], shares = [1, -1] }"),
       3,
       {"\"shares\"", "[1, -1]"}},
      {with_spheres("diameter = { distribution = \"lognormal\", d43 = 1, d32 = 2 }"),
       3,
       {"1 is not above 2"}},
      {with_spheres("radius = { distribution = \"lognormal\", d43 = 2, d32 = 1 }"),
       3,
       {"\"d43\" is a diameter", "diameter = {"}},
      {with_spheres("radius = { distribution = \"rosin_rammler\", d63 = 1, n = 1, min = 0.1 }"),
       3,
       {"\"d63\" is a diameter", "diameter = {"}},
      {with_spheres("diameter = { distribution = \"rosin_rammler\", d63 = 1, n = 1 }"),
       3,
       {"\"min\"", "fines"}},
      {with_spheres("diameter = { distribution = \"fuller\", max = 1 }"), 3, {"missing \"min\"", "fines"}},
      {with_spheres("diameter = { distribution = \"fuller\", max = 1, min = 2 }"), 3, {"2 is not below 1"}},
      {with_spheres("radius = { distribution = \"table\" }"), 3, {"\"x\" and \"density\"", "\"file\""}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [1] }"), 3, {"1 for 2"}},
      {with_spheres("radius = { distribution = \"table\", x = [1], density = [1] }"), 3, {"two sizes"}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [0, 0] }"),
       3,
       {"\"density\"", "0"}},
      {with_spheres("radius = { distribution = \"table\", x = [1, 2], density = [1, -1] }"),
       3,
       {"\"density\"", "at least 0, not [1, -1]"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], passing = [4, 100] }"),
       3,
       {"begin at 0", "4 passes the finest sieve, 1"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2], passing = [0, 97] }"),
       3,
       {"100", "97 passes the coarsest sieve, 2"}},
      {with_spheres("radius = { distribution = \"sieve\", sizes = [1, 2, 3], passing = [0, 60, 40] }"),
       3,
       {"60 passes 2 and only 40 passes 3", "retains?"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [], shares = [1] }"),
       3,
       {"\"of\"", "array"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [1, 2], shares = [1] }"),
       3,
       {"\"shares\" in radius of [spheres]", "1 for 2"}},
      {with_spheres("radius = { distribution = \"mixture\", of = [1, -2], shares = [1, 1] }"),
       3,
       {"\"part 2\" in radius of [spheres]", "positive length", "not -2"}},
      {with_spheres("radius = { distribution = \"mixture\", shares = [1], of = [\n{ distribution = "
                    "\"uniform\", min = 1 }] }"),
       4,
       {"missing \"max\" in part 1 of radius of [spheres]"}},
      {with_spheres("radius = { distribution = \"mixture\", shares = [1], of = [\n{ distribution = "
                    "\"lognormal\", d43 = 2, d32 = 1 }] }"),
       4,
       {"\"d43\" is a diameter"}},
      {with_spheres("radius = 1\ndraw = \"quantile\""), 4, {"\"draw\"", "did you mean \"quantiles\"?"}},
      {with_spheres("radius = 1\n[accuracy]\noverlap = -1e-9"), 5, {"\"overlap\"", "at least 0"}},
      {with_spheres("radius = 1\n[accuracy]\nwalls = \"exakt\""),
       5,
       {"\"walls\"", "did you mean \"exact\"?"}},
      {with_stage("do = \"compress\"\ndirection = [0, 0, 0]"), 6, {"\"direction\" in [[stage]] compress"}},
      // wrong types
      {with_container("kind = 3"), 3, {"\"kind\"", "not 3"}},
      {with_container("kind = \"sphere\"\nradius = \"1\""), 4, {"positive length, not \"1\""}},
      {with_container(box + "size = 3"), 4, {"not 3"}},
      {with_container(box + "size = [1, \"2\", 3]"), 4, {"[1, \"2\", 3]"}},
      {"container = 4\n[spheres]\nradius = 1\n", 1, {"must be a table [container], not 4"}},
      {"[[container]]\nkind = \"box\"\n[spheres]\nradius = 1\n", 1, {"must be a table [container]"}},
      {with_spheres("radius = true"), 3, {"{ distribution = "}},
      {with_spheres("radius = [1, 2]"), 3, {"not [1, 2]"}},
      {with_spheres("count = 1.5\nradius = 1"), 3, {"whole number", "not 1.5"}},
      {with_spheres("count = \"" + std::string(1000, 'x') + "\"\nradius = 1"), 3, {"xxx\"…"}},
      {with_spheres("radius = 1\n[stage]\ndo = \"insert\""), 4, {"[[stage]]"}},
      {with_spheres("radius = 1\n[stage.insert]"), 4, {"[[stage]]"}},
      {"stage = []\n" + with_spheres("radius = 1"), 1, {"[[stage]]"}},
      {"stage = [1]\n" + with_spheres("radius = 1"), 1, {"[[stage]]"}},
  };
  for (const Bad& b : bad) {
    SCOPED_TRACE(b.scene);
    try {
      parse_scene(b.scene, "folder/scene.toml");
      ADD_FAILURE() << "was accepted";
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      EXPECT_TRUE(what.starts_with(b.line > 0 ? fmt::format("folder/scene.toml:{}: ", b.line)
                                              : "folder/scene.toml: "))
          << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      EXPECT_LT(what.size(), 300u) << what;
      for (const std::string& word : b.words)
        EXPECT_NE(what.find(word), std::string::npos) << word << "\nis not in: " << what;
    }
  }
}

TEST(BadScene, FileIsNamed) {
  const testing::Folder folder;
  const auto refusal = [](const std::filesystem::path& file) -> std::string {
    try {
      read_scene(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string missing = (folder / "none.toml").string();
  EXPECT_EQ(refusal(missing), missing + ": no such scene file");
  EXPECT_EQ(refusal(folder.path()), folder.path().string() + ": this is a folder, not a scene file");
  const auto large = folder.write("large.toml", std::string(2 << 20, '#'));
  EXPECT_NE(refusal(large).find("larger than 1 MiB"), std::string::npos);
}

/// A file that any distribution accepts whose columns may stand in one.
std::string file_of_columns() {
  static const testing::Folder folder;
  static const auto file = folder.write("columns.csv", "1, 0\n2, 50\n3, 100\n");
  return fmt::format("\"{}\"", file.string());
}

/// TOML that a key accepts.
std::string sample(const Key& key, int choice) {
  switch (key.type) {
    case Type::flag:
      return "true";
    case Type::integer:
      return choice == 0 || key.name == "dimension"
                 ? "3"
                 : fmt::format("{}", static_cast<std::int64_t>(key.range.min));
    case Type::number:
      if (key.range.min > 0.1) return fmt::format("{}", key.range.min + 0.1);
      return choice == 0 ? "0.1" : "0.30000000000000004";
    case Type::length:  // keys come in the order min, max and d43, d32
      return key.name == "max" || key.name == "d43" ? "2.5e3" : "0.1";
    case Type::word:
      return fmt::format("\"{}\"", key.words[choice % key.words.size()]);
    case Type::unit:
      return choice == 0 ? "\"in\"" : "\"mm\"";
    case Type::file:
      return choice == 0 ? "\"part.stl\"" : "'''/tmp/a \"strange\" \\ name.stl'''";
    case Type::direction:
    case Type::position:
      return choice == 0 ? "[0, -1, 1e-5]" : "[3, 4.000000000000001, 0]";
    case Type::extents:
      return "[1, 2.5, 1e-9]";
    case Type::lengths:
      return "[1, 2, 0.3]";
    case Type::shares:
      return "[30, 70, 1e3]";
    case Type::amounts:  // of the sizes 1, 2, 0.3: a sieve's passing may not fall
      return "[25.5, 100, 0]";
    case Type::parts:
      return choice == 0 ? "[1, { distribution = \"fuller\", max = 2, min = 0.1 }, 3]"
                         : "[1, 2, { distribution = \"mixture\", of = [1, 2], shares = [1, 2] }]";
    case Type::distribution:
      return "1";
  }
  return "";
}

std::string sample_of(const Entry& entry, const Key& key, int choice) {
  if (key.name == "walls" && key.type == Type::amounts) return "[0]";  // axes, not any numbers
  return key.type == Type::file && !entry.columns.empty() ? file_of_columns() : sample(key, choice);
}

/// All keys of an entry that go with the n-th set of its choices.
std::vector<Key> keys_of(const Entry& entry, std::size_t n) {
  std::vector<Key> keys = entry.keys;
  for (const schema::Choice& choice : entry.choices)
    for (std::size_t i = 0; i < choice.size(); ++i)
      if (i != n % choice.size())
        for (const std::string_view name : choice[i])
          std::erase_if(keys, [&](const Key& k) { return k.name == name; });
  return keys;
}

/// Calls `visit(keys, text_of_value → scene)` for every entry of the schema and every set of its choices.
template <class Visit>
void for_every_entry(Visit visit) {
  const auto joined = [](const std::vector<std::string>& parts, const char* with) {
    return fmt::format("{}", fmt::join(parts, with));
  };
  const auto& all = schema::schema();
  for (std::size_t n = 0; n < 3; ++n) {
    for (const Entry& e : all.containers)
      visit(e, keys_of(e, n), [&](const std::vector<std::string>& lines) {
        return fmt::format(
            "unit = \"mm\"\n[container]\nkind = \"{}\"\n{}\n[spheres]\ncount = 5\nradius = 1\n", e.name,
            joined(lines, "\n"));
      });
    for (const Entry& e : all.distributions)
      visit(e, keys_of(e, n), [&](const std::vector<std::string>& lines) {
        return with_spheres(
            fmt::format("diameter = {{ distribution = \"{}\", {} }}", e.name, joined(lines, ", ")));
      });
    for (const Entry& e : all.stages_in_containers)
      visit(e, keys_of(e, n), [&](const std::vector<std::string>& lines) {
        return with_stage(fmt::format("do = \"{}\"\n", e.name) + joined(lines, "\n"));
      });
    visit(all.scene, keys_of(all.scene, n), [&](const std::vector<std::string>& lines) {
      return joined(lines, "\n") + "\n" + with_spheres("radius = 1");
    });
    visit(all.spheres, keys_of(all.spheres, n),
          [&](const std::vector<std::string>& lines) { return with_spheres(joined(lines, "\n")); });
    visit(all.accuracy, keys_of(all.accuracy, n), [&](const std::vector<std::string>& lines) {
      return with_spheres("radius = 1\n[accuracy]\n" + joined(lines, "\n"));
    });
  }
}

TEST(SchemaLaw, EveryKeyIsReadAndSurvivesBeingWritten) {
  int scenes = 0;
  for_every_entry([&](const Entry& entry, const std::vector<Key>& keys, const auto& scene_with) {
    for (const int choice : {0, 1}) {
      std::vector<std::string> lines;
      for (const Key& key : keys)
        lines.push_back(fmt::format("{} = {}", key.name, sample_of(entry, key, choice)));
      SCOPED_TRACE(scene_with(lines));
      const Scene scene = parse_scene(scene_with(lines), "s.toml");
      EXPECT_FALSE(entry.help.empty());
      const std::string written = scene_as_toml(scene);
      expect_equal(scene, parse_scene(written, "s.toml"));
      EXPECT_EQ(scene_as_toml(parse_scene(written, "s.toml")), written);
      ++scenes;
    }
  });
  EXPECT_GT(scenes, 60);
}

TEST(SchemaLaw, EveryKeyRefusesAWrongTypeByName) {
  for_every_entry([&](const Entry& entry, const std::vector<Key>& keys, const auto& scene_with) {
    for (const Key& wrong : keys) {
      std::vector<std::string> lines;
      for (const Key& key : keys)
        lines.push_back(
            fmt::format("{} = {}", key.name, &key == &wrong ? "1979-05-27" : sample_of(entry, key, 0)));
      SCOPED_TRACE(scene_with(lines));
      try {
        parse_scene(scene_with(lines), "s.toml");
        ADD_FAILURE() << "was accepted";
      } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find(fmt::format("\"{}\"", wrong.name)), std::string::npos) << what;
        EXPECT_NE(what.find("not a date or time"), std::string::npos) << what;
        EXPECT_FALSE(wrong.help.empty());
      }
    }
  });
}

TEST(SchemaLaw, EveryDefaultIsAcceptedByItsKey) {
  for_every_entry([](const Entry& entry, const std::vector<Key>& keys, const auto&) {
    for (const Key& key : keys)
      EXPECT_TRUE(!key.otherwise || schema::accepts(key, *key.otherwise)) << entry.name << " " << key.name;
  });
}

TEST(ExampleScenes, AreReadAndSurviveBeingWritten) {
  EXPECT_GE(testing::example_scenes().size(), 5u);
  for (const auto& file : testing::example_scenes()) {
    SCOPED_TRACE(file.string());
    const Scene scene = read_scene(file);
    expect_equal(scene, parse_scene(scene_as_toml(scene), file));
    EXPECT_TRUE(!scene.container.has("file") || std::filesystem::exists(scene.container.text("file")));
  }
}

TEST(WriteScene, NamesTheMeshFromItsOwnFolder) {
  const testing::Folder folder;
  std::filesystem::create_directories(folder / "parts");
  std::filesystem::create_directories(folder / "out/deep");
  const auto file = folder.write("scene.toml", with_container("kind = \"mesh\"\nfile = \"parts/a.stl\""));
  const Scene scene = read_scene(file);
  const std::string written = scene_as_toml(scene, folder / "out/deep");
  EXPECT_NE(written.find("file = \"../../parts/a.stl\""), std::string::npos) << written;
  const Scene again = read_scene(folder.write("out/deep/scene.toml", written));
  EXPECT_EQ(std::filesystem::weakly_canonical(again.container.text("file")),
            std::filesystem::weakly_canonical(folder / "parts/a.stl"));
}

TEST(WriteScene, PrintsTheProtocolReadyToBePasted) {
  const Scene scene = parse_scene(with_spheres("radius = 1"), "s.toml");
  const Scene pasted = parse_scene(with_spheres("radius = 1") + stages_as_toml(scene), "s.toml");
  EXPECT_FALSE(pasted.stages_are_default);
  expect_equal(scene, pasted);
}

TEST(WriteScene, RefusesASeedThatTomlCannotHold) {
  Scene scene = parse_scene(with_spheres("radius = 1"), "s.toml");
  scene.seed = ~std::uint64_t{0};
  EXPECT_THROW(scene_as_toml(scene), Error);
}

}  // namespace
}  // namespace bernal

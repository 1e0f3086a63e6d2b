#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "bernal/settle/refill.hpp"
#include "bernal/soft/relax.hpp"
#include "support/folder.hpp"
#include "support/scene_texts.hpp"

namespace bernal {
namespace scene_test {

using testing::expect_equal;
using testing::with_spheres;

TEST(Scene, TheLeastOneHasEveryDefault) {
  const Scene scene =
      parse_scene("[container]\nkind = \"box\"\nsize = [1, 2, 3]\n[spheres]\ndiameter = 0.1\n", "s.toml");
  EXPECT_EQ(scene.file, "s.toml");
  EXPECT_EQ(scene.unit, Unit::m);
  EXPECT_EQ(scene.seed, 1u);
  const Box& box = std::get<Box>(scene.container);
  EXPECT_EQ(box.size, Vector<3>(1, 2, 3));
  EXPECT_EQ(box.corner, Vector<3>(0, 0, 0));
  EXPECT_EQ(scene.container.locations.of("size").text(), "s.toml:3");
  EXPECT_EQ(scene.container.locations.of("corner").text(), "s.toml:1");
  EXPECT_EQ(std::get<Constant>(scene.sizes).value, 0.1);
  EXPECT_TRUE(scene.sizes_are_diameters);
  EXPECT_TRUE(scene.target.is_open());
  EXPECT_FALSE(scene.target.fill);
  EXPECT_EQ(scene.walls, WallArithmetic::filtered);
  EXPECT_EQ(scene.overlap, 0);
  EXPECT_TRUE(scene.stages_are_default);
  ASSERT_EQ(scene.stages.size(), 1u);
  EXPECT_EQ(scene.stages[0].name(), "relax");
  EXPECT_EQ(scene.stages[0].as<Relax>()->patience, 12);
  EXPECT_EQ(scene.draw, Draw::quantiles);
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
  EXPECT_EQ(std::get<MeshFile>(scene.container).file, "/tmp/parts/a b.stl");
  EXPECT_FALSE(std::get<MeshFile>(scene.container).unit);  // the file may say it
  EXPECT_EQ(scene.target.packing_fraction, 0.4);
  EXPECT_FALSE(scene.target.fill);
  EXPECT_FALSE(scene.sizes_are_diameters);
  const auto& sizes = std::get<Lognormal>(scene.sizes);
  EXPECT_EQ(sizes.max, 2);
  EXPECT_FALSE(sizes.min);
  EXPECT_EQ(sizes.basis, Basis::volume);
  EXPECT_EQ(scene.walls, WallArithmetic::exact);
  EXPECT_EQ(scene.overlap, 1e-3);
  EXPECT_FALSE(scene.stages_are_default);
  ASSERT_EQ(scene.stages.size(), 2u);
  EXPECT_EQ(scene.stages[0].as<Refill>()->max_rounds, 7);
  EXPECT_EQ(scene.stages[1].as<Compress>()->direction, Vector<3>(1, 0.5, -2));
  EXPECT_EQ(scene.stages[1].locations.whole.line, 15);
}

TEST(Scene, AWholeNumberMayBeWrittenAsAPower) {
  const Scene scene = parse_scene(with_spheres("count = 1e6\nradius = 1"), "s.toml");
  EXPECT_EQ(scene.target.count, 1000000);
  EXPECT_NE(scene_as_toml(scene).find("count = 1000000\n"), std::string::npos);
}

TEST(Scene, MeanDiametersNeedNoBasis) {
  const Scene scene =
      parse_scene(with_spheres(R"(diameter = { distribution = "lognormal", d43 = 2, d32 = 0.5 })"), "s.toml");
  EXPECT_EQ(std::get<Lognormal>(scene.sizes).d43, 2);
  EXPECT_FALSE(std::get<Lognormal>(scene.sizes).median);
  EXPECT_EQ(scene_as_toml(scene).find("basis"), std::string::npos);
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
  EXPECT_EQ(scene.draw, Draw::quantiles);
  const auto& mixture = std::get<Mixture>(scene.sizes);
  EXPECT_EQ(mixture.shares, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(mixture.basis, Basis::volume);
  ASSERT_EQ(mixture.of.size(), 3u);
  EXPECT_EQ(std::get<Constant>(mixture.of[0]).value, 1.5);
  EXPECT_EQ(std::get<Fuller>(mixture.of[1]).exponent, 0.5);
  const auto& inner = std::get<Normal>(std::get<Mixture>(mixture.of[2]).of.at(0));
  EXPECT_EQ(inner.sd, 0.1);
  EXPECT_EQ(inner.basis, Basis::number);
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
  const auto& sieve = std::get<Sieve>(scene.sizes);
  EXPECT_EQ(sieve.sizes, (std::vector<double>{0.5, 0.063, 0.125}));
  EXPECT_EQ(sieve.passing, (std::vector<double>{100, 0, 30}));
  expect_equal(scene, parse_scene(scene_as_toml(scene), "elsewhere.toml"));
}

TEST(Scene, TakesTheUnitAndTheOrderThatAFileOfColumnsSays) {
  const testing::Folder folder;
  for (const char* text : {"# unit: cm\n0.05,100\n0.01,0\n", "#Unit : cm\n0.05,100\n0.01,0\n",
                           "opening (cm);passing (%)\n.05;100\n.01;0\n", "passing,sizes\n100,0.5\n0,0.1\n"}) {
    folder.write("sieve.csv", text);
    const Scene scene = read_scene(folder.write(
        "scene.toml",
        "unit = \"mm\"\n" + with_spheres("diameter = { distribution = \"sieve\", file = \"sieve.csv\" }")));
    const auto& sieve = std::get<Sieve>(scene.sizes);
    ASSERT_EQ(sieve.sizes.size(), 2u) << text;
    EXPECT_DOUBLE_EQ(sieve.sizes[0], 0.5) << text;
    EXPECT_DOUBLE_EQ(sieve.sizes[1], 0.1) << text;
    EXPECT_EQ(sieve.passing, (std::vector<double>{100, 0})) << text;
  }
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

}  // namespace scene_test
}  // namespace bernal

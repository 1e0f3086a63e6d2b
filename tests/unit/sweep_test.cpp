// What a sweep asks for: its cells, their scenes, their names, and what is refused.
#include "bernal/sweep/sweep.hpp"

#include <gtest/gtest.h>

#include <set>

#include "bernal/core/error.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/soft/relax.hpp"
#include "support/folder.hpp"
#include "sweep/cell_folder.hpp"
#include "sweep/claim.hpp"
#include "sweep/key_path.hpp"

namespace bernal {
namespace sweep_test {

using testing::Folder;

constexpr const char* bed = R"(unit = "mm"
seed = 5

[container]
kind = "periodic"

[spheres]
count = 100
diameter = { distribution = "lognormal", median = 1.0, sigma = 0.3 }

[[stage]]
do = "relax"
alpha = 8
)";

Sweep sweep_of(const Folder& folder, const std::string& text) {
  folder.write("bed.toml", bed);
  return Sweep::read(folder.write("sweep.toml", text));
}

std::vector<std::string> values_of(const Sweep& sweep, std::size_t key = 0) {
  std::vector<std::string> values;
  for (std::size_t k = 1; k <= sweep.size(); ++k) values.push_back(sweep.cell(k).values[key]);
  return values;
}

/// What reading the sweep, or one of its cells, says.
std::string refusal_of(const std::string& text) {
  const Folder folder;
  try {
    const Sweep sweep = sweep_of(folder, text);
    for (std::size_t k = 1; k <= sweep.size(); ++k) sweep.cell(k);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "nothing is refused";
}

TEST(Sweep, ACellIsTheSceneWithItsValues) {
  const Folder folder;
  const Sweep sweep = sweep_of(folder, R"(scene = "bed.toml"
[grid]
spheres.diameter.sigma = [0.1, 0.2]
"stage[0].alpha" = [3, 4.5, 6]
accuracy.overlap = 0.01
)");
  EXPECT_EQ(sweep.size(), 6u);
  EXPECT_EQ(sweep.keys(),
            (std::vector<std::string>{"spheres.diameter.sigma", "stage[0].alpha", "accuracy.overlap"}));
  const Cell cell = sweep.cell(5);
  EXPECT_EQ(cell.values, (std::vector<std::string>{"0.2", "4.5", "0.01"}));
  EXPECT_EQ(std::get<Lognormal>(cell.scene.sizes).sigma, 0.2);
  EXPECT_EQ(std::get<Lognormal>(cell.scene.sizes).median, 1.0);
  EXPECT_EQ(cell.scene.stages.at(0).as<Relax>()->alpha, 4.5);
  EXPECT_EQ(cell.scene.overlap, 0.01);
  EXPECT_EQ(cell.scene.seed, 5u);

  // The same as a scene that says it itself, whatever was asked for before.
  std::string text = bed;
  text.replace(text.find("sigma = 0.3"), 11, "sigma = 0.2");
  text.replace(text.find("alpha = 8"), 9, "alpha = 4.5");
  text += "[accuracy]\noverlap = 0.01\n";
  EXPECT_EQ(scene_as_toml(cell.scene), scene_as_toml(parse_scene(text, "plain.toml")));
  const Cell first = sweep.cell(1);
  EXPECT_EQ(sweep.cell(5).hash, cell.hash);
  EXPECT_EQ(sweep.cell(1).hash, first.hash);
}

TEST(Sweep, GridsCasesAndRepeatsMultiply) {
  const Folder folder;
  const Sweep sweep = sweep_of(folder, R"(scene = "bed.toml"
repeats = 2
[grid]
spheres.count = [10, 20, 30]
[[case]]
spheres.diameter = 1.5
[[case]]
spheres.diameter = { distribution = "uniform", min = 1, max = 2 }
container.edge = 40
)");
  EXPECT_EQ(sweep.size(), 12u);
  EXPECT_EQ(sweep.keys(),
            (std::vector<std::string>{"spheres.diameter", "container.edge", "spheres.count", "seed"}));
  std::set<std::string> hashes;
  for (std::size_t k = 1; k <= sweep.size(); ++k) hashes.insert(sweep.cell(k).hash);
  EXPECT_EQ(hashes.size(), 12u);
  EXPECT_EQ(sweep.cell(2).values, (std::vector<std::string>{"1.5", "", "10", "6"}));
  const Cell last = sweep.cell(12);
  EXPECT_EQ(last.values[0], R"({ distribution = "uniform", max = 2, min = 1 })");
  EXPECT_EQ(last.scene.seed, 6u);
  EXPECT_EQ(std::get<Uniform>(last.scene.sizes).max, 2);
  EXPECT_TRUE(std::holds_alternative<Constant>(sweep.cell(1).scene.sizes))
      << "what a case writes is taken back";
}

TEST(Sweep, RangesHaveTheirEndsAndRoundNumbers) {
  const Folder folder;
  const auto range = [&](const std::string& key, const std::string& of) {
    return values_of(sweep_of(folder, "scene = \"bed.toml\"\n[grid]\n" + key + " = " + of + "\n"));
  };
  using Values = std::vector<std::string>;
  EXPECT_EQ(range("seed", "{ from = 3, to = 6 }"), (Values{"3", "4", "5", "6"}));
  EXPECT_EQ(range("seed", "{ from = 2, to = 0 }"), (Values{"2", "1", "0"}));
  EXPECT_EQ(range("spheres.diameter.sigma", "{ from = 0.1, to = 0.5, step = 0.1 }"),
            (Values{"0.1", "0.2", "0.3", "0.4", "0.5"}));
  EXPECT_EQ(range("spheres.diameter.sigma", "{ from = 0.1, to = 0.3, count = 3 }"),
            (Values{"0.1", "0.2", "0.3"}));
  EXPECT_EQ(range("spheres.count", "{ from = 100, to = 1000, count = 3, scale = \"log\" }"),
            (Values{"100", "316", "1000"}));
  EXPECT_EQ(range("spheres.diameter.sigma", "{ from = 0.01, to = 1, count = 3, scale = \"log\" }"),
            (Values{"0.01", "0.1", "1"}));
}

TEST(Sweep, TheSceneMayStandInTheSweep) {
  const Folder folder;
  const Sweep own = sweep_of(folder, R"([grid]
"container.size[2]" = [4, 6]
[scene.container]
kind = "box"
size = [3, 3, 3]
[scene.spheres]
count = 4
radius = 1
)");
  EXPECT_EQ(std::get<Box>(own.cell(2).scene.container).size[2], 6);
  EXPECT_EQ(std::get<Box>(own.cell(1).scene.container).size[2], 4);
  EXPECT_EQ(std::get<Box>(own.cell(1).scene.container).size[1], 3);
}

TEST(Sweep, WhatIsWrongIsToldWithItsPlaceAndARemedy) {
  const std::string on_bed = "scene = \"bed.toml\"\n";
  const auto expect = [](const std::string& text, const std::vector<std::string>& words) {
    const std::string said = refusal_of(text);
    for (const std::string& word : words)
      EXPECT_NE(said.find(word), std::string::npos) << said << "\nlacks " << word;
  };
  expect("", {"sweep.toml", "empty"});
  expect("scene = \"bed.toml\"\n", {"[grid]"});
  expect("[grid]\nseed = [1, 2]\n", {"no scene"});
  expect("scene = \"bad.toml\"\n[grid]\nseed = 1\n", {"bad.toml", "no such scene file"});
  expect("scene = 3\n[grid]\nseed = 1\n", {"sweep.toml:1", "path of a scene"});
  expect(bed, {"this is a scene, not a sweep"});
  expect(on_bed + "[gird]\nseed = 1\n", {"sweep.toml:2", "\"gird\"", "did you mean \"grid\""});
  expect(on_bed + "[grid]\nspheres.diametr.sigma = [1]\n",
         {"sweep.toml:3", "\"diametr\"", "did you mean \"diameter\"", "cell 1: spheres.diametr.sigma = 1"});
  expect(on_bed + "[grid]\nspheres.diameter.sigmma = [1]\n", {"sweep.toml:3", "did you mean \"sigma\""});
  expect(on_bed + "[grid]\nsphere.count = [1]\n", {"sweep.toml:3", "did you mean \"spheres\""});
  expect(on_bed + "[grid]\nspheres.diameter.sigma = [0.1,\n 0.2,\n \"wide\"]\n",
         {"sweep.toml:5", "\"wide\"", "cell 3"});
  expect(on_bed + "[grid]\nspheres.count = [10, 0.5]\n", {"sweep.toml:3", "whole number", "cell 2"});
  expect(on_bed + "[grid]\nspheres.count.x = [10]\n",
         {"sweep.toml:3", "\"spheres.count\" is 100 in the scene"});
  expect(on_bed + "[grid]\n\"stage[1].alpha\" = [10]\n",
         {"sweep.toml:3", "has 1 \"stage\": \"stage[0]\" alone"});
  expect(on_bed + "[grid]\n\"stage[0.alpha\" = [10]\n", {"sweep.toml:3", "no key of a scene"});
  expect(on_bed + "[grid]\nspheres.diameter.sigma = []\n", {"sweep.toml:3", "no values"});
  expect(on_bed + "[grid]\nspheres.diameter.sigma = {}\n", {"sweep.toml:3", "no values"});
  expect(on_bed + "[grid]\nseed = [1, 1]\n", {"sweep.toml:3", "twice", "repeats"});
  expect(on_bed + "repeats = 3\n[grid]\nseed = [1, 2]\n", {"\"seed\" is swept by", "repeats", "[grid]"});
  expect(on_bed + "repeats = 0\n", {"sweep.toml:2", "from 1 to"});
  expect(on_bed + "[grid]\nspheres.count = 5\n[[case]]\nspheres.count = 6\n",
         {"[[case]]", "[grid]", "\"spheres.count\""});
  expect(on_bed + "[grid]\nspheres.diameter = [1]\nspheres.count = 6\n[[case]]\nspheres.diameter.sigma = 1\n",
         {"\"spheres.diameter\"", "\"spheres.diameter.sigma\"", "write over each other"});
  expect(on_bed + "[[case]]\n", {"sweep.toml:2", "says nothing"});
  expect(on_bed + "case = 3\n", {"[[case]]"});
  expect(on_bed + "[grid]\nseed = { from = 1, to = 2000000 }\n", {"at most"});
  expect(on_bed + "[grid]\nseed = { from = 1, to = 2000 }\nspheres.count = { from = 1, to = 2000 }\n",
         {"4e+06 cells"});
  expect(on_bed + "[grid]\nseed = { from = 1 }\n", {"sweep.toml:3", "\"to\""});
  expect(on_bed + "[grid]\nseed = { from = 1, to = 3, by = 1 }\n", {"sweep.toml:3", "unknown key \"by\""});
  expect(on_bed + "[grid]\nseed = { from = 1, to = 3, step = -1 }\n", {"sweep.toml:3", "\"step\""});
  expect(on_bed + "[grid]\nseed = { from = 0.5, to = 3 }\n", {"sweep.toml:3", "\"count\" or a \"step\""});
  expect(on_bed + "[grid]\nseed = { from = 0, to = 3, count = 4, scale = \"log\" }\n", {"above 0"});
  expect(on_bed + "[grid]\nspheres.packing_fraction = [0.3]\ncontainer.edge = 9\n",
         {"\"count\" and \"packing_fraction\"", "exclude each other", "cell 1"});
}

TEST(Sweep, TheNameOfACellFollowsFromWhatItSaysAlone) {
  const Folder one, other;
  const std::string grid = "[grid]\nspheres.count = [100, 200]\n";
  const Sweep by_path = sweep_of(one, "scene = \"bed.toml\"\n" + grid);
  // Elsewhere, in other words, in the sweep itself, and among other cells.
  std::filesystem::create_directory(other / "scenes");
  std::string text = bed;
  text.replace(text.find("median = 1.0"), 12, "median = 1");
  other.write("scenes/bed2.toml", "# the same\n" + text);
  const Sweep elsewhere = Sweep::read(other.write(
      "sweep.toml", "scene = \"scenes/bed2.toml\"\n[grid]\nseed = [4, 5]\nspheres.count = [50, 200]\n"));
  EXPECT_EQ(by_path.cell(2).hash, elsewhere.cell(4).hash);
  EXPECT_NE(by_path.cell(2).hash, elsewhere.cell(2).hash) << "another seed";
  EXPECT_NE(by_path.cell(1).hash, by_path.cell(2).hash);
  EXPECT_NE(by_path.digest(), elsewhere.digest());
}

TEST(Sweep, ACellThatNamesAFileIsNamedAfterItsBytes) {
  const Folder folder;
  const std::string part = testing::text_of(std::filesystem::path(BERNAL_DATA) / "meshes/hopper.stl");
  std::filesystem::create_directory(folder / "scenes");
  std::filesystem::create_directory(folder / "parts");
  folder.write("scenes/a.stl", part);
  folder.write("parts/b.stl", part);
  folder.write("parts/c.stl", part + " ");
  folder.write(
      "scenes/bed.toml",
      "unit = \"m\"\n[container]\nkind = \"mesh\"\nfile = \"a.stl\"\n[spheres]\ncount = 3\nradius = 0.1\n");
  // What the sweep names stands beside the sweep, what the scene names beside the scene.
  const Sweep sweep = Sweep::read(
      folder.write("parts/sweep.toml",
                   "scene = \"../scenes/bed.toml\"\n[grid]\ncontainer.file = [\"b.stl\", \"c.stl\"]\n"));
  EXPECT_EQ(std::get<MeshFile>(sweep.cell(1).scene.container).file, folder / "parts/b.stl");
  const Sweep own =
      Sweep::read(folder.write("parts/own.toml", "scene = \"../scenes/bed.toml\"\n[grid]\nseed = 1\n"));
  EXPECT_EQ(std::get<MeshFile>(own.cell(1).scene.container).file, folder / "scenes/a.stl");
  EXPECT_EQ(own.cell(1).hash, sweep.cell(1).hash);
  EXPECT_NE(own.cell(1).hash, sweep.cell(2).hash);
  const Sweep missing = Sweep::read(folder.write(
      "parts/missing.toml", "scene = \"../scenes/bed.toml\"\n[grid]\ncontainer.file = [\"d.stl\"]\n"));
  EXPECT_THROW(missing.cell(1), Error);
}

TEST(Sweep, PathsOfKeysAreReadAndTold) {
  for (const char* text :
       {"seed", "spheres.diameter.sigma", "stage[0].alpha", "container.size[2]", "a.of[1].of[0].min"})
    EXPECT_EQ(sweep::KeyPath::parsed(text)->text(), text);
  for (const char* text :
       {"", ".", "a.", ".a", "a..b", "[0]", "a[", "a[]", "a[x]", "a[-1]", "a[0", "a[0]b", "a b"})
    EXPECT_FALSE(sweep::KeyPath::parsed(text)) << text;
  const auto path = [](const char* text) { return *sweep::KeyPath::parsed(text); };
  EXPECT_TRUE(path("a.b").overlaps(path("a.b.c")));
  EXPECT_TRUE(path("a.b[1].c").overlaps(path("a.b")));
  EXPECT_FALSE(path("a.b[1].c").overlaps(path("a.b[2].c")));
  EXPECT_FALSE(path("a.bc").overlaps(path("a.b")));
}

TEST(Sweep, AClaimIsOneAtATime) {
  const Folder folder;
  const auto file = folder / "claims/one";
  EXPECT_FALSE(sweep::is_claimed(file));
  {
    const sweep::Claim claim(file);
    EXPECT_TRUE(claim.is_ours());
    EXPECT_TRUE(sweep::is_claimed(file));
    const sweep::Claim second(file);
    EXPECT_FALSE(second.is_ours());
  }
  EXPECT_FALSE(sweep::is_claimed(file));
  EXPECT_FALSE(std::filesystem::exists(folder / "claims")) << "nothing is left of it";
  folder.write("stale", "");  // of a process that is no more
  const sweep::Claim stale(folder / "stale");
  EXPECT_TRUE(stale.is_ours());
}

TEST(Sweep, TheTableAndThePictureShowWhatIsThere) {
  const Folder folder;
  const Sweep sweep = sweep_of(folder, R"(scene = "bed.toml"
[grid]
spheres.diameter.sigma = [0.1, 0.2]
"stage[0].method" = ["fast", "reference"]
seed = [1, 2]
)");
  std::vector<SweepRow> rows;
  for (std::size_t k = 1; k <= sweep.size(); ++k) {
    const Cell cell = sweep.cell(k);
    rows.push_back({k, cell.values, cell.hash, {}});
    if (k > 7) continue;
    CellResult& result = rows.back().result;
    result.state = CellResult::State::packed;
    result.outcome = k == 3 ? "full" : "converged";
    result.exit_code = k == 3 ? 3 : 0;
    result.phi = 0.6 + 0.001 * static_cast<double>(k);
    result.reason = k == 3 ? "no \"place\", is left" : "";
  }
  const std::string csv = sweep_csv(sweep, rows);
  EXPECT_TRUE(
      csv.starts_with("cell,spheres.diameter.sigma,stage[0].method,seed,folder,outcome,exit_code,n,phi,"))
      << csv;
  EXPECT_EQ(std::ranges::count(csv, '\n'), 9);
  EXPECT_NE(csv.find("\n3,0.1,reference,1,cells/" + rows[2].cell_hash + ",full,3,,0.603,"), std::string::npos)
      << csv;
  EXPECT_NE(csv.find("\"no \"\"place\"\", is left\"\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find("\n8,0.2,reference,2,cells/" + rows[7].cell_hash + ",missing,,"), std::string::npos)
      << csv;

  const std::string svg = sweep_svg(sweep, rows);
  EXPECT_NE(svg.find(">spheres.diameter.sigma</text>"), std::string::npos);
  EXPECT_NE(svg.find(">packing fraction</text>"), std::string::npos);
  EXPECT_NE(svg.find(">reference</text>"), std::string::npos) << "the next key is the colour";
  EXPECT_NE(svg.find("7 of 8 cells"), std::string::npos);
  EXPECT_NE(svg.find("not what was asked for"), std::string::npos);
  EXPECT_NE(sweep_svg(sweep, rows, "seed,phi").find(">seed</text>"), std::string::npos);
  for (const char* plot : {"seed,ph", "seed", "seed,phi,n,n", ",", "sigma,phi"})
    EXPECT_THROW(sweep_svg(sweep, rows, plot), Error) << plot;
}

TEST(Sweep, WhatIsRunAgainAndWhatIsNot) {
  CellResult result;
  EXPECT_TRUE(sweep::is_to_be_run(result, {}, false));
  result.state = CellResult::State::crashed;
  EXPECT_TRUE(sweep::is_to_be_run(result, {}, false));
  result.state = CellResult::State::refused;
  EXPECT_FALSE(sweep::is_to_be_run(result, {}, false));
  EXPECT_TRUE(sweep::is_to_be_run(result, {}, true));
  result.state = CellResult::State::packed;
  result.outcome = "hit_limit";
  EXPECT_FALSE(sweep::is_to_be_run(result, {}, true)) << "it would end in the same way";
  result.outcome = "cancelled";
  result.seconds = 60;
  EXPECT_TRUE(sweep::is_to_be_run(result, {}, false));
  EXPECT_TRUE(sweep::is_to_be_run(result, 120.0, false));
  EXPECT_FALSE(sweep::is_to_be_run(result, 60.0, false));
}

}  // namespace sweep_test
}  // namespace bernal

#include "check.hpp"

// What the command tells of a bed: its height, its porosity, and which spheres do not rest.
namespace bernal::testing {
namespace bed_command_test {

constexpr const char* settled_scene = R"(unit = "mm"
seed = 3
[container]
kind = "cylinder"
radius = 4
height = 20
[spheres]
count = 150
diameter = 1.5
[[stage]]
do = "settle"
)";

constexpr const char* box_scene = R"(unit = "mm"
[container]
kind = "box"
size = [8, 8, 20]
[spheres]
radius = 1
)";

class BedCommand : public ::testing::Test {
 protected:
  Folder folder;

  Ended verify(const std::string& spheres, std::vector<std::string> words) {
    folder.write("scene.toml", box_scene);
    folder.write("spheres.csv", "# unit: mm\nx,y,z,r\n" + spheres);
    words.insert(words.begin(), {"verify", folder.path().string(), "--settled"});
    return bernal(words);
  }
  static void expect_in(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << "\nis not in\n" << text;
  }
};

TEST_F(BedCommand, TellsHeightPorosityAndRestEverywhere) {
  const std::string scene = folder.write("bed.toml", settled_scene).string();
  const std::string out = (folder / "out").string();
  const Ended packed = bernal({"pack", scene, "-o", out});
  ASSERT_EQ(packed.status, 0) << packed.err;
  expect_in(packed.err, {"all 150 spheres are placed; every sphere rests; the bed has a porosity of "});
  const Ended text = bernal({"measure", out});
  expect_in(text.out, {"\nbed               ", " mm high, the mean of its surface; highest point ",
                       "  porosity        0.", "  rest            every sphere rests",
                       "packing fraction over the height", "; of the bed below "});
  const auto report = report_of(out);
  auto measured = nlohmann::json::parse(bernal({"measure", out, "--json"}).out);
  auto& bed = measured.at("bed");
  EXPECT_EQ(bed.at("unsettled"), 0);
  EXPECT_EQ(bed.at("direction"), nlohmann::json({0.0, 0.0, -1.0}));
  EXPECT_GT(bed.at("highest").get<double>(), bed.at("height").get<double>());
  EXPECT_LT(bed.at("level").get<double>(), bed.at("height").get<double>());
  // 265 mm³ of spheres on 50 mm² of floor, poured.
  EXPECT_NEAR(bed.at("height").get<double>(), 10, 1);
  EXPECT_NEAR(bed.at("porosity").get<double>(), 0.47, 0.04);
  EXPECT_NEAR(measured.at("walls").at("mean_porosity").get<double>(), 0.47, 0.04);
  EXPECT_GT(bed.at("layers").size(), 50u);
  bed.erase("layers");
  EXPECT_EQ(bed, report.at("bed"));
  expect_in(text_of(folder / "out" / "report.html"),
            {"Porosity of the bed", "<h2>The bed</h2>", "every sphere rests", "height (mm)"});
}

TEST_F(BedCommand, MeasuresNoBedWhereThereIsNone) {
  const std::string scene =
      folder.write("full.toml", std::string(box_scene) + "[[stage]]\ndo = \"relax\"\n").string();
  const std::string out = (folder / "out").string();
  ASSERT_EQ(bernal({"pack", scene, "-o", out, "--quiet"}).status, 0);
  EXPECT_TRUE(report_of(out).at("bed").is_null());
  EXPECT_EQ(bernal({"measure", out}).out.find("\nbed  "), std::string::npos);
  EXPECT_EQ(text_of(folder / "out" / "report.html").find("<h2>The bed</h2>"), std::string::npos);
}

TEST_F(BedCommand, ListsWhatDoesNotRest) {
  // The first rests, the second hangs five above the floor, the third lies half beside the first and rolls.
  const std::string three = "1,1,1,1\n6,6,6,1\n2,1,2.7320508075688776,1\n";
  const Ended all = verify(three, {"--list"});
  EXPECT_EQ(all.status, 1);
  expect_in(all.out,
            {"certified  yes",
             "settled    NOT at rest: 2, of which 1 hang; the farthest could fall 5 mm\n"
             "unsettled  1 at 6, 6, 6, radius 1: hangs, could fall 5 mm\n"
             "unsettled  2 at 2, 1, 2.73205, radius 1: is not held, a way down of slope 0.5 is open\n"});
  expect_in(verify(three, {"--list=1"}).out, {"could fall 5 mm\n           and 1 more\n"});
  EXPECT_EQ(verify(three, {}).out.find("unsettled  "), std::string::npos);
  const auto json = nlohmann::json::parse(verify(three, {"--list", "--json"}).out).at("settled");
  EXPECT_EQ(json.at("unsettled"), 2);
  ASSERT_EQ(json.at("list").size(), 2u);
  EXPECT_EQ(json.at("list").at(0).at("sphere"), 1);
  EXPECT_EQ(json.at("list").at(0).at("hangs"), true);
  EXPECT_NEAR(json.at("list").at(0).at("fall").get<double>(), 5, 1e-9);
  EXPECT_EQ(json.at("list").at(1).at("center"), nlohmann::json({2.0, 1.0, 2.7320508075688776}));
  EXPECT_EQ(json.at("list").at(1).at("radius"), 1.0);
  EXPECT_NEAR(json.at("list").at(1).at("slope").get<double>(), 0.5, 1e-9);
}

TEST_F(BedCommand, JudgesRoundedCoordinatesToTheirRounding) {
  // One on four that touch each other and the walls, written at three decimals.
  const std::string rounded =
      "1.001,1.001,1,1\n3.002,1,1.001,1\n1,3.001,1,1\n3.001,3.002,1,1\n2.001,2,2.415,1\n";
  EXPECT_EQ(verify(rounded, {}).status, 1);
  const Ended judged = verify(rounded, {"--gap", "3e-3"});
  EXPECT_EQ(judged.status, 0) << judged.out;
  expect_in(judged.out,
            {"settled    every sphere rests: it can neither fall nor roll down, to 0.003 of a radius"});
  // A fall that is longer than the tolerance is one.
  EXPECT_EQ(verify("1,1,1.01,1\n", {"--gap", "3e-3"}).status, 1);
}

TEST_F(BedCommand, ShowsTheWayToJudgeAPackingOfOthers) {
  const std::string table =
      folder.write("theirs.csv", "# unit: mm\nx,y,z,r\n1,1,1,1\n3,1,1,1\n1,1,3,1\n").string();
  const std::string out = (folder / "out").string();
  ASSERT_EQ(bernal({"import", table, "--box", "4,4,9", "-o", out}).status, 0);
  expect_refused_in_one_line(bernal({"verify", out, "--settled"}), {"walls", "--periodic none"});
  ASSERT_EQ(bernal({"import", table, "--box", "4,4,9", "--periodic", "z", "-o", out}).status, 0);
  expect_refused_in_one_line(bernal({"verify", out, "--settled"}), {"floor", "--periodic none"});
  ASSERT_EQ(bernal({"import", table, "--box", "4,4,9", "--periodic", "none", "-o", out}).status, 0);
  const Ended judged = bernal({"verify", out, "--settled"});
  EXPECT_EQ(judged.status, 0) << judged.out;
  expect_in(judged.out, {"settled    every sphere rests"});
  EXPECT_EQ(report_of(out).at("bed").at("unsettled"), 0);
  // Three cover some 60 % of the floor.
  expect_in(text_of(folder / "out/report.html"),
            {"covers less than 95 % of the cross-section and so has no level", "of the whole container"});
}

TEST_F(BedCommand, RefusesWhatItCannotJudgeInOneLine) {
  const std::string one = "1,1,1,1\n";
  expect_refused_in_one_line(verify(one, {"--gap", "0.5"}), {"--gap"});
  expect_refused_in_one_line(verify(one, {"--gap", "0"}), {"--gap"});
  expect_refused_in_one_line(verify(one, {"--gap", "wide"}), {"--gap"});
  expect_refused_in_one_line(verify(one, {"--list=none"}), {"--list"});
  expect_refused_in_one_line(bernal({"verify", folder.path().string(), "--gap", "1e-3"}),
                             {"--gap", "--settled"});
}

}  // namespace bed_command_test
}  // namespace bernal::testing

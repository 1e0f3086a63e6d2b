#include <fmt/format.h>

#include "check.hpp"

// What the command tells of a bed: its height, its porosity, and whether its spheres rest.
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

}  // namespace bed_command_test
}  // namespace bernal::testing

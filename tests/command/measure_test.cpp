#include <fmt/format.h>

#include "check.hpp"

namespace bernal::testing {
namespace measure_test {

constexpr const char* scene = R"(unit = "mm"
[container]
kind = "periodic"
dimension = 2
size = [4, 2]
[spheres]
count = 2
diameter = 2
)";

/// A square lattice of touching discs.
constexpr const char* discs = "# unit: mm\nx0,x1,r\n1,1,1\n3,1,1\n";

class Measure : public ::testing::Test {
 protected:
  Folder folder;

  Ended with(const std::string& csv, std::vector<std::string> words = {}) {
    folder.write("scene.toml", scene);
    folder.write("spheres.csv", csv);
    words.insert(words.begin(), {"measure", folder.path().string()});
    return bernal(std::move(words));
  }
};

TEST_F(Measure, TellsWhatStandsInTheFiles) {
  const Ended ended = with(discs);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  for (const std::string part :
       {"discs             2, in a periodic box of 4 x 2 mm", "packing fraction  0.785398",
        "coordination      4.0000", "contacts          4 pairs", "diameter in mm"})
    EXPECT_NE(ended.out.find(part), std::string::npos) << part << "\nis not in\n" << ended.out;
}

TEST_F(Measure, JsonIsOneObjectAndNothingElse) {
  const Ended json = with(discs, {"--json", "--gap", "0.01", "--threads", "1"});
  EXPECT_EQ(json.status, 0);
  EXPECT_EQ(json.err, "");
  const auto measured = nlohmann::json::parse(json.out);
  EXPECT_EQ(measured["n"], 2);
  EXPECT_EQ(measured["dimension"], 2);
  EXPECT_EQ(measured["contacts"], 4);
  EXPECT_EQ(measured["coordination"], 4);
  EXPECT_EQ(measured["contact_gap"], 0.01);
  EXPECT_EQ(measured["box"]["edges"], (std::vector<double>{4, 2}));
  EXPECT_EQ(measured["by_gap"].size(), 9u);
  EXPECT_EQ(measured["g_r"]["mean_diameter"], 2);
  EXPECT_EQ(measured["g_r"]["g"].size(), measured["g_r"]["error"].size());
  EXPECT_TRUE(measured["size_correlation"].is_null());  // of equal sizes
  EXPECT_TRUE(measured["walls"].is_null());
  EXPECT_TRUE(measured["chambers"].is_null());
  EXPECT_TRUE(measured["crystalline"].is_null());  // in two dimensions
  EXPECT_NEAR(measured["local_packing"]["mean"].get<double>(), 0.785398163, 1e-9);
  EXPECT_EQ(measured["local_packing"]["mean_neighbours"], 4);
  EXPECT_LT(measured["local_packing"]["volume_error"], 1e-9);
  EXPECT_EQ(measured["structure_factor"]["s"].size(), measured["structure_factor"]["k"].size());
  EXPECT_NEAR(measured["pores"]["porosity"].get<double>(), 1 - 0.785398163, 0.01);
  EXPECT_EQ(measured["pores"]["d"].size(), measured["pores"]["density"].size());
  EXPECT_EQ(measured["sizes"]["drawn"]["missing"], 0);
  EXPECT_EQ(measured["sizes"]["ks_statistic"], 0);
  EXPECT_TRUE(measured["sizes"]["ks_p_value"].is_null());
}

TEST_F(Measure, WritesTheLocalPackingOfEverySphereAndReplacesNothingElse) {
  const std::string table = (folder / "local.csv").string();
  for (int twice = 0; twice < 2; ++twice) {
    const Ended ended = with(discs, {"--local", table});
    EXPECT_EQ(ended.status, 0) << ended.err;
    const std::string text = text_of(folder / "local.csv");
    EXPECT_TRUE(text.starts_with("# unit: mm\npacking_fraction,cell_volume,neighbours\n0.785398")) << text;
    EXPECT_EQ(std::ranges::count(text, '\n'), 4);
  }
  for (const char* name : {"spheres.csv", "mine.csv"}) {
    folder.write("mine.csv", "1,2,3\n");
    const Ended refused = with(discs, {"--local", (folder / name).string()});
    EXPECT_EQ(refused.status, 2) << name;
    EXPECT_EQ(text_of(folder / "spheres.csv"), discs);
    EXPECT_EQ(text_of(folder / "mine.csv"), "1,2,3\n");
  }
}

TEST_F(Measure, HasNoLocalPackingInTiltedBoxes) {
  const std::string text =
      "[container]\nkind = \"periodic\"\nsize = [4, 4, 4]\ntilt = [1, 0, 0]\n"
      "[spheres]\ncount = 1\ndiameter = 2\n";
  folder.write("scene.toml", text);
  folder.write("spheres.csv", "# unit: m\nx,y,z,r\n1,1,1,1\n");
  const Ended refused =
      bernal({"measure", folder.path().string(), "--local", (folder / "local.csv").string()});
  EXPECT_EQ(refused.status, 2) << refused.err;
  EXPECT_NE(refused.err.find("tilted boxes"), std::string::npos) << refused.err;
  EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "local.csv"));
}

TEST_F(Measure, WritesAllContactsAsWhatTheNameEndsIn) {
  const auto file = [&](const char* name) { return (folder / name).string(); };
  for (int twice = 0; twice < 2; ++twice) {
    for (const char* name : {"c.csv", "c.npy", "c.vtp"}) {
      const Ended ended = with(discs, {"--contacts", file(name), "--gap", "0.001", "--json"});
      EXPECT_EQ(ended.status, 0) << ended.err;
      const auto measured = nlohmann::json::parse(ended.out);
      EXPECT_EQ(measured.at("fabric"), nlohmann::json::parse("[[0.5, 0.0], [0.0, 0.5]]"));
      EXPECT_EQ(measured.at("spheres_by_contacts"), nlohmann::json::parse("[0, 0, 0, 0, 2]"));
    }
    // Each disc touches the other on both sides, and its own image.
    const std::string text = text_of(folder / "c.csv");
    EXPECT_TRUE(text.starts_with("# unit: mm\ni,j,gap,n0,n1,x0,x1\n0,0,0,0,")) << text;
    for (const std::string line : {"\n0,1,0,1,0,2,1\n", "\n0,1,0,-1,0,0,1\n", "\n1,1,0,0,"})
      EXPECT_NE(text.find(line), std::string::npos) << line << text;
    EXPECT_EQ(std::ranges::count(text, '\n'), 2 + 4);
    EXPECT_NE(text_of(folder / "c.npy").find("(4, 7)"), std::string::npos);
    EXPECT_NE(text_of(folder / "c.vtp").find("NumberOfLines=\"4\""), std::string::npos);
  }
  folder.write("mine.csv", "1,2,3\n");
  folder.write("mine.npy", "1,2,3\n");
  for (const char* name : {"spheres.csv", "mine.csv", "mine.npy", "c.txt"})
    expect_refused_in_one_line(with(discs, {"--contacts", file(name)}), {name});
  EXPECT_EQ(text_of(folder / "spheres.csv"), discs);
  EXPECT_EQ(text_of(folder / "mine.csv"), "1,2,3\n");
}

/// Two discs that nothing holds: the count of rattlers would say nothing, and neither does it stand there.
TEST_F(Measure, SaysOfDiscsBetweenWallsWhatIsSo) {
  folder.write(
      "scene.toml",
      "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [4, 2]\n[spheres]\ncount = 2\ndiameter = 1\n");
  folder.write("spheres.csv", "# unit: mm\nx0,x1,r\n1,1,0.5\n3,1,0.5\n");
  const Ended text = bernal({"measure", folder.path().string()});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_EQ(text.out.find("polish"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("mean area "), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("mean volume"), std::string::npos) << text.out;
  const auto measured = nlohmann::json::parse(bernal({"measure", folder.path().string(), "--json"}).out);
  EXPECT_TRUE(measured.at("held_from_gap").is_null());
  EXPECT_TRUE(measured.at("rattlers").is_null());
  for (const auto& at : measured.at("by_gap")) EXPECT_TRUE(at.at("rattlers").is_null());
  EXPECT_EQ(measured.at("backbone").at("spheres"), 0);
  // And discs that hold each other have it.
  folder.write(
      "scene.toml",
      "unit = \"mm\"\n[container]\nkind = \"periodic\"\ndimension = 2\nsize = [4, 4]\n[spheres]\ncount = "
      "4\ndiameter = 2\n");
  folder.write("spheres.csv", "# unit: mm\nx0,x1,r\n1,1,1\n3,1,1\n1,3,1\n3,3,1\n");
  EXPECT_EQ(nlohmann::json::parse(bernal({"measure", folder.path().string(), "--json"}).out).at("rattlers"),
            0);
}

TEST_F(Measure, AnEmptyPlaneIsNone) {
  const Ended ended = with(discs, {"--section", "", "-o", (folder / "a.svg").string()});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.svg"));
}

TEST_F(Measure, SaysWhetherLikeSizesLieTogether) {
  const std::string sized =
      folder
          .write(
              "sizes.toml",
              "[container]\nkind = \"cylinder\"\nradius = 4\nheight = 8\n[spheres]\ncount = 250\ndiameter = "
              "{ distribution = \"uniform\", min = 0.8, max = 1.2 }\n[[stage]]\ndo = \"relax\"\n")
          .string();
  const std::string out = (folder / "out").string();
  ASSERT_EQ(bernal({"pack", sized, "-o", out, "--quiet"}).status, 0);
  const Ended text = bernal({"measure", out});
  for (const std::string part :
       {"size correlation", "neighbours      ", "1 to 2 ", "mean volume of the spheres", "mean q6"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\nis not in\n" << text.out;
  const auto measured = nlohmann::json::parse(bernal({"measure", out, "--json"}).out);
  const auto& sizes = measured.at("size_correlation");
  EXPECT_EQ(sizes, report_of(out).at("size_correlation"));
  EXPECT_EQ(sizes.at("c").size(), sizes.at("d").size());
  EXPECT_EQ(sizes.at("references"), 250);
  EXPECT_LT(std::abs(sizes.at("neighbours").at("correlation").get<double>()), 1);
  EXPECT_EQ(sizes.at("means").at(0).at("to"), 2);
  const auto& wall = measured.at("walls").at("layers").at(0).at("segregation");
  EXPECT_GT(wall.at("spheres").get<int>(), 0);
  EXPECT_GT(wall.at("mean_volume_ratio").get<double>(), 0.5);
  EXPECT_NE(testing::text_of(folder / "out" / "report.html").find("Whether like sizes lie together"),
            std::string::npos);
}

TEST_F(Measure, MeasuresContainersWithoutAReferenceDensity) {
  const std::string box = folder.write("box.toml", small_scene).string(), out = (folder / "out").string();
  ASSERT_EQ(bernal({"pack", box, "-o", out, "--quiet"}).status, 0);
  const Ended text = bernal({"measure", out});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const std::string part :
       {"with the wall", "porosity over the distance z from the nearest", "near the wall",
        "porosity along the axis", "from the side alone", "between walls: by the share",
        "core              packing fraction", "chambers          1; too narrow: ", "crystalline",
        "segregation", "drawn sequence    the same sizes to the bit"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\nis not in\n" << text.out;
  const auto measured = nlohmann::json::parse(bernal({"measure", out, "--json"}).out);
  const auto report = report_of(out);
  for (const char* key :
       {"n", "phi", "coordination", "contacts", "wall_contacts", "rattlers", "backbone", "hash"})
    EXPECT_EQ(measured.at(key), report.at(key)) << key;
  EXPECT_EQ(measured.at("crystalline"), report.at("crystalline"));
  const auto& chamber = measured.at("chambers").at("list").at(0);
  EXPECT_EQ(chamber.at("n"), measured.at("n"));
  EXPECT_EQ(measured.at("chambers").at("list").size(), report.at("chambers").at("list").size());
  EXPECT_NEAR(chamber.at("phi").get<double>() * chamber.at("share").get<double>(),
              measured.at("phi").get<double>(), 1e-12);
  double share = 0, integral = 0;
  for (const auto& layer : measured.at("walls").at("layers")) {
    share += layer.at("share").get<double>();
    integral += layer.at("share").get<double>() * layer.at("porosity").get<double>();
  }
  EXPECT_NEAR(share, 1, 1e-12);
  EXPECT_NEAR(integral, measured.at("walls").at("mean_porosity").get<double>(), 1e-9);
  EXPECT_EQ(measured.at("walls").at("mean_porosity"), report.at("walls").at("mean_porosity"));
  const auto& radial = measured.at("g_r");
  EXPECT_EQ(radial.at("share").size(), radial.at("g").size());
  const auto& column = measured.at("column");
  EXPECT_EQ(column.at("has_lid"), measured.at("bed").is_null());
  EXPECT_EQ(column.at("axis"), nlohmann::json::parse("[0.0, 0.0, 1.0]"));
  EXPECT_GT(column.at("along").size(), 10u);
  EXPECT_GT(column.at("side").at("profile").at("layers").size(), 3u);
  EXPECT_EQ(column.at("side").at("profile").at("mean_porosity").get<double>() > 0, true);
  EXPECT_EQ(column.at("side").at("from"), report.at("column").at("side").at("from"));
  EXPECT_EQ(measured.at("backbone").at("isostatic_contacts").is_null(),
            measured.at("backbone").at("spheres") == 0);
  EXPECT_EQ(measured.at("held_from_gap"), report.at("held_from_gap"));
  EXPECT_EQ(report.at("size_scale"), 1);
  EXPECT_EQ(measured.at("core_contacts").at("coordination"), report.at("core_contacts").at("coordination"));
  EXPECT_EQ(measured.at("core_contacts").at("by_gap").size(), 10u);
}

TEST_F(Measure, OfASlabIsWhatLiesInIt) {
  const std::string box = folder.write("box.toml", small_scene).string(), out = (folder / "out").string();
  ASSERT_EQ(bernal({"pack", box, "-o", out, "--quiet"}).status, 0);
  const Ended text = bernal({"measure", out, "--slab", "z = 0.2 cm..5"});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const std::string part :
       {"in the slab     ", "from 2 to 5 mm along (0, 0, 1)", "whose centres lie in it",
        "of the slab from 2 to 5 mm", "porosity along the axis (0, 0, 1), 3 mean diameters",
        "from 2 to 5 mm above the floor"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << "\nis not in\n" << text.out;
  double spheres = 0, filled = 0;
  for (const auto& [slab, thickness] : {std::pair("z < 2", 2.0), {"z = 2..5", 3.0}, {"z > 5 mm", 5.0}}) {
    const auto measured = nlohmann::json::parse(bernal({"measure", out, "--json", "--slab", slab}).out);
    EXPECT_EQ(measured.at("slab").at("direction"), nlohmann::json::parse("[0.0, 0.0, 1.0]"));
    spheres += measured.at("slab").at("contacts").at("spheres").get<double>();
    filled += 100 * thickness * measured.at("slab").at("phi").get<double>();
    EXPECT_NEAR(measured.at("walls").at("mean_porosity").get<double>(),
                1 - measured.at("slab").at("phi").get<double>(), 1e-9);
  }
  const auto whole = nlohmann::json::parse(bernal({"measure", out, "--json"}).out);
  EXPECT_EQ(spheres, 300);
  EXPECT_NEAR(filled, 1000 * whole.at("phi").get<double>(), 1e-6);
  EXPECT_TRUE(whole.at("slab").is_null());
  for (const char* slab : {"z = 5", "below", "z = 5..2"})
    expect_refused_in_one_line(bernal({"measure", out, "--slab", slab}), {slab, "is no slab", "z = 10..40"});
  expect_refused_in_one_line(bernal({"measure", out, "--slab", "x > 10"}),
                             {"holds nothing of the box", "0 to 10"});
}

TEST_F(Measure, BadInputIsOneLine) {
  expect_refused_in_one_line(with("# unit: m\nx0,x1,r\n1,1,1\n"), {"spheres.csv", "in m,", "in mm"});
  expect_refused_in_one_line(with("x,y,z,r\n1,1,1,1\n"), {"spheres.csv", "3 dimensions", "has 2"});
  expect_refused_in_one_line(with("x0,x1,r\n1,1\n"), {"spheres.csv:2"});
  expect_refused_in_one_line(with("x0,x1,r\n1,nan,1\n"), {"spheres.csv:2"});
  expect_refused_in_one_line(with(""), {"spheres.csv"});
  expect_refused_in_one_line(with(discs, {"--gap", "-1"}), {"--gap"});
  expect_refused_in_one_line(with(discs, {"--gap", "wide"}), {"--gap"});
  std::filesystem::remove(folder / "spheres.csv");
  expect_refused_in_one_line(bernal({"measure", folder.path().string()}), {"spheres.csv"});
  std::filesystem::remove(folder / "scene.toml");
  expect_refused_in_one_line(bernal({"measure", folder.path().string()}), {"scene.toml"});
  expect_refused_in_one_line(bernal({"measure", (folder / "none").string()}), {"none", "folder"});
  expect_refused_in_one_line(bernal({"measure"}), {"DIR"});
}

// What stands in the files may be of another box, in other units, or made up: images without number, sums
// that overflow, places that no double tells apart.
TEST_F(Measure, TrustsNobody) {
  for (const char* edge : {"1.0", "1e-20", "1e30"})
    for (const char* spheres : {"1.7e308,0,0,0.1\n-1.7e308,0,0,0.1\n", "0,0,0,1e6\n0.5,0.5,0.5,0.1\n",
                                "0,0,0,1e300\n0.5,0.5,0.5,0.1\n", "0,0,0,1.7e308\n0,0,0,1.7e308\n",
                                "1e17,0.3,0,0.1\n0,0,0,0.1\n", "0,0,0,5e-324\n0,0,0,5e-324\n"})
      for (const char* container :
           {"kind = \"periodic\"\nedge = {}\n", "kind = \"box\"\nsize = [{0}, {0}, {0}]\n",
            "kind = \"cylinder\"\nradius = {0}\nheight = {0}\n"}) {
        folder.write("scene.toml", "unit = \"mm\"\n[container]\n" +
                                       fmt::format(fmt::runtime(container), edge) +
                                       "[spheres]\ncount = 2\nradius = 0.1\n");
        folder.write("spheres.csv", std::string("# unit: mm\nx,y,z,r\n") + spheres);
        const Ended measured = bernal({"measure", folder.path().string(), "--json"});
        if (measured.status == 2)
          expect_refused_in_one_line(measured, {folder.path().string()});
        else
          EXPECT_EQ(measured.status, 0) << container << edge << spheres;
        const Ended verified = bernal({"verify", folder.path().string()});
        EXPECT_TRUE(verified.status == 0 || verified.status == 1) << verified.err;
      }
}

}  // namespace measure_test
}  // namespace bernal::testing

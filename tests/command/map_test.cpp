#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>

#include "check.hpp"

namespace bernal::testing {
namespace map_test {

using nlohmann::json;

TEST(MapCommand, MapsTwoPopulations) {
  const Folder folder;
  const Ended ended = bernal({"map", "0", "0.6", "--points", "30", "--ratios", "0.5,4", "--rods", "500", "-o",
                              folder.path().string()});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.err.find("densest"), std::string::npos) << ended.err;
  const std::string csv = text_of(folder.path() / "map.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 901);
  EXPECT_TRUE(csv.starts_with("ratio,share,phi\n0.5,0,")) << csv.substr(0, 60);
  EXPECT_TRUE(text_of(folder.path() / "map.svg").starts_with("<svg "));
}

TEST(MapCommand, StopsWithNothingHalfWritten) {
  const Folder folder;
  const Process map = start_bernal(
      {"map", "0.3", "0.6", "--points", "5000", "--rods", "1000000", "-o", folder.path().string()});
  // The handler stands when the progress bar does, after two seconds and a line.
  while (map.said().find("map") == std::string::npos) usleep(50'000);
  map.signal(SIGINT);
  const Ended ended = map.wait();
  EXPECT_EQ(ended.status, 3);
  EXPECT_NE(ended.err.find("nothing is written"), std::string::npos) << ended.err;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(MapCommand, RefusesAbsurdInputInOneLine) {
  const Folder folder;
  const auto refuses = [&](std::vector<std::string> words, const std::string& word) {
    words.insert(words.begin(), "map");
    words.insert(words.end(), {"-o", folder.path().string()});
    expect_refused_in_one_line(bernal(words), {word});
  };
  refuses({"0"}, "SIGMA_B");
  refuses({"0", "9"}, "SIGMA_B");
  refuses({"nan", "0"}, "SIGMA_A");
  refuses({"0", "0", "--ratios", "2,1"}, "ratios");
  refuses({"0", "0", "--ratios", "0,1"}, "ratios");
  refuses({"0", "0", "--points", "1"}, "points");
  refuses({"0", "0", "--rods", "0"}, "rods");
}

TEST(PredictCheck, SaysBothNumbers) {
  const Ended ended =
      bernal({"predict", "--classes", "1:1", "--check", "--spheres", "500", "--json", "--quiet"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json answer = json::parse(ended.out);
  const json& packed = answer["packed"];
  EXPECT_EQ(packed["spheres"], 500);
  EXPECT_EQ(packed["certified"], true);
  EXPECT_EQ(packed["outcome"], "converged");
  // The model is worth 0.01; 500 equal spheres scatter by 0.003 and lack 0.003 for the small box.
  EXPECT_NEAR(packed["phi"], answer["phi"], 0.02);
  EXPECT_NEAR(packed["phi_predicted_for_these_spheres"], answer["phi"], 1e-9);
  EXPECT_EQ(json::parse(bernal({"predict", "--classes", "1:1", "--check", "--spheres", "500", "--json"})
                            .out)["packed"]["phi"],
            packed["phi"]);

  const Ended text = bernal({"predict", "--lognormal", "0.3", "--check", "--spheres", "500", "--seed", "2"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_NE(text.out.find("packed  "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("difference"), std::string::npos) << text.out;
}

TEST(PredictCheck, OfASceneItsSizes) {
  const Folder folder;
  const std::string scene = folder.write("scene.toml", small_scene).string();
  const Ended ended = bernal({"predict", "--scene", scene, "--check", "--spheres", "200", "--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json::parse(ended.out)["packed"]["spheres"], 200);
}

TEST(PredictCheck, RefusesAbsurdInputInOneLine) {
  expect_refused_in_one_line(bernal({"predict", "--classes", "1:1", "--spheres", "5"}), {"--check"});
  expect_refused_in_one_line(bernal({"predict", "--classes", "1:1", "--check", "--spheres", "0"}),
                             {"--spheres"});
  expect_refused_in_one_line(bernal({"predict", "--classes", "1:1", "--check", "--stage", "bake"}), {"bake"});
  expect_refused_in_one_line(bernal({"predict", "--classes", "1:1", "--check", "--stage", "x\"\n"}), {});
}

}  // namespace map_test
}  // namespace bernal::testing

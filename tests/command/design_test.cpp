#include "check.hpp"

namespace bernal::testing {
namespace design_test {

using nlohmann::json;

Ended design(std::vector<std::string> words) {
  words.insert(words.begin(), "design");
  return bernal(std::move(words));
}

/// The one JSON object of an answer that was found.
json designed(std::vector<std::string> words) {
  words.push_back("--json");
  const Ended ended = design(std::move(words));
  EXPECT_EQ(ended.status, 0) << ended.err;
  return ended.status == 0 ? json::parse(ended.out) : json{{"phi", 0}, {"diameter", ""}, {"scene_line", ""}};
}

/// A scene with the line pasted unchanged.
std::string scene_with(const std::string& line) {
  return "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [500, 500, 500]\n[spheres]\ncount = 1000\n" +
         line + "\n";
}

/// The packing fraction that `predict` finds for a scene with the answer pasted, which `explain` must accept.
double phi_when_pasted(const json& answer) {
  const Folder folder;
  const std::string scene =
      folder.write("scene.toml", scene_with(answer["scene_line"].get<std::string>())).string();
  EXPECT_EQ(answer["scene_line"], "diameter = " + answer["diameter"].get<std::string>());
  const Ended explained = bernal({"explain", scene});
  EXPECT_EQ(explained.status, 0) << explained.err;
  const Ended predicted = bernal({"predict", "--scene", scene, "--json"});
  EXPECT_EQ(predicted.status, 0) << predicted.err;
  return predicted.status == 0 ? json::parse(predicted.out)["phi"].get<double>() : 0;
}

TEST(DesignCommand, TheDensestCompositionCanBePasted) {
  const json three = designed({"maximise", "--diameters", "1,3,9"});
  EXPECT_NEAR(three["phi"], 0.8336, 1e-4);
  EXPECT_NEAR(phi_when_pasted(three), three["phi"], 1e-9);
  EXPECT_EQ(three["populations"].size(), 3u);
  EXPECT_GE(three["agreeing"], 1);
  EXPECT_LE(three["agreeing"], three["starts"]);

  // A size in the way is left out of the table, not of the answer.
  const json two_of_three = designed({"maximise", "--diameters", "4,2,1"});
  EXPECT_EQ(two_of_three["populations"][1]["share"], 0);
  EXPECT_NEAR(phi_when_pasted(two_of_three), two_of_three["phi"], 1e-9);
  EXPECT_NEAR(phi_when_pasted(designed({"maximise", "--diameters", "2,2"})), 0.6434855, 1e-6);
}

TEST(DesignCommand, LognormalPopulationsToo) {
  const json answer = designed(
      {"maximise", "--lognormal", "1,0.9", "--lognormal", "2,2", "--diameters", "8", "--rods", "1000"});
  const Folder folder;
  const std::string scene = folder.write("scene.toml", scene_with(answer["scene_line"])).string();
  const json again = json::parse(bernal({"predict", "--scene", scene, "--rods", "1000", "--json"}).out);
  EXPECT_NEAR(again["phi"], answer["phi"], 1e-9);
  // No worse than what anyone would try first.
  const Ended even = bernal({"predict", "--lognormal", "1,0.9,1", "--lognormal", "2,2,0", "--classes", "8:3",
                             "--rods", "1000", "--json"});
  EXPECT_GE(answer["phi"], json::parse(even.out)["phi"].get<double>());
}

TEST(DesignCommand, EveryFamilyMeetsTheTargetAndTheLimits) {
  for (const std::string family : {"lognormal", "rosin_rammler", "uniform", "fuller", "two_sizes"}) {
    SCOPED_TRACE(family);
    const json answer = designed({"target", "--phi", "0.69", "--family", family, "--max-ratio", "8"});
    EXPECT_NEAR(answer["phi"], 0.69, 1e-6);
    EXPECT_NEAR(phi_when_pasted(answer), 0.69, 1e-6);
    EXPECT_EQ(answer["family"], family);
    if (answer["parameter"]["name"] == "max/min") {
      EXPECT_LE(answer["parameter"]["value"], 8);
    }
    const json within =
        designed({"target", "--phi", "0.69", "--family", family, "--min", "3", "--max", "24"});
    EXPECT_NEAR(within["parameter"]["value"], answer["parameter"]["value"], 1e-6);  // scale does not matter
  }
}

TEST(DesignCommand, LognormalWidthsAsPublished) {
  // Farr 2013, table 1, backwards.
  const json half = designed({"target", "--phi", "0.7072591", "--family", "lognormal"});
  EXPECT_EQ(half["parameter"]["name"], "sigma");
  EXPECT_NEAR(half["parameter"]["value"], 0.5, 2e-6);
  // Limits that hardly cut anything off change nothing.
  const json wide =
      designed({"target", "--phi", "0.7072591", "--family", "lognormal", "--max-ratio", "1000"});
  EXPECT_NEAR(wide["parameter"]["value"], 0.5, 1e-4);
  EXPECT_LT(wide["cut_off"], 1e-8);
}

TEST(DesignCommand, SaysWhatIsReachedWhereTheTargetIsNot) {
  for (const std::string phi : {"0.6", "0.9"}) {
    const Ended ended =
        design({"target", "--phi", phi, "--family", "lognormal", "--max-ratio", "10", "--json"});
    EXPECT_EQ(ended.status, 3);
    const json answer = json::parse(ended.out);
    EXPECT_FALSE(answer["found"].get<bool>());
    EXPECT_TRUE(answer["diameter"].is_null());
    EXPECT_NEAR(answer["reachable"][0], 0.64349, 1e-4);
    EXPECT_NEAR(answer["reachable"][1], 0.7353, 1e-3);
    EXPECT_NE(ended.err.find("from 0.64348"), std::string::npos) << ended.err;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    const Ended text = design({"target", "--phi", phi, "--family", "lognormal", "--max-ratio", "10"});
    EXPECT_EQ(text.status, 3);
    EXPECT_EQ(text.out, "");
  }
}

TEST(DesignCommand, TheBestBetweenTwoLimits) {
  const json answer = designed({"best", "--min", "1", "--max", "10", "--bins", "8", "--rods", "4000"});
  const json levels = answer["levels"];
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_LT(levels[0]["phi"], levels[1]["phi"]);
  EXPECT_LT(levels[1]["phi"], levels[2]["phi"]);
  EXPECT_GE(levels[0]["phi"], answer["power_law"]["phi"].get<double>() - 1e-4);
  EXPECT_NEAR(answer["phi"], 0.822, 1e-3);
  // Three sizes are denser than two, 0.8273, and than any density.
  EXPECT_NEAR(answer["few_sizes"]["phi"], 0.8407, 1e-3);
  const Folder folder;
  for (const json& one : {answer, answer["few_sizes"]}) {
    const std::string scene = folder.write("scene.toml", scene_with(one["scene_line"])).string();
    EXPECT_EQ(bernal({"explain", scene}).status, 0);
    const Ended predicted = bernal({"predict", "--scene", scene, "--rods", "4000", "--json"});
    EXPECT_NEAR(json::parse(predicted.out)["phi"], one["phi"], 1e-9);
  }
}

TEST(DesignCommand, SaysTheSameTwice) {
  const auto without_time = [](json answer) {
    answer.erase("seconds");
    return answer;
  };
  EXPECT_EQ(without_time(designed({"maximise", "--diameters", "1,4,16"})),
            without_time(designed({"maximise", "--diameters", "1,4,16"})));
}

TEST(DesignCommand, TextEndsWithTheTable) {
  const Ended ended = design({"maximise", "--diameters", "1,5"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_NE(ended.out.find("0.7877"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("9 of 9 starts"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("\ndiameter = { distribution = \"classes\", values = [1, 5]"), std::string::npos)
      << ended.out;
}

TEST(DesignCommand, RefusesAbsurdInputInOneLine) {
  std::string many = "1";
  for (int k = 0; k < 50'000; ++k) many += ",1";
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "subcommand"},
      {{"maximise"}, "--diameters"},
      {{"maximise", "--diameters", "5"}, "one population"},
      {{"maximise", "--diameters", "1,2,3,4,5,6,7"}, "no more than 6"},
      {{"maximise", "--diameters", many}, "more than 10000"},
      {{"maximise", "--diameters", "1,0"}, "diameter"},
      {{"maximise", "--diameters", "1,-2"}, "diameter"},
      {{"maximise", "--diameters", "1,nan"}, "diameter"},
      {{"maximise", "--diameters", "1,inf"}, "diameter"},
      {{"maximise", "--diameters", "1,,2"}, "number"},
      {{"maximise", "--diameters", "1:2,3:4"}, "number"},
      {{"maximise", "--diameters", "1,1e6"}, "--rods"},
      {{"maximise", "--diameters", "1e-300,1e300"}, "from 1e-20 to 1e20"},
      {{"maximise", "--diameters", "1e-200,2e-200"}, "another unit"},
      {{"best", "--min", "1e-40", "--max", "2e-40"}, "another unit"},
      {{"maximise", "--lognormal", "1,2", "--diameters", "3"}, "swapped"},
      {{"maximise", "--lognormal", "1", "--diameters", "3"}, "D43,D32"},
      {{"maximise", "--lognormal", "1,1e-300", "--diameters", "3"}, "sigma"},
      {{"maximise", "--diameters", "1,2", "--rods", "0"}, "rods"},
      {{"target"}, "--phi"},
      {{"target", "--phi", "0.7"}, "--family"},
      {{"target", "--phi", "0.7", "--family", "bell"}, "lognormal"},
      {{"target", "--phi", "nan", "--family", "lognormal"}, "--phi"},
      {{"target", "--phi", "-1", "--family", "lognormal"}, "--phi"},
      {{"target", "--phi", "70", "--family", "lognormal"}, "--phi"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--max-ratio", "1"}, "--max-ratio"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--max-ratio", "nan"}, "--max-ratio"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--max-ratio", "1e9"}, "--max-ratio"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--max", "5"}, "--max-ratio"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--min", "5", "--max", "5"}, "below"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--min", "0", "--max", "5"}, "diameter"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--min", "1e-308", "--max", "1e308"}, "--max"},
      {{"target", "--phi", "0.7", "--family", "lognormal", "--min", "1", "--max", "5", "--max-ratio", "5"},
       "third"},
      {{"target", "--phi", "0.7", "--family", "fuller", "--exponent", "0"}, "--exponent"},
      {{"best"}, "--min"},
      {{"best", "--min", "1"}, "--max"},
      {{"best", "--min", "1", "--max", "1"}, "below"},
      {{"best", "--min", "-1", "--max", "1"}, "diameter"},
      {{"maximise", "--diameters", "1,5e-324"}, "from 1e-20 to 1e20"},
      {{"best", "--min", "nan", "--max", "1"}, "--min"},
      {{"best", "--min", "1", "--max", "1e9"}, "apart"},
      {{"best", "--min", "1", "--max", "2000"}, "rods"},
      {{"best", "--min", "1", "--max", "10", "--bins", "3"}, "bins"},
  };
  for (const auto& [words, word] : wrong) {
    std::string shown;
    for (const std::string& each : words) shown += each.substr(0, 40) + " ";
    SCOPED_TRACE(shown);
    expect_refused_in_one_line(design(words), {word});
  }
}

// What design says of a layer, predict says of the packing with that line in its scene.
TEST(DesignCommand, ALayerThatIsToFillAFraction) {
  const Folder folder;
  const std::string scene =
      folder
          .write("scene.toml",
                 scene_with("radius = 1\nlayers = [{ name = \"kernel\", radius = 0.5, material = \"UO2\" }, "
                            "{ name = \"shell\" }]"))
          .string();
  const json found = designed({"layer", scene, "--layer", "kernel", "--fraction", "0.05"});
  EXPECT_NEAR(found["share"].get<double>(), 0.125, 1e-12);
  EXPECT_NEAR(found["phi"].get<double>(), 0.4, 1e-12);
  EXPECT_EQ(designed({"layer", scene, "--layer", "UO2", "--fraction", "0.05"})["phi"], found["phi"]);
  const Ended too_much = design({"layer", scene, "--layer", "kernel", "--fraction", "0.1"});
  EXPECT_EQ(too_much.status, 3);
  EXPECT_NE(too_much.err.find("kernel cannot fill 0.1 of a packing"), std::string::npos) << too_much.err;
  const Ended predicted = bernal({"predict", "--scene", scene, "--json"});
  const json layers = json::parse(predicted.out);
  EXPECT_NEAR(layers["layers"][0]["share"].get<double>(), 0.125, 1e-12);
  EXPECT_NEAR(layers["materials"][1]["packing_fraction"].get<double>(), 0.875 * layers["phi"].get<double>(),
              1e-12);
  expect_refused_in_one_line(design({"layer", scene, "--layer", "core", "--fraction", "0.1"}),
                             {"no layer is called core", "kernel, shell"});
  expect_refused_in_one_line(design({"layer", scene, "--layer", "kernel", "--fraction", "2"}),
                             {"--fraction"});
  const std::string plain = folder.write("plain.toml", scene_with("radius = 1")).string();
  expect_refused_in_one_line(design({"layer", plain, "--layer", "kernel", "--fraction", "0.1"}),
                             {"no layers"});
}

}  // namespace design_test
}  // namespace bernal::testing

#include <cmath>

#include "check.hpp"

namespace bernal::testing {
namespace predict_test {

using nlohmann::json;

json predicted(std::vector<std::string> words, const std::string& input = "/dev/null") {
  words.insert(words.begin(), "predict");
  words.push_back("--json");
  const Ended ended = bernal(words, input);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  return ended.status == 0 ? json::parse(ended.out) : json{{"phi", 0}};
}

double phi_of(std::vector<std::string> words, const std::string& input = "/dev/null") {
  return predicted(std::move(words), input)["phi"];
}

/// A file of this text, to be read as standard input.
class Input {
 public:
  explicit Input(const std::string& text) : path_(folder_.write("input.txt", text).string()) {}
  operator const std::string&() const { return path_; }

 private:
  Folder folder_;
  std::string path_;
};

TEST(PredictCommand, SaysWhatThePaperPrints) {
  // Farr 2013, table 1, with an exact erfc.
  EXPECT_NEAR(phi_of({"--lognormal", "0"}), 0.6434855, 1e-7);
  EXPECT_NEAR(phi_of({"--lognormal", "0.5"}), 0.7072591, 1e-7);
  EXPECT_NEAR(phi_of({"--sigma", "1"}), 0.8013511, 1e-7);
  EXPECT_NEAR(phi_of({"--sigma", "1", "--rods", "64000"}), 0.8013799, 1e-7);
  EXPECT_NEAR(phi_of({"--lognormal", "2,0.5,1"}), 0.8300218, 1e-7);

  const json answer = predicted({"--lognormal", "0.5", "--rods", "4000"});
  EXPECT_EQ(answer["rods"], 4000);
  EXPECT_EQ(answer["method"], "rods");
  EXPECT_LT(answer["error"], 1e-4);
  EXPECT_GT(answer["error"], 1e-6);
  EXPECT_GT(answer["seconds"], 0);
}

TEST(PredictCommand, GapsBetweenRodsMayBeOthers) {
  EXPECT_EQ(phi_of({"--lognormal", "0.5", "--gap-factor", "0.7654"}), phi_of({"--lognormal", "0.5"}));
  const json loose = predicted({"--lognormal", "0", "--gap-factor", "0.918"});
  EXPECT_NEAR(loose["phi"], 0.60, 1e-4);
  EXPECT_EQ(loose["gap_factor"], 0.918);
  EXPECT_EQ(phi_of({"--classes", "1:1,5:1", "--gap-factor", "0"}), 1);
  const json checked =
      predicted({"--lognormal", "0", "--gap-factor", "0.918", "--check", "--spheres", "100"});
  EXPECT_NEAR(checked["packed"]["phi_predicted_for_these_spheres"], checked["phi"], 1e-9);
  expect_refused_in_one_line(bernal({"predict", "--lognormal", "0", "--gap-factor", "-1"}), {"--gap-factor"});
  expect_refused_in_one_line(bernal({"predict", "--lognormal", "0", "--gap-factor", "1", "--fit"}),
                             {"--fit"});
}

TEST(PredictCommand, EveryDoorLeadsToTheSameSizes) {
  // Equal volumes, d43 as 1 : 2, widths 0.3 and 0: 0.702 in Farr's table 2.
  const std::string d32 = std::to_string(std::exp(-0.09));
  const double flags = phi_of({"--lognormal", "1," + d32 + ",5", "--classes", "2:5"});
  EXPECT_NEAR(flags, 0.702, 0.5e-3);
  EXPECT_NEAR(phi_of({"--stdin", "l"}, Input("# d43 d32 volume\n1 " + d32 + " 3\n\n2,2,3  # equal\n")), flags,
              1e-9);
  EXPECT_NEAR(phi_of({"--stdin", "w"}, Input("10 0.3 1\r\n20\t0\t1")), flags, 1e-6);
  EXPECT_NEAR(phi_of({"--stdin", "w"}, Input("1e-6 .3 .4\n1e-6 .3 .6\n2e-6 0 1\n5 0 0\n")), flags, 1e-6);

  const double classes = phi_of({"--classes", "1:0.25,5:0.5,5:0.25"});
  EXPECT_NEAR(classes, 0.7831, 1e-4);
  EXPECT_NEAR(phi_of({"--stdin", "d"}, Input("5 3\n1 1\n")), classes, 1e-12);
  const Folder folder;
  const std::string scene = folder
                                .write("scene.toml",
                                       "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [50, 50, 50]\n"
                                       "[spheres]\ncount = 10\ndiameter = { distribution = \"classes\", "
                                       "values = [1, 5], shares = [1, 3], basis = \"volume\" }\n")
                                .string();
  EXPECT_NEAR(phi_of({"--scene", scene}), classes, 1e-12);
}

TEST(PredictCommand, FitAndViscosity) {
  const json fit = predicted({"--lognormal", "0.5", "--fit"});
  EXPECT_EQ(fit["method"], "fit");
  EXPECT_NEAR(fit["phi"], 0.70726, 1e-4);
  const json flow = predicted({"--classes", "1:1", "--solids", "0.5"});
  const double phi = flow["phi"];
  EXPECT_NEAR(flow["relative_viscosity"], std::pow(1 - 0.5 / phi, -2.5 * phi), 1e-9);
  const Ended text = bernal({"predict", "--lognormal", "0.5", "--solids", "0.6"});
  EXPECT_EQ(text.status, 0);
  EXPECT_NE(text.out.find("0.707259"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("viscosity"), std::string::npos) << text.out;
}

TEST(PredictCommand, RefusesAbsurdInputInOneLine) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "--lognormal"},
      {{"--lognormal", "0.5", "--stdin", "d"}, "one way"},
      {{"--lognormal", "50"}, "sigma"},
      {{"--lognormal", "-0.5"}, "sigma"},
      {{"--lognormal", "nan"}, "sigma"},
      {{"--lognormal", "half"}, "half"},
      {{"--lognormal", ""}, "number"},
      {{"--lognormal", "1,2"}, "D43,D32,VOLUME"},
      {{"--lognormal", "1,2,1"}, "swapped"},
      {{"--lognormal", "2,1,-1"}, "volume"},
      {{"--lognormal", "2,0,1"}, "diameter"},
      {{"--lognormal", "1,1e-300,1"}, "sigma"},
      {{"--lognormal", "2,1,nan"}, "volume"},
      {{"--lognormal", "0.5", "--classes", "1:1"}, "size"},
      {{"--lognormal", "0.5", "--lognormal", "0.6"}, "size"},
      {{"--classes", "0:1"}, "diameter"},
      {{"--classes", "1:-1"}, "volume"},
      {{"--classes", "1:0"}, "zero"},
      {{"--classes", "1:inf"}, "volume"},
      {{"--classes", "1e999:1"}, "range"},
      {{"--classes", "1:1,1e-90:1"}, "far apart"},
      {{"--classes", "1:1,"}, "DIAMETER:VOLUME"},
      {{"--classes", "1"}, "DIAMETER:VOLUME"},
      {{"--scene", "/nowhere/scene.toml"}, "/nowhere/scene.toml"},
      {{"--lognormal", "1", "--rods", "1"}, "rods"},
      {{"--lognormal", "1", "--rods", "1000000000"}, "rods"},
      {{"--lognormal", "3.5", "--fit"}, "3"},
      {{"--classes", "1:1,2:1", "--fit"}, "one lognormal"},
      {{"--lognormal", "0.5", "--solids", "0.8"}, "jams"},
      {{"--lognormal", "0.5", "--solids", "nan"}, "--solids"},
      {{"--lognormal", "0.5", "--solids", "0.3", "--intrinsic", "-1"}, "intrinsic"},
      {{"--lognormal", "0.5", "--intrinsic", "3"}, "--solids"},
      // Of the packing's scene, which the user never saw, no line is named.
      {{"--lognormal", "0.5", "--check", "--stage", "shuffle"}, "bernal: unknown stage"},
      {{"--lognormal", "0.5", "--check", "--stage", "insert"}, "bernal: \"layout\" in [[stage]] insert"},
      {{"--wide", "1"}, "bernal predict --help"},
      {{"--stdin", "x"}, "stdin"},
      {{"--stdin", "d"}, "no population"},
  };
  for (const auto& [words, word] : wrong) {
    std::vector<std::string> call = {"predict"};
    call.insert(call.end(), words.begin(), words.end());
    std::string shown;
    for (const std::string& each : call) shown += each + " ";
    SCOPED_TRACE(shown);
    expect_refused_in_one_line(bernal(call), {word});
  }
}

TEST(PredictCommand, RefusesAbsurdTablesAtTheirLine) {
  const auto refuses = [](const std::string& format, const std::string& text, const std::string& word) {
    SCOPED_TRACE(text.substr(0, 60));
    expect_refused_in_one_line(bernal({"predict", "--stdin", format}, Input(text)), {word});
  };
  refuses("d", "1 1\n2 -1\n", "line 2");
  refuses("d", "1 1\n\n0 1\n", "line 3");
  refuses("d", "1 1 1\n", "diameter volume");
  refuses("l", "1 1\n", "d43 d32 volume");
  refuses("w", "1 50 1\n", "sigma");
  refuses("w", "1 nan 1\n", "sigma");
  refuses("d", "1 one\n", "\"one\"");
  refuses("d", "\033[2J\a 1\n", "\" [2J \"");  // a terminal is not at the mercy of a file
  refuses("d", std::string("1 1\n\0\0\0\n", 8), "line 2");
  std::string many;
  for (int k = 1; k <= 100'000; ++k) many += std::to_string(k) + " 1\n";
  refuses("d", many, "more than 10000 populations");
  refuses("d", std::string(5 << 20, '\n'), "4 MB");
  expect_refused_in_one_line(bernal({"predict", "--stdin", "l"}, "/dev/zero"), {"4 MB"});
}

TEST(PredictCommand, TenThousandPopulationsAreNoTrouble) {
  std::string many;
  for (int k = 1; k <= 10'000; ++k) many += std::to_string(1 + 0.01 * k) + " 1\n";
  // Volume spread evenly over diameters from 1 to 101: that many classes are as good as all.
  std::string fewer;
  for (int k = 1; k <= 1000; ++k) fewer += std::to_string(0.955 + 0.1 * k) + " 1\n";
  EXPECT_NEAR(phi_of({"--stdin", "d"}, Input(many)), phi_of({"--stdin", "d"}, Input(fewer)), 1e-4);
}

}  // namespace predict_test
}  // namespace bernal::testing

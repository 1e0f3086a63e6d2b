#include <gtest/gtest.h>

#include <fmt/format.h>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "soft/relax.hpp"
#include "support/plans.hpp"

// What the keys of relaxation mean.
namespace bernal {
namespace relax_keys_test {

std::string scene(const std::string& box, int count, const std::string& stage) {
  return fmt::format(
      "[container]\nkind = \"periodic\"\n{}\n[spheres]\ncount = {}\nradius = 1.0\n[[stage]]\ndo = "
      "\"relax\"\n{}\n",
      box, count, stage);
}

std::string hash_with(const std::string& box, int count, const std::string& stage) {
  return hash_of(
      run(testing::plan_of(scene(box, count, stage)), {.seed = {}, .threads = 1, .monitor = {}}).spheres);
}

// alpha (log10 N)² is 8 sweeps for 100 spheres of alpha = 2, and for 1,000 of alpha = 8 / 9.
TEST(Period, IsTheNumberOfSweepsThatAlphaGivesElsewhere) {
  for (const std::string method : {"method = \"fast\"\n", "method = \"reference\"\n"}) {
    for (const std::string box : {"dimension = 2", "dimension = 3", "dimension = 4"}) {
      SCOPED_TRACE(method + box);
      const std::string fixed = hash_with(box, 100, method + "period = 8");
      EXPECT_EQ(fixed, hash_with(box, 100, method + "alpha = 2.0"));
      EXPECT_NE(fixed, hash_with(box, 100, method + "period = 9"));
    }
  }
  const std::string thousand = hash_with("", 1000, "period = 8\nstop = 0.01");
  EXPECT_EQ(thousand, hash_with("", 1000, "alpha = 0.888888888888889\nstop = 0.01"));
  EXPECT_NE(thousand, hash_with("", 1000, "alpha = 2.0\nstop = 0.01"));
}

TEST(Period, StandsInPlaceOfAlphaInTheSceneAsRun) {
  const Scene made = parse_scene(scene("", 9, "period = 40"), "s.toml");
  EXPECT_EQ(made.stages[0].as<Relax>()->period, 40);
  const std::string written = scene_as_toml(made);
  EXPECT_NE(written.find("period = 40"), std::string::npos) << written;
  EXPECT_EQ(written.find("alpha"), std::string::npos) << written;
  EXPECT_EQ(scene_as_toml(parse_scene(written, "s.toml")), written);
}

TEST(Period, IsAWholeNumberAndExcludesAlpha) {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      parse_scene(text, "s.toml");
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(scene("", 9, "alpha = 17\nperiod = 40")),
            "s.toml:10: \"alpha\" and \"period\" in [[stage]] relax exclude each other; give one of them");
  for (const std::string bad : {"0", "-3", "1000001"})
    EXPECT_EQ(refusal(scene("", 9, "period = " + bad)),
              "s.toml:9: \"period\" in [[stage]] relax must be a whole number from 1 to 1000000, not " + bad);
  EXPECT_NE(refusal(scene("", 9, "period = 2.5")), "accepted");
  EXPECT_NE(refusal("container = { kind = \"sphere\", radius = 9 }\n[spheres]\ncount = 9\nradius = 1\n"
                    "[[stage]]\ndo = \"relax\"\nperiod = 8\n")
                .find("acts in periodic boxes only"),
            std::string::npos);
}

}  // namespace relax_keys_test
}  // namespace bernal

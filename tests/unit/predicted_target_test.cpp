// packing_fraction = "predicted": the scene leaves it to the prediction how large the box is or how many
// spheres there are.

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/predict/predict.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"

namespace bernal {
namespace predicted_target_test {

Scene scene_of(const std::string& container, const std::string& spheres) {
  return parse_scene("[container]\n" + container + "\n[spheres]\n" + spheres + "\n", "test.toml");
}

const std::string periodic = "kind = \"periodic\"";
const std::string predicted = "packing_fraction = \"predicted\"\n";

TEST(PredictedTarget, IsReadAndWritten) {
  const Scene scene = scene_of(periodic, "count = 10\nradius = 1\n" + predicted);
  EXPECT_TRUE(scene.target.predicted);
  EXPECT_FALSE(scene.target.packing_fraction);
  EXPECT_FALSE(scene.target.is_open());
  EXPECT_TRUE(parse_scene(scene_as_toml(scene), "again.toml").target.predicted);
  // What has been built has a number, which makes the same plan again.
  const Scene built = build(scene).scene;
  const Scene again = parse_scene(scene_as_toml(built), "again.toml");
  EXPECT_FALSE(again.target.predicted);
  EXPECT_EQ(again.target.packing_fraction, built.target.packing_fraction);
}

TEST(PredictedTarget, IsThePredictionLessItsError) {
  const Plan plan = build(scene_of(periodic, "count = 10\nradius = 1\n" + predicted));
  const double phi = predict_packing_fraction(*make_constant(1)).phi;
  // The rod model is up to 0.01 above simulations; then rounded down to four digits.
  EXPECT_NEAR(*plan.scene.target.packing_fraction, phi - 0.01, 1e-4);
  EXPECT_LE(*plan.scene.target.packing_fraction, phi - 0.01);
  EXPECT_NEAR(plan.expected_packing_fraction, *plan.scene.target.packing_fraction, 1e-12);

  const std::string box = "kind = \"box\"\nsize = [10, 10, 10]";
  const Plan walls = build(scene_of(box, "diameter = 1\n" + predicted));
  const Plan open = build(scene_of(box, "diameter = 1"));
  EXPECT_NEAR(*walls.scene.target.packing_fraction, open.expected_packing_fraction - 0.016, 1e-4);
}

TEST(PredictedTarget, ChoosesTheBoxOrTheCount) {
  const std::string sizes =
      "diameter = { distribution = \"lognormal\", median = 1, sigma = 0.3 }\ndraw = \"quantiles\"\n";
  const Packing chosen_box = run(build(scene_of(periodic, "count = 1000\n" + sizes + predicted)));
  EXPECT_EQ(chosen_box.outcome, Outcome::converged) << chosen_box.reason;
  EXPECT_EQ(chosen_box.spheres.size(), 1000u);
  // The box is made for these spheres, so to rounding.
  EXPECT_NEAR(chosen_box.packing_fraction(), *chosen_box.scene.target.packing_fraction, 1e-9);

  const Packing chosen_count = run(build(scene_of(periodic + "\nedge = 10", sizes + predicted)));
  EXPECT_EQ(chosen_count.outcome, Outcome::converged) << chosen_count.reason;
  // To within the last sphere.
  EXPECT_GE(chosen_count.packing_fraction(), *chosen_count.scene.target.packing_fraction);
  EXPECT_LT(chosen_count.packing_fraction(), *chosen_count.scene.target.packing_fraction + 0.01);
}

TEST(PredictedTarget, WhatRanCanBeRunAgain) {
  const Packing first = run(build(scene_of(periodic, "count = 200\nradius = 1\n" + predicted)));
  const Packing again = run(build(parse_scene(scene_as_toml(first.scene), "again.toml")));
  EXPECT_EQ(hash_of(first.spheres), hash_of(again.spheres));
  EXPECT_EQ(again.outcome, Outcome::converged) << again.reason;
}

TEST(PredictedTarget, InAContainerTheCount) {
  const Packing packing =
      run(build(scene_of("kind = \"cylinder\"\nradius = 5\nheight = 12", "diameter = 1\n" + predicted)));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_GE(packing.packing_fraction(), *packing.scene.target.packing_fraction);
}

TEST(PredictedTarget, RefusesWhatItCannotMean) {
  const auto refuses = [](const std::string& container, const std::string& spheres, const std::string& word) {
    SCOPED_TRACE(word);
    try {
      build(scene_of(container, spheres));
      FAIL() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      EXPECT_GT(error.location().line, 0);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  refuses(periodic + "\ndimension = 2", "count = 10\nradius = 1\n" + predicted, "three dimensions, not in 2");
  refuses(periodic + "\nedge = 9", "count = 10\nradius = 1\n" + predicted, "exclude each other");
  refuses(periodic, "radius = 1\n" + predicted, "needs a \"count\"");
  refuses(periodic, "count = 9\nradius = 1\npacking_fraction = \"guessed\"",
          "or \"predicted\", not \"guessed\"");
}

}  // namespace predicted_target_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <algorithm>

#include "bernal/core/error.hpp"
#include "bernal/fly/fly.hpp"
#include "bernal/plan/plan.hpp"
#include "bernal/scene/read_scene.hpp"

// What a scene with `fly` may ask for, and what its plan says.
namespace bernal {
namespace fly_scene_test {

Plan plan_of(const std::string& box, const std::string& spheres, const std::string& stage = "") {
  return build(parse_scene("[container]\nkind = \"periodic\"\n" + box + "\n[spheres]\n" + spheres +
                               "\nradius = 1.0\n[[stage]]\ndo = \"fly\"\n" + stage,
                           "test.toml"));
}

std::string complaint(const std::string& box, const std::string& spheres, const std::string& stage = "") {
  try {
    plan_of(box, spheres, stage);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    EXPECT_GT(error.location().line, 0) << error.what();
    return error.what();
  }
  return "";
}

const std::string fraction = "packing_fraction = 0.3";

TEST(FlyScene, MayGiveThePackingFractionInTheStage) {
  const Plan in_spheres = plan_of("edge = 10.0", fraction), in_stage = plan_of("edge = 10.0", "", fraction);
  EXPECT_EQ(in_stage.scene.target.packing_fraction, in_spheres.scene.target.packing_fraction);
  EXPECT_EQ(in_stage.expected_count, in_spheres.expected_count);
  EXPECT_FALSE(in_stage.scene.stages[0].as<Fly>()->packing_fraction);  // it is said once
  EXPECT_NEAR(plan_of("", "count = 100", fraction).expected_packing_fraction, 0.3, 1e-12);
}

TEST(FlyScene, SaysWhatIsMissingOrSaidTwice) {
  for (const char* twice : {"packing_fraction = 0.4", "count = 3", "fill = true"})
    EXPECT_NE(complaint("edge = 10.0", twice, fraction).find("says again"), std::string::npos) << twice;
  EXPECT_NE(complaint("edge = 10.0", "").find("give \"packing_fraction\""), std::string::npos);
  EXPECT_NE(complaint("edge = 10.0", "fill = true").find("give \"packing_fraction\""), std::string::npos);
  EXPECT_NE(complaint("", "count = 100").find("give \"packing_fraction\""), std::string::npos);
  EXPECT_EQ(complaint("edge = 10.0", "count = 3"), "");
}

// The method stands in the plan with its reason, and only its effects are planned.
TEST(FlyScene, IsExplained) {
  const auto item = [](const Plan& plan) {
    const auto found = std::ranges::find(plan.items, "fly", &PlanItem::name);
    return found == plan.items.end() ? std::string() : found->what;
  };
  const Plan flight = plan_of("edge = 10.0", fraction, "method = \"flight\"\n"),
             pushed = plan_of("edge = 10.0", "packing_fraction = 0.6");
  EXPECT_NE(item(flight).find("by flight, as"), std::string::npos) << item(flight);
  EXPECT_NE(item(pushed).find("by relaxation, which"), std::string::npos) << item(pushed);
  const auto leaves_out = [](const Plan& plan, const char* effect) {
    return std::ranges::find(plan.absent, effect) != plan.absent.end();
  };
  EXPECT_TRUE(leaves_out(flight, "relaxation"));
  EXPECT_TRUE(leaves_out(pushed, "collisions"));
  EXPECT_FALSE(leaves_out(pushed, "relaxation"));
}

}  // namespace fly_scene_test
}  // namespace bernal

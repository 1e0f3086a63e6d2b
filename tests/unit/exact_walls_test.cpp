// walls = "exact" reaches what every stage decides about walls, and no other level does.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

namespace bernal {
namespace exact_walls_test {

struct Protocol {
  const char* name;
  std::string stages;
  /// What the stages decide without the last of them; empty for one.
  std::string before = {};
  friend void PrintTo(const Protocol& protocol, std::ostream* out) { *out << protocol.name; }
};

const std::string insert = "[[stage]]\ndo = \"insert\"\npacking_fraction = 0.2\n";
const std::string compress = "[[stage]]\ndo = \"compress\"\nmax_iterations = 8\n";
const std::string shake = "[[stage]]\ndo = \"shake\"\nrounds = 1\n";
const std::string refill =
    "[[stage]]\ndo = \"refill\"\nmax_rounds = 1\nprobes = 1\nshakes = 0\nmax_iterations = 4\n";
const std::string relax = "[[stage]]\ndo = \"relax\"\n";
const std::string polish = "[[stage]]\ndo = \"relax\"\npolish = 1e-6\n";
const std::string grow = "[[stage]]\ndo = \"grow\"\nrate = 0.1\npressure = 1e3\n";

const std::string box = "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";

/// In an L of arms 2 long, a mesh, or where a mesh has to be convex a prism; as many as there is room for
/// where they are to be polished.
Packing packed(const std::string& stages, WallArithmetic walls) {
  const bool grows = stages.find("grow") != std::string::npos;
  const bool few = stages.find("relax") == std::string::npos;
  const std::string spheres = few ? "[spheres]\ncount = 60\nradius = 0.15\n" : "[spheres]\nradius = 0.2\n";
  Plan plan =
      testing::plan_of(box + spheres + stages, grows ? test::prism_mesh(6, 1, 1.5) : test::l_shape_mesh());
  plan.scene.walls = walls;
  plan.container = make_local_container(plan.domain, frame_of(plan.domain), walls);
  RunOptions options;
  options.threads = 1;
  return run(plan, options);
}

std::uint64_t exact_decisions_in(const Packing& packing) {
  for (const Effect& effect : packing.effects)
    if (effect.name == "exact walls") return effect.calls;
  return 0;
}

class ExactWalls : public ::testing::TestWithParam<Protocol> {};

TEST_P(ExactWalls, DecideInEveryStageAndAreCertified) {
  const Packing packing = packed(GetParam().stages, WallArithmetic::exact);
  EXPECT_GT(packing.spheres.size(), 30u);
  const std::uint64_t decided = exact_decisions_in(packing);
  EXPECT_GE(decided, packing.spheres.size()) << "every sphere was let in by one";
  if (!GetParam().before.empty()) {
    EXPECT_GT(decided, exact_decisions_in(packed(GetParam().before, WallArithmetic::exact)))
        << "the last stage adds some";
  }
  EXPECT_TRUE(certify(packing.spheres, packing.domain, {.arithmetic = Arithmetic::exact}).certified);
}

INSTANTIATE_TEST_SUITE_P(Stages, ExactWalls,
                         ::testing::Values(Protocol{"Insert", insert},
                                           Protocol{"Compress", insert + compress, insert},
                                           Protocol{"Shake", insert + compress + shake, insert + compress},
                                           Protocol{"Refill", insert + refill, insert},
                                           Protocol{"Relax", relax}, Protocol{"Polish", polish, relax},
                                           Protocol{"Grow", grow}),
                         [](const auto& tested) { return tested.param.name; });

TEST(ExactWalls, AreNoEffectOfOtherLevels) {
  for (const WallArithmetic walls : {WallArithmetic::plain, WallArithmetic::filtered}) {
    const Packing packing = packed(insert + compress, walls);
    EXPECT_EQ(exact_decisions_in(packing), 0u);
    EXPECT_TRUE(certify(packing.spheres, packing.domain).certified);
  }
}

TEST(ExactWalls, StandInThePlanOfScenesThatAskForThem) {
  const auto planned = [](const std::string& walls) {
    const Plan plan = testing::plan_of(
        box + ("[spheres]\ncount = 60\nradius = 0.1\n[accuracy]\nwalls = \"" + walls + "\"\n") + insert);
    return std::ranges::find(plan.items, "exact walls", &PlanItem::name) != plan.items.end();
  };
  EXPECT_TRUE(planned("exact"));
  EXPECT_FALSE(planned("filtered"));
  EXPECT_FALSE(planned("double"));
}

}  // namespace exact_walls_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

// How runs end where there is hardly room, a tail of sizes without end, a place far away, or nothing at all:
// "converged" is what was asked for and what was to be expected, anything else is said.
namespace bernal {
namespace ends_test {

using testing::plan_of;

std::string stages(std::initializer_list<const char*> names) {
  std::string text;
  for (const char* name : names) text += fmt::format("\n[[stage]]\ndo = \"{}\"\n", name);
  return text;
}
const std::vector<std::string> protocols = {"", stages({"insert"}), stages({"relax"}), stages({"grow"}),
                                            stages({"insert", "compress", "shake", "refill"})};

std::string in(const std::string& container, const std::string& spheres) {
  return "[container]\n" + container + "\n[spheres]\n" + spheres + "\n";
}

/// What is said of a scene before anything runs; empty if it is taken.
std::string refusal_of(const std::string& scene) {
  try {
    plan_of(scene);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_scene);
    return error.what();
  }
  return "";
}

Packing certified(const Plan& plan, Monitor monitor = {}) {
  Packing packing = run(plan, {.seed = {}, .threads = 1, .monitor = std::move(monitor)});
  const Certificate certificate = certify(packing.spheres, packing.domain, {.arithmetic = Arithmetic::exact});
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  return packing;
}

/// Random insertion alone stops at its own packing fraction, after the first of several.
void expect_all(const std::string& scene, std::size_t count) {
  for (const std::string& protocol : protocols) {
    if (count > 1 && protocol.find("insert") != std::string::npos) continue;
    SCOPED_TRACE(scene + protocol);
    const Packing packing = certified(plan_of(scene + protocol));
    EXPECT_EQ(packing.spheres.size(), count) << packing.reason;
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  }
}

TEST(ExactFit, OfASphereInItsBoundingCube) {
  expect_all(in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]", "count = 1\nradius = 0.5"), 1);
  // 0.1 + 1 is no double: its centre is the one double between the walls.
  expect_all(in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]\ncorner = [0.1, 0.2, -0.3]",
                "count = 1\nradius = 0.4999999999999999"),
             1);
  expect_all(in("kind = \"cylinder\"\nradius = 0.5\nheight = 1.0", "count = 1\nradius = 0.5"), 1);
  expect_all(in("kind = \"sphere\"\nradius = 0.5\ncenter = [1.0, 2.0, 3.0]", "count = 1\nradius = 0.5"), 1);
}

TEST(ExactFit, OfASphereInAMesh) {
  const auto cube = [](const std::string& radius) {
    return in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]", "count = 1\nradius = " + radius);
  };
  const double edge = 1, inradius = edge / std::sqrt(24.0);
  // The regular tetrahedron of edge 1 between corners of a cube.
  const double a = edge / std::sqrt(2.0);
  const Mesh tetrahedron{{{0, 0, 0}, {a, a, 0}, {a, 0, a}, {0, a, a}},
                         {{{0, 1, 2}}, {{0, 3, 1}}, {{0, 2, 3}}, {{1, 3, 2}}}};
  ASSERT_GT(volume_of(Domain(tetrahedron)), 0);
  for (const std::string& protocol : protocols) {
    SCOPED_TRACE(protocol);
    EXPECT_EQ(certified(plan_of(cube("0.5") + protocol, test::box_mesh({0, 0, 0}, {1, 1, 1}))).spheres.size(),
              1u);
    const std::string within = fmt::format("{:.17g}", inradius * (1 - 1e-12));
    EXPECT_EQ(certified(plan_of(cube(within) + protocol, tetrahedron)).spheres.size(), 1u);
  }
}

TEST(ExactFit, OfTwoSpheresInATube) {
  expect_all(in("kind = \"cylinder\"\nradius = 0.5000005\nheight = 2.000001", "count = 2\nradius = 0.5"), 2);
  expect_all(in("kind = \"cylinder\"\nradius = 0.5\nheight = 2.000001", "count = 2\nradius = 0.5"), 2);
  expect_all(in("kind = \"box\"\nsize = [1.0, 3.000001, 1.0]", "count = 3\nradius = 0.5"), 3);
}

TEST(ExactFit, OfAColumnAndASlab) {
  for (const char* width : {"0.5", "0.5000005"}) {
    for (const std::string& protocol : {std::string(), stages({"relax"}), stages({"grow"})}) {
      SCOPED_TRACE(width + protocol);
      const Packing packing = certified(
          plan_of(in(fmt::format("kind = \"cylinder\"\nradius = {}\nheight = 10.0\nperiodic = true", width),
                     "count = 9\nradius = 0.5") +
                  protocol));
      EXPECT_EQ(packing.spheres.size(), 9u) << packing.reason;
    }
  }
  for (const char* thickness : {"1.0", "1.0000005"}) {
    for (const std::string& protocol : protocols) {
      SCOPED_TRACE(thickness + protocol);
      const Packing packing = certified(
          plan_of(in(fmt::format("kind = \"periodic\"\nsize = [10.0, 10.0, {}]\nwalls = [2]", thickness),
                     "count = 50\nradius = 0.5") +
                  protocol));
      EXPECT_EQ(packing.spheres.size(), 50u) << packing.reason;
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      EXPECT_EQ(std::get<Box>(packing.domain).size[2], std::stod(thickness));
    }
  }
}

TEST(HonestEnd, OfNoSphereIsNeverConverged) {
  for (const std::string& protocol : protocols) {
    SCOPED_TRACE(protocol);
    // No double is the centre of a sphere as wide as this tilted tube.
    const Plan plan = plan_of(in("kind = \"cylinder\"\nradius = 0.5\nheight = 1.0\naxis = [1.0, 2.0, 3.0]",
                                 "fill = true\nradius = 0.5") +
                              protocol);
    const Packing packing = certified(plan);
    EXPECT_EQ(packing.outcome == Outcome::converged, !packing.spheres.empty()) << packing.reason;
  }
}

TEST(HonestEnd, OfATailWithoutEndInADisc) {
  const std::string disc = in("kind = \"cylinder\"\nradius = 5.0\nheight = 3.0",
                              "diameter = { distribution = \"lognormal\", median = 1.0, sigma = 0.5 }");
  for (const std::string& protocol : {std::string(), stages({"insert", "compress", "shake", "refill"})}) {
    SCOPED_TRACE(protocol);
    const Plan plan = plan_of(disc + protocol);
    const Packing packing = certified(plan);
    EXPECT_GT(packing.spheres.size(), 80u) << packing.reason;
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.7 * plan.expected_packing_fraction);
  }
}

TEST(HonestEnd, FarFromWhatWasExpectedIsNotConverged) {
  // Ten trials a sphere leave most of them out.
  const Packing packing =
      certified(plan_of(in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]", "fill = true\nradius = 0.06") +
                        stages({"insert"}) + "attempts = 1\n" + stages({"compress"})));
  EXPECT_EQ(packing.outcome, Outcome::full) << packing.reason;
  EXPECT_NE(packing.reason.find("was expected"), std::string::npos) << packing.reason;
}

TEST(HonestEnd, RefusesSizesThatFitNowhere) {
  // A regular tetrahedron, whose bounds and volume would take a larger sphere.
  const testing::Folder folder;
  const std::string file = (folder.path() / "tetrahedron.off").string();
  std::ofstream(file) << "OFF\n4 4 0\n0 0 0\n1 1 0\n1 0 1\n0 1 1\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n";
  const std::string container = fmt::format("kind = \"mesh\"\nfile = \"{}\"", file);
  const std::string error = refusal_of("unit = \"mm\"\n" + in(container, "count = 1\nradius = 0.35"));
  EXPECT_NE(error.find("takes radii up to 0.288675"), std::string::npos) << error;
  EXPECT_NE(refusal_of(in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
                          "diameter = { distribution = \"lognormal\", median = 2.0, sigma = 0.1 }"))
                .find("does not fit"),
            std::string::npos);
}

TEST(HonestEnd, RefusesNumbersBeyondMemoryBeforeAnythingIsDrawn) {
  const std::string cube = "kind = \"box\"\nsize = [1000.0, 1000.0, 1000.0]";
  EXPECT_NE(refusal_of(in(cube, "radius = 0.001")).find("2^31"), std::string::npos);
  const std::string memory = refusal_of(in(cube, "radius = 0.5"));
  EXPECT_NE(memory.find("GB"), std::string::npos) << memory;
  EXPECT_NE(memory.find("check the units"), std::string::npos) << memory;
}

TEST(HonestEnd, NamesSizesThatReachDownWithoutLimit) {
  const std::string error =
      refusal_of(in("kind = \"box\"\nsize = [1.0, 1.0, 1.0]",
                    "diameter = { distribution = \"lognormal\", median = 1e-3, sigma = 3.0 }"));
  EXPECT_NE(error.find("without limit"), std::string::npos) << error;
  EXPECT_NE(error.find("\"min\""), std::string::npos) << error;
}

TEST(FarPlace, PacksAsTheOriginOrIsRefused) {
  for (const std::string& protocol : protocols) {
    SCOPED_TRACE(protocol);
    const auto at = [&](const char* x) {
      return run(plan_of(in(fmt::format("kind = \"box\"\ncorner = [{}, 0.0, 0.0]\nsize = [2.0, 2.0, 2.0]", x),
                            "radius = 0.2") +
                         protocol),
                 {.seed = {}, .threads = 1, .monitor = {}});
    };
    const Packing here = at("0.0"), far = at("1e9");
    EXPECT_EQ(here.outcome, far.outcome) << far.reason;
    EXPECT_GE(far.spheres.size() + 3, here.spheres.size()) << far.reason;
    EXPECT_TRUE(certify(far.spheres, far.domain).certified);
  }
  EXPECT_NE(
      refusal_of(in("kind = \"box\"\ncorner = [1e9, 0.0, 0.0]\nsize = [2.0, 2.0, 2.0]", "radius = 0.02"))
          .find("far from the origin"),
      std::string::npos);
}

TEST(FarPlace, HoldsForAColumn) {
  const auto at = [](const char* x) {
    return certified(plan_of(
        in(fmt::format(
               "kind = \"cylinder\"\nradius = 1.0\nheight = 10.0\nbase = [{}, 0.0, 0.0]\nperiodic = true", x),
           "radius = 0.2")));
  };
  const Packing here = at("0.0"), far = at("3e8");
  EXPECT_EQ(far.outcome, Outcome::converged) << far.reason;
  EXPECT_GE(far.packing_fraction(), here.packing_fraction() - 0.01);
}

const std::string slab = "kind = \"periodic\"\nsize = [2.0, 2.0, 2.0]\nwalls = [2]";

TEST(BedAndBox, FlightKnowsItsTargetAfterABed) {
  const Packing packing =
      certified(plan_of(in(slab, "radius = 0.1\npacking_fraction = 0.4") + stages({"insert", "fly"})));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(packing.reason.find("0.000"), std::string::npos) << packing.reason;
}

TEST(BedAndBox, WhatABedHeldOutlivesAStageThatIsStopped) {
  for (const char* stage : {"fly", "grow"}) {
    SCOPED_TRACE(stage);
    bool left_bed = false;
    Monitor monitor;
    monitor.on_progress = [&](const Progress& progress) {
      left_bed = left_bed || progress.activity != "insert";
    };
    monitor.cancelled = [&] { return left_bed; };
    const std::string scene = in(slab, "radius = 0.2\npacking_fraction = 0.5");
    const std::size_t in_bed = certified(plan_of(scene + stages({"insert"}))).spheres.size();
    const Packing packing = certified(plan_of(scene + stages({"insert", stage})), monitor);
    ASSERT_EQ(packing.outcome, Outcome::cancelled) << packing.reason;
    EXPECT_GE(packing.spheres.size(), in_bed) << packing.reason;
  }
}

TEST(BedAndBox, GrowthOfWhatNobodyCountedIsNoLimit) {
  for (const char* first : {"relax", "insert"}) {
    const Packing packing = certified(plan_of(in(slab, "radius = 0.2") + stages({first, "grow"})));
    EXPECT_EQ(packing.outcome, Outcome::converged) << first << ": " << packing.reason;
    EXPECT_GT(packing.packing_fraction(), 0.4);
  }
}

TEST(BedAndBox, RefuseAWrongDirectionBeforeAnythingRuns) {
  for (const char* stage : {"compress", "shake", "refill"})
    EXPECT_NE(
        refusal_of(in(slab, "radius = 0.2") + stages({"insert", stage}) + "direction = [1.0, 0.0, 0.0]\n")
            .find("fall for ever"),
        std::string::npos)
        << stage;
}

TEST(BedAndBox, PredictKnowsTheWallsOfABoxThatFollows) {
  const Packing packing =
      certified(plan_of(in("kind = \"periodic\"\nwalls = [2]\n",
                           "count = 300\nradius = 0.5\npacking_fraction = \"predicted\"") +
                        stages({"relax"})));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
}

TEST(BedAndBox, OverlapIsHonouredByFlightOrRefused) {
  const std::string scene =
      in("kind = \"periodic\"\nsize = [2.0, 2.0, 2.0]", "radius = 0.2\npacking_fraction = 0.3") +
      "[accuracy]\noverlap = 0.01\n" + stages({"fly"});
  EXPECT_EQ(certify(run(plan_of(scene)).spheres, plan_of(scene).domain, {.allowed_overlap = 0.01}).certified,
            true);
  for (const char* method : {"flight", "patent"})
    EXPECT_NE(refusal_of(scene + "method = \"" + method + "\"\n").find("without effect"), std::string::npos);
}

}  // namespace ends_test
}  // namespace bernal

#pragma once
#include <functional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/meshes.hpp"
#include "support/plans.hpp"

namespace bernal::testing {

struct SceneUnderTest {
  std::string name;
  std::function<Plan()> plan;

  friend void PrintTo(const SceneUnderTest& tested, std::ostream* out) { *out << tested.name; }
};

inline const std::string box = "[container]\nkind = \"box\"\nsize = [1.0, 1.0, 1.0]\n";

/// Short relaxations of few spheres: laws do not ask for density.
inline const std::string relax = "[[stage]]\ndo = \"relax\"\nalpha = 1\n";
inline const std::string unequal_edges =
    "[container]\nkind = \"periodic\"\nsize = [2.0, 1.0, 0.7]\nscalable = true\n"
    "[spheres]\ncount = 100\nradius = 0.3\n" +
    relax;

/// Those that are made here.
inline std::vector<SceneUnderTest> own_scenes() {
  std::vector<SceneUnderTest> scenes;
  const auto add = [&](std::string name, const std::string& toml) {
    scenes.push_back({std::move(name), [toml] { return plan_of(toml); }});
  };
  add("ObliqueCylinderFarAway",
      "[container]\nkind = \"cylinder\"\nradius = 2.0\nheight = 5.0\naxis = [1.0, 2.0, 3.0]\n"
      "base = [3000.0, -2000.0, 5000.0]\n[spheres]\nfill = true\nradius = 0.3\n");
  add("ACylinderAroundAPipe",
      "[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 2.0\nobstacles = [{ kind = \"cylinder\", "
      "radius = 0.3, height = 3.0, axis = [1.0, 0.5, 0.0], base = [-1.5, -0.7, 1.0] }]\n"
      "[spheres]\ncount = 60\nradius = 0.12\n");
  add("ABoxWithRoundedEdges",
      "[container]\nkind = \"box\"\nsize = [1.0, 1.2, 0.8]\nrounding = 0.25\n"
      "[spheres]\nfill = true\nradius = { distribution = \"uniform\", min = 0.06, max = 0.09 }\n");
  add("Sphere",
      "[container]\nkind = \"sphere\"\nradius = 1.0\n[spheres]\nfill = true\n"
      "radius = { distribution = \"uniform\", min = 0.1, max = 0.2 }\n");
  add("LognormalInABox", box +
                             "[spheres]\nfill = true\n"
                             "radius = { distribution = \"lognormal\", median = 0.06, sigma = 0.4 }\n");
  add("UphillInABox", box +
                          "[spheres]\npacking_fraction = 0.4\nradius = 0.07\n[[stage]]\ndo = \"insert\"\n"
                          "[[stage]]\ndo = \"compress\"\ndirection = [1.0, 1.0, 3.0]\n"
                          "[[stage]]\ndo = \"refill\"\ndirection = [1.0, 1.0, 3.0]\n");
  add("SettledInAnObliqueCylinder",
      "[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 2.0\naxis = [1.0, 2.0, 3.0]\n"
      "[spheres]\ncount = 80\nradius = { distribution = \"uniform\", min = 0.12, max = 0.2 }\n"
      "[[stage]]\ndo = \"settle\"\n");
  add("ExchangedInABox",
      box +
          "[spheres]\nfill = true\n"
          "radius = { distribution = \"lognormal\", median = 0.09, sigma = 0.3, max = 0.2 }\n"
          "[[stage]]\ndo = \"relax\"\nexchange = true\n");
  const std::string periodic = "[container]\nkind = \"periodic\"\n";
  add("Exchanged", periodic +
                       "[spheres]\ncount = 100\n"
                       "radius = { distribution = \"lognormal\", median = 1.0, sigma = 0.3 }\n"
                       "[[stage]]\ndo = \"relax\"\nalpha = 1\nexchange = true\n");
  add("PeriodicBox", periodic +
                         "[spheres]\ncount = 120\n"
                         "radius = { distribution = \"lognormal\", median = 1.0, sigma = 0.3 }\n" +
                         relax);
  add("PeriodicPlane", periodic +
                           "dimension = 2\n[spheres]\ncount = 150\n"
                           "radius = { distribution = \"uniform\", min = 1.0, max = 2.0 }\n" +
                           relax);
  add("PeriodicUnequalEdges", unequal_edges);
  add("PeriodicSlabOfTwoDiameters", periodic +
                                        "size = [1.7, 9.0, 8.0]\nscalable = true\n[spheres]\ncount = 120\n"
                                        "diameter = { distribution = \"uniform\", min = 0.8, max = 1.0 }\n" +
                                        relax);
  add("PeriodicBoxOfGivenSize",
      periodic + "size = [1.0, 1.2, 0.9]\n[spheres]\npacking_fraction = 0.55\nradius = 0.09\n" + relax);
  add("TiltedBox", periodic +
                       "size = [1.0, 1.2, 0.9]\ntilt = [0.5, -0.3, 0.4]\nscalable = true\n[spheres]\n"
                       "count = 120\nradius = { distribution = \"uniform\", min = 0.8, max = 1.2 }\n" +
                       relax);
  add("TiltedBoxOfGivenSizeWithGaps",
      periodic +
          "size = [1.0, 1.2, 0.9]\ntilt = [1.4, 0.2, -0.5]\n[spheres]\npacking_fraction = 0.5\n"
          "radius = 0.09\ngap = 0.005\n" +
          relax);
  add("ExchangedInATiltedBox",
      periodic +
          "size = [1.0, 1.2, 0.9]\ntilt = [0.5, -0.3, 0.4]\nscalable = true\n[spheres]\ncount = 100\n"
          "radius = { distribution = \"lognormal\", median = 1.0, sigma = 0.3 }\n"
          "[[stage]]\ndo = \"relax\"\nalpha = 1\nexchange = true\n");
  const std::string fly = "[[stage]]\ndo = \"fly\"\n";
  add("FlightBetweenWalls", periodic +
                                "size = [1.0, 1.2, 0.9]\nwalls = [1]\n[spheres]\npacking_fraction = 0.3\n"
                                "radius = { distribution = \"uniform\", min = 0.05, max = 0.07 }\n" +
                                fly + "method = \"flight\"\n");
  add("PatentInThePlane",
      periodic + "dimension = 2\nedge = 1.0\n[spheres]\npacking_fraction = 0.5\nradius = 0.03\n" + fly +
          "method = \"patent\"\n");
  add("FlightThenRelaxation",
      periodic + "edge = 1.0\n[spheres]\npacking_fraction = 0.4\nradius = 0.08\n" + fly + relax);
  const std::string grow = "[[stage]]\ndo = \"grow\"\nrate = 0.1\npressure = 1e4\n";
  add("GrowthInABox", box +
                          "[spheres]\n"
                          "radius = { distribution = \"lognormal\", median = 0.06, sigma = 0.3 }\n" +
                          grow);
  add("GrowthInASphere",
      "[container]\nkind = \"sphere\"\nradius = 1.0\n[spheres]\nfill = true\nradius = 0.12\n" + grow);
  add("GrowthBetweenTwoWalls", periodic +
                                   "size = [1.0, 1.2, 0.9]\nwalls = [1]\n[spheres]\npacking_fraction = 0.5\n"
                                   "radius = { distribution = \"uniform\", min = 0.06, max = 0.08 }\n" +
                                   grow);
  scenes.push_back({"GrowthInAPrism", [=] {
                      return plan_of(box + "[spheres]\npacking_fraction = 0.5\nradius = 0.12\n" + grow,
                                     test::prism_mesh(8, 1, 2));
                    }});
  const std::string column =
      "[container]\nkind = \"cylinder\"\nradius = 1.0\nheight = 2.5\nperiodic = true\n";
  const std::string sideways = "direction = [1.0, -0.5, 0.0]\n";
  const std::string settle = "[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"compress\"\n" + sideways +
                             "[[stage]]\ndo = \"shake\"\n" + sideways + "[[stage]]\ndo = \"refill\"\n" +
                             sideways;
  add("RelaxationInAColumn",
      column + "[spheres]\nradius = { distribution = \"uniform\", min = 0.1, max = 0.2 }\n");
  add("SettlingInAColumn", column + "[spheres]\nfill = true\nradius = 0.15\n" + settle);
  add("GrowthInAColumn", column + "[spheres]\nradius = 0.15\n" + grow);
  const auto add_in = [&](std::string name, const Domain& domain, const std::string& toml) {
    scenes.push_back({std::move(name), [=] { return plan_of(box + toml, domain); }});
  };
  const Box slab{{0.5, -1, 2}, {1.1, 1, 0.8}, {true, true, false}};
  const Box channel{{0.5, -1, 2}, {1.1, 1, 0.8}, {false, false, true}};
  add_in("RelaxationInASlab", slab, "[spheres]\nradius = 0.08\n");
  add_in("SettlingInASlab", slab,
         "[spheres]\nfill = true\nradius = 0.08\n[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"refill\"\n");
  add_in("SettlingInAChannel", channel, "[spheres]\nfill = true\nradius = 0.08\n" + settle);
  add_in("GrowthInAChannel", channel, "[spheres]\nradius = 0.08\n" + grow);
  add_in("RelaxationBetweenNoWalls", Box{{3, 0, 0}, {1, 1, 1}, {true, true, true}},
         "[spheres]\nradius = 0.09\n[[stage]]\ndo = \"insert\"\n[[stage]]\ndo = \"relax\"\n");
  add("GapsInAnObliqueCylinder",
      "[container]\nkind = \"cylinder\"\nradius = 2.0\nheight = 5.0\naxis = [1.0, 2.0, 3.0]\n"
      "[spheres]\nradius = { distribution = \"uniform\", min = 0.2, max = 0.3 }\ngap = 0.03\n");
  add("GapsBetweenTwoWalls", periodic +
                                 "size = [1.0, 1.2, 0.9]\nwalls = [1]\n[spheres]\npacking_fraction = 0.35\n"
                                 "radius = 0.06\ngap = 0.01\nwall_gap = 0.02\n" +
                                 grow);
  scenes.push_back({"GapsInAnLShape", [] {
                      return plan_of(box + "[spheres]\ncount = 200\nradius = 0.09\ngap = 0.01\n",
                                     test::l_shape_mesh());
                    }});
  scenes.push_back({"LShapeMesh", [] {
                      return plan_of("unit = \"m\"\n" + box + "[spheres]\nfill = true\nradius = 0.1\n",
                                     test::translated(test::l_shape_mesh(), {0, 0, -7}));
                    }});
  return scenes;
}

inline Packing run_with(const Plan& plan, int threads = 1) {
  RunOptions options;
  options.threads = threads;
  return run(plan, options);
}

inline void expect_certified(const Packing& packing) {
  CertifyOptions options{.gap = packing.scene.gap, .wall_gap = packing.scene.wall_gap};
  const Certificate filtered = certify(packing.spheres, packing.domain, options);
  options.arithmetic = Arithmetic::exact;
  const Certificate exact = certify(packing.spheres, packing.domain, options);
  EXPECT_TRUE(filtered.certified) << filtered.statement;
  EXPECT_TRUE(exact.certified) << exact.statement;
  EXPECT_EQ(filtered.pairs_tested, exact.pairs_tested);
}

}  // namespace bernal::testing

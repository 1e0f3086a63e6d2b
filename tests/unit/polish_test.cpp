#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/tolerance.hpp"
#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/verify/certificate.hpp"
#include "jam/polish.hpp"
#include "support/measured.hpp"
#include "support/plans.hpp"

// What a polish promises: contacts that are closed to its tolerance, and no more of them than hold the
// packing.
namespace bernal {
namespace polish_test {

Packing polished(int dimension, int count, const std::string& radius) {
  RunOptions options;
  options.threads = 1;
  return run(testing::plan_of("[container]\nkind = \"periodic\"\ndimension = " + std::to_string(dimension) +
                              "\n[spheres]\ncount = " + std::to_string(count) + "\nradius = " + radius +
                              "\n[[stage]]\ndo = \"relax\"\nalpha = 3.0\npolish = 1e-10\n"),
             options);
}

void expect_isostatic(const Packing& packing) {
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  const Contacts contacts = measure_contacts(packing, 1e-9);
  const int dimension = packing.spheres.dimension();
  const double held = static_cast<double>(packing.spheres.size() - contacts.rattlers);
  const double isostatic = dimension * (held - 1) + 1;
  EXPECT_NEAR(static_cast<double>(contacts.backbone_pairs), isostatic, 0.01 * isostatic + 1);
}

TEST(Polish, LeavesEqualSpheresIsostatic) { expect_isostatic(polished(3, 300, "1.0")); }

TEST(Polish, LeavesMixedSpheresIsostatic) {
  expect_isostatic(polished(3, 200, "{ distribution = \"lognormal\", median = 1.0, sigma = 0.3 }"));
}

TEST(Polish, LeavesMixedDiscsIsostatic) {
  expect_isostatic(polished(2, 150, "{ distribution = \"classes\", values = [1.0, 1.4], shares = [1, 1] }"));
}

TEST(Polish, CostsHardlyAnyPackingFraction) {
  const double with = polished(3, 300, "1.0").packing_fraction();
  EXPECT_GT(with, 0.62);
  EXPECT_LT(with, 0.66);
}

/// What is called converged is held by as many contacts as it takes, as they are measured from the result;
/// and what is not says what is open.
TEST(Polish, IsConvergedOnlyIfAsManyContactsAreClosedAsHoldTheSpheres) {
  const std::string wide = "{ distribution = \"uniform\", min = 0.5, max = 1.5 }";
  const std::string periodic = "kind = \"periodic\"\n", plane = periodic + "dimension = 2\n";
  const std::pair<std::string, std::string> cases[] = {
      {periodic, "count = 4\nradius = 1"},
      {periodic, "count = 20\nradius = 1"},
      {periodic, "count = 60\nradius = " + wide},
      {plane, "count = 60\nradius = " + wide},
      {plane, "count = 30\nradius = 1"},
      {periodic + "dimension = 4\n", "count = 40\nradius = 1"},
      {periodic + "walls = [2]\n", "count = 60\nradius = " + wide}};
  for (const auto& [container, spheres] : cases)
    for (const double asked : {1e-10, 1e-15}) {
      const Packing packing = run(
          testing::plan_of("[container]\n" + container + "[spheres]\n" + spheres +
                           fmt::format("\n[[stage]]\ndo = \"relax\"\nalpha = 2\npolish = {:g}\n", asked)));
      const double rounding = tolerance::growth(bounds_of<dynamic>(packing.domain).size().maxCoeff() /
                                                std::ranges::min(packing.spheres.r));
      const Contacts contacts = measure_contacts(packing, asked + 3 * rounding);
      const bool is_held = contacts.isostatic && contacts.backbone_contacts() >= *contacts.isostatic;
      const std::string what = container + spheres + fmt::format(" {:g}: ", asked) + packing.reason;
      EXPECT_TRUE(is_held || packing.outcome == Outcome::hit_limit) << what;
      if (packing.outcome != Outcome::converged) {
        EXPECT_TRUE(packing.reason.find("not polished to the end") != std::string::npos ||
                    packing.reason.find("could not be closed") != std::string::npos)
            << what;
      }
      EXPECT_TRUE(certify(packing.spheres, packing.domain).certified) << what;
    }
}

TEST(Polish, IsNotConvergedInABoxThatOpensTheContactsAgain) {
  for (const char* fraction : {"0.2", "0.6"}) {
    const Packing packing = run(testing::plan_of(std::string("[container]\nkind = \"periodic\"\n[spheres]\n"
                                                             "count = 60\nradius = 1\npacking_fraction = ") +
                                                 fraction + "\n[[stage]]\ndo = \"relax\"\npolish = 1e-8\n"));
    EXPECT_EQ(packing.outcome, Outcome::hit_limit) << packing.reason;
    EXPECT_NE(packing.reason.find("larger than the spheres need"), std::string::npos) << packing.reason;
    EXPECT_EQ(packing.spheres.size(), 60u);
  }
}

// ---- when it ends early

StageEnd end_of_polish(int count, double tolerance, const Monitor& monitor) {
  const Packing packing =
      run(testing::plan_of("[container]\nkind = \"periodic\"\n[spheres]\ncount = " + std::to_string(count) +
                           "\nradius = 1.0\n[[stage]]\ndo = \"relax\"\nalpha = 3.0\n"),
          {.seed = {}, .threads = 1, .monitor = {}});
  Spheres<3> spheres = packing.spheres.in<3>();
  Vector<3> edges = std::get<Box>(packing.domain).size;
  EffectLog effects;
  Reporter report{.seed = 1, .monitor = monitor, .effects = effects};
  const Task task;
  return polish<3>(spheres, edges, tolerance, SpheresInBox{.task = task, .edges = edges}, report);
}

TEST(Polish, EndsSoonWhenCancelled) {
  for (const int answer : {1, 2, 100, 500}) {
    int asked = 0;
    const Monitor monitor{.on_progress = {}, .cancelled = [&] { return ++asked >= answer; }};
    EXPECT_EQ(end_of_polish(200, 1e-10, monitor), StageEnd::cancelled);
    EXPECT_LE(asked, answer + 10);
  }
}

TEST(Polish, SaysThatRoundingAllowsNoBetter) {
  EXPECT_EQ(end_of_polish(40, 1e-18, Monitor{}), StageEnd::hit_limit);
}

}  // namespace polish_test
}  // namespace bernal

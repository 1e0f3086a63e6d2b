#include <gtest/gtest.h>

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

// ---- when it ends early

StageEnd end_of_polish(int count, double tolerance, const Monitor& monitor) {
  const Packing packing =
      run(testing::plan_of("[container]\nkind = \"periodic\"\n[spheres]\ncount = " + std::to_string(count) +
                           "\nradius = 1.0\n[[stage]]\ndo = \"relax\"\nalpha = 3.0\n"),
          {.seed = {}, .threads = 1, .monitor = {}});
  Spheres<3> spheres = packing.spheres.in<3>();
  Vector<3> edges = std::get<Box>(packing.domain).size;
  EffectLog effects;
  Work work{
      .spheres = Spheres<dynamic>(3), .edges = edges, .seed = 1, .monitor = monitor, .effects = effects};
  return polish<3>(spheres, edges, tolerance, work);
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

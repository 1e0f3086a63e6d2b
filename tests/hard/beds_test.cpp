#include <gtest/gtest.h>

#include <string>

#include "bernal/measure/hanging.hpp"
#include "bernal/settle/compress.hpp"
#include "support/plain_check.hpp"
#include "support/plans.hpp"

// Beds are "converged" only where no sphere hangs; of any other it is said how many do, and how far one could
// fall.
namespace bernal {
namespace beds_test {

std::string stage(const std::string& name, const std::string& keys = "") {
  return "[[stage]]\ndo = \"" + name + "\"\n" + keys;
}

const std::string empty_box =
    "unit = \"mm\"\n[container]\nkind = \"box\"\nsize = [20, 20, 60]\n[spheres]\ncount = 400\ndiameter = "
    "2.0\n";
const std::string tall_box = empty_box + stage("insert");

Packing packed(const std::string& scene) { return run(testing::plan_of(scene)); }

std::uint64_t hanging(const Packing& packing) {
  return measure_hanging(packing.spheres, packing.domain, {0, 0, -1}).spheres;
}

TEST(Beds, ByEnergyMayHangAndSaySo) {
  const std::string loosely = "tolerance = 0.01\n";
  const Packing packing = packed(empty_box + stage("insert", "packing_fraction = 0.068\n") +
                                 stage("compress", loosely) + stage("refill", loosely));
  const std::uint64_t hang = hanging(packing);
  ASSERT_GT(hang, 1u);
  EXPECT_EQ(packing.outcome, Outcome::hit_limit) << packing.reason;
  EXPECT_NE(packing.reason.find("; " + std::to_string(hang) + " spheres hang, and the farthest could fall"),
            std::string::npos)
      << packing.reason;
  EXPECT_NE(packing.reason.find("\"tolerance\""), std::string::npos) << packing.reason;
}

TEST(Beds, ByRestDoNotHang) {
  for (const std::string& stages :
       {stage("compress"), stage("compress") + stage("refill"), stage("compress", "tilt = 0\n"),
        stage("compress") + stage("shake"), stage("compress", "rest = 0.9\n")}) {
    const Packing packing = packed(tall_box + stages);
    EXPECT_EQ(packing.outcome, Outcome::converged) << stages << packing.reason;
    EXPECT_EQ(hanging(packing), 0u) << stages;
  }
}

TEST(Beds, OfFewIterationsSayHowManyHang) {
  const Packing packing = packed(tall_box + stage("compress", "max_iterations = 3\n"));
  EXPECT_EQ(packing.outcome, Outcome::hit_limit) << packing.reason;
  EXPECT_NE(packing.reason.find(std::to_string(hanging(packing)) + " spheres hang"), std::string::npos)
      << packing.reason;
  EXPECT_NE(packing.reason.find("\"max_iterations\""), std::string::npos) << packing.reason;
}

/// Whose places the compression, which its limit ends, has changed far since its lists were built.
TEST(Beds, TakeMoreSpheresWhereACompressionWasCutShort) {
  for (const char* size : {"[1.5, 8]", "[3, 3, 20]", "[4, 4, 12]"})
    for (const std::string& cut :
         {stage("compress", "max_iterations = 3\n"), stage("shake", "max_iterations = 1\n")}) {
      const std::string box = std::string("seed = 2\n[container]\nkind = \"box\"\nsize = ") + size;
      const Packing packing =
          packed(box + "\n[spheres]\ndiameter = 1.0\n" + stage("insert", "packing_fraction = 0.15\n") + cut +
                 stage("insert", "packing_fraction = 0.5\n"));
      EXPECT_EQ(testing::plain_objection(packing.spheres, packing.domain, 0), "") << size << cut;
    }
}

TEST(Beds, AreJudgedByTheStageThatMovedThemLast) {
  const std::string loosely = stage("compress", "tolerance = 0.3\n");
  // Nothing is left to insert, so that the bed is as it was pressed.
  EXPECT_EQ(packed(tall_box + loosely + stage("insert")).outcome, Outcome::hit_limit);
  // Relaxation that places the rest moves all.
  const Packing relaxed =
      packed(empty_box + stage("insert", "packing_fraction = 0.06\n") + loosely + stage("relax"));
  EXPECT_EQ(relaxed.outcome, Outcome::converged) << relaxed.reason;
  EXPECT_EQ(packed(tall_box + loosely + stage("shake")).outcome, Outcome::converged);
}

TEST(Beds, ColumnsDoNotHang) {
  const Packing packing = packed(
      "[container]\nkind = \"cylinder\"\nradius = 2.0\nheight = 40.0\n[spheres]\nfill = true\ndiameter = "
      "1.0\n" +
      stage("insert") + stage("compress") + stage("shake") + stage("refill"));
  EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
  EXPECT_EQ(hanging(packing), 0u);
  EXPECT_GT(packing.packing_fraction(), 0.50);
}

}  // namespace beds_test
}  // namespace bernal

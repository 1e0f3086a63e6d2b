#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/starts.hpp"

namespace bernal {
namespace start_test {

using namespace testing::starts;
using testing::error_of;

using Start = StartFixture;

TEST_F(Start, LeavesSpheresWhereTheyAreUntilAStageMovesThem) {
  folder.write("two.csv", two);
  for (const std::string name : {"insert", "relax", "grow"}) {
    const Packing packing = packed(box + from_two + stage(name));
    expect_certified(packing);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    ASSERT_EQ(packing.spheres.size(), 2u) << name;
    EXPECT_EQ(packing.spheres.center(0), Vector<3>(2, 2, 2)) << name;
    EXPECT_EQ(packing.spheres.center(1), Vector<3>(4, 4, 6)) << name;
    EXPECT_EQ(packing.spheres.r, (std::vector<double>{0.5, 1}));
  }
  const Packing fallen = packed(box + from_two + stage("compress", "tilt = 0\n"));
  expect_certified(fallen);
  EXPECT_NEAR(fallen.spheres.x[2][0], 0.5, 1e-6);
  EXPECT_NEAR(fallen.spheres.x[2][1], 1, 1e-6);
}

TEST_F(Start, ComesBeforeWhatIsDrawn) {
  folder.write("two.csv", two);
  for (const std::string name : {"insert", "relax", "grow"}) {
    const Packing packing = packed(box + from_two + "count = 40\nradius = 0.3\n" + stage(name));
    expect_certified(packing);
    ASSERT_EQ(packing.spheres.size(), 40u) << name << packing.reason;
    EXPECT_EQ(packing.spheres.r[0], 0.5);
    EXPECT_EQ(packing.spheres.r[1], 1);
    EXPECT_EQ(std::ranges::count(packing.spheres.r, 0.3), 38);
  }
  const Packing filled =
      packed(box + from_two + "fill = true\nradius = 0.4\n" + stage("insert", "packing_fraction = 0.2\n"));
  EXPECT_GE(filled.packing_fraction(), 0.2);
  EXPECT_EQ(filled.spheres.r[1], 1);
}

TEST_F(Start, IsInItsOwnUnit) {
  folder.write("two.csv", "x,y,z,d\n20,20,20,10\n40,40,60,20\n");
  const std::string scene = "unit = \"cm\"\n" + box + from_two + "start_unit = \"mm\"\n" + stage("insert");
  const Packing packing = packed(scene);
  EXPECT_NEAR(packing.spheres.x[0][0], 2, 1e-15);
  EXPECT_NEAR(packing.spheres.r[1], 1, 1e-15);
  folder.write("two.csv", "# unit: mm\nx,y,z,d\n20,20,20,10\n40,40,60,20\n");
  EXPECT_EQ(packed(scene).spheres, packing.spheres);
  folder.write("two.csv", "# unit: m\n" + two);
  EXPECT_NE(refusal(scene).find("says itself that it is in m"), std::string::npos);
}

TEST_F(Start, OverlappingIsForStagesThatPushApart) {
  folder.write("two.csv", "x,y,z,r\n2,2,2,1\n5,5,5,1\n3.5,2,2,1\n");
  for (const std::string name : {"insert", "compress", "shake", "refill", "grow"}) {
    const std::string said = refusal(box + from_two + stage(name));
    EXPECT_NE(said.find("two.csv:4"), std::string::npos) << said;
    EXPECT_NE(said.find("overlaps that of line 2 by a ratio of 0.25"), std::string::npos) << said;
    EXPECT_NE(said.find("\"relax\""), std::string::npos) << said;
  }
  const Packing freed = packed(box + from_two + stage("relax"));
  expect_certified(freed);
  EXPECT_EQ(freed.spheres.size(), 3u);
  EXPECT_LT((freed.spheres.center(0) - Vector<3>(2, 2, 2)).norm(), 1);  // pushed, not put elsewhere
}

TEST_F(Start, AcrossTheWallIsPushedInside) {
  folder.write("two.csv", "x,y,z,r\n2,2,0.5,1\n5,5,5,1\n");
  EXPECT_NE(
      refusal(box + from_two + stage("insert")).find("protrudes from the container by 0.5 of its radius"),
      std::string::npos);
  const Packing freed = packed(box + from_two + stage("relax"));
  expect_certified(freed);
  EXPECT_EQ(freed.spheres.size(), 2u);
  folder.write("two.csv", "x,y,z,r\n2,2,9,1\n");
  for (const std::string name : {"insert", "relax"})
    EXPECT_NE(refusal(box + from_two + stage(name)).find("two.csv:2: this sphere lies outside"),
              std::string::npos);
}

TEST_F(Start, ThatTouchesExactlyIsNoOverlapAtAWall) {
  folder.write("two.csv", "x,y,z,r\n1,1,1,1\n7,7,7,1\n");
  const Packing packing = packed(box + from_two + stage("insert"));
  expect_certified(packing);
  EXPECT_EQ(packing.spheres.center(0), Vector<3>(1, 1, 1));
}

TEST_F(Start, HasToGoWithTheScene) {
  folder.write("two.csv", two);
  const auto expect = [&](const std::string& toml, const std::string& says) {
    EXPECT_NE(refusal(toml).find(says), std::string::npos) << refusal(toml);
  };
  expect(box + from_two + "count = 3\n" + stage("insert"), "no sizes to draw others from");
  expect(box + from_two + "count = 1\nradius = 0.1\n" + stage("insert"), "the start has 2 spheres");
  expect(box + from_two + "fill = true\n", "no sizes to draw more spheres from");
  expect(box + from_two + "packing_fraction = 0.3\n", "no sizes to draw more spheres from");
  expect(box + "[spheres]\nstart = \"none.csv\"\n", "none.csv");
  expect(box + "[spheres]\nstart_unit = \"mm\"\nradius = 1.0\n", "needs the \"start\" itself");
  expect(box + from_two + "start_box = [1.0, 1.0, 1.0]\n", "is for periodic boxes");
  folder.write("line.csv", "x0,r\n1,0.5\n");
  expect(box + "[spheres]\nstart = \"line.csv\"\n", "have 1 dimension, but the scene has 3");
  folder.write("large.csv", "x,y,z,r\n1,1,1,5\n");
  expect(periodic(8) + "[spheres]\nstart = \"large.csv\"\n", "does not fit into the periodic box, which");
  expect(box + from_two + "start_sha256 = \"12\"\n", "64 hexadecimal digits");
  expect(box + from_two + "start_sha256 = \"" + std::string(64, '0') + "\"\n",
         "is not the file that is meant");
  expect("[container]\nkind = \"periodic\"\n" + from_two, "how large its periodic box is");
  expect("[container]\nkind = \"periodic\"\ndimension = 2\nedge = 8.0\n" + from_two, "have 3 dimensions");
  expect(periodic(8) + from_two + "start_box = [8.0, 8.0]\n", "a length for each of 3 dimensions");
  expect(box + "[spheres]\nradius = 1.0\nstart = 3\n", "must be the path of a file");
  folder.write("two.csv", "x,y,z,r\n");
  expect(box + from_two, "there are no spheres in it");
  folder.write("two.csv", "x,y,z,r\n4,4,4,5\n");
  expect(box + from_two, "does not fit into the box");
}

TEST_F(Start, OfOneSphereIsEnough) {
  folder.write("two.csv", "x,y,z,r\n4,4,4,1\n");
  for (const std::string name : {"insert", "relax", "grow", "compress", "shake", "refill"}) {
    const Packing packing = packed(box + from_two + stage(name));
    expect_certified(packing);
    EXPECT_EQ(packing.spheres.size(), 1u) << name;
  }
  const Packing alone = packed(periodic(8) + from_two + stage("relax"));
  expect_certified(alone);
  EXPECT_EQ(alone.spheres.center(0), Vector<3>(4, 4, 4));
}

/// What a jammed packing of another program looks like: a little overlap, and a little room.
TEST_F(Start, ThatIsJammedIsPolishedWhereItIs) {
  const Packing theirs = relaxed(3, 150, "radius = { distribution = \"uniform\", min = 0.8, max = 1.2 }\n");
  write("theirs.csv", theirs.spheres, 1 + 1e-4);
  const std::string from = "[spheres]\nstart = \"theirs.csv\"\n";
  const std::string follows = periodic_of(theirs, "scalable = true\n");
  const Packing freed = packed(follows + from + stage("relax"));
  expect_certified(freed);
  EXPECT_NEAR(freed.packing_fraction(), theirs.packing_fraction(), 1e-3 * theirs.packing_fraction());

  const Packing polished = packed(follows + from + stage("relax", "polish = 1e-8\n"));
  expect_certified(polished);
  EXPECT_EQ(polished.outcome, Outcome::converged) << polished.reason;
  const Contacts contacts = measure(polished.spheres, polished.domain, {}, {.contact_gap = 1e-6}).contacts;
  EXPECT_EQ(contacts.backbone_pairs, contacts.isostatic);
  EXPECT_GT(contacts.backbone, 130u);
  // Relative to the box, where another relaxation would have put them anywhere.
  const double edge = bounds_of<dynamic>(theirs.domain).size()[0];
  const double edge_now = bounds_of<dynamic>(polished.domain).size()[0];
  double farthest = 0;
  for (std::size_t i = 0; i < theirs.spheres.size(); ++i) {
    if (i >= polished.spheres.size()) break;
    Vector<3> moved = polished.spheres.center(i) / edge_now - theirs.spheres.center(i) / edge;
    for (double& x : moved) x -= std::round(x);
    farthest += edge * moved.norm() / static_cast<double>(theirs.spheres.size());
  }
  EXPECT_LT(farthest, 0.1);  // of the mean radius, rattlers among them
  // What is polished is not changed by doing it again.
  const Packing again = [&] {
    write("again.csv", polished.spheres);
    return packed(periodic_of(polished, "scalable = true\n") + "[spheres]\nstart = \"again.csv\"\n" +
                  stage("relax", "polish = 1e-8\n"));
  }();
  expect_certified(again);
  EXPECT_EQ(measure(again.spheres, again.domain, {}, {.contact_gap = 1e-6}).contacts.backbone_pairs,
            contacts.backbone_pairs);
  EXPECT_NEAR(again.packing_fraction(), polished.packing_fraction(), 1e-7);
}

TEST_F(Start, ThatIsLooseIsDensified) {
  const Packing gas =
      run(build(parse_scene(periodic(20) + "[spheres]\npacking_fraction = 0.2\nradius = 1.0\n" +
                                stage("fly", "method = \"flight\"\n"),
                            "test.toml")),
          {.threads = 1});
  write("gas.csv", gas.spheres);
  for (const std::string& act :
       {stage("relax", "alpha = 2\n"), stage("grow", "rate = 0.1\npressure = 1e4\n")}) {
    const Packing dense =
        packed(periodic_of(gas, "scalable = true\n") + "[spheres]\nstart = \"gas.csv\"\n" + act);
    expect_certified(dense);
    EXPECT_EQ(dense.spheres.size(), gas.spheres.size());
    EXPECT_GT(dense.packing_fraction(), 0.58);
  }
}

TEST_F(Start, InEveryDimensionWithEveryStageOfABox) {
  for (int dimension = 1; dimension <= max_dimension; ++dimension) {
    const Packing theirs = relaxed(dimension, dimension < 3 ? 40 : 200);
    write("theirs.csv", theirs.spheres);
    for (const std::string name : {"relax", "grow", "fly"}) {
      if (name == "grow" && (dimension == 1 || dimension > 4)) continue;  // from 5 on it needs a wider box
      const std::string follows = name == "fly" ? "" : "scalable = true\n";
      const Packing packing = packed(periodic_of(theirs, follows) + "[spheres]\nstart = \"theirs.csv\"\n" +
                                     stage(name, name == "grow" ? "rate = 0.1\npressure = 1e4\n" : ""));
      expect_certified(packing);
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      EXPECT_EQ(packing.spheres.size(), theirs.spheres.size());
      EXPECT_GT(packing.packing_fraction(), 0.999 * theirs.packing_fraction()) << name << dimension;
    }
  }
}

TEST_F(Start, InABoxFindsPlacesForOthersToo) {
  const Packing theirs = relaxed(3, 60);
  write("theirs.csv", theirs.spheres);
  const std::string scene = periodic_of(theirs, "scalable = true\n") +
                            "[spheres]\nstart = \"theirs.csv\"\ncount = 120\nradius = 0.5\n";
  for (const std::string& act :
       {stage("relax", "alpha = 2\n"), stage("grow", "rate = 0.1\npressure = 1e4\n")}) {
    const Packing packing = packed(scene + act);
    expect_certified(packing);
    ASSERT_EQ(packing.spheres.size(), 120u);
    EXPECT_EQ(packing.spheres.r[59], 1);
    EXPECT_EQ(packing.spheres.r[60], 0.5);
    EXPECT_GT(packing.packing_fraction(), 0.55);
  }
  const std::string given =
      periodic_of(theirs) + "[spheres]\nstart = \"theirs.csv\"\ncount = 120\nradius = 0.1\n";
  EXPECT_NE(refusal(given + stage("fly")).find("finds no places for 60 spheres among the 60"),
            std::string::npos);
}

TEST_F(Start, InABoxThatOverlapsIsForStagesThatFreeIt) {
  folder.write("two.csv", "x,y,z,r\n2,2,2,1\n5,5,5,1\n3.5,2,2,1\n");
  const std::string said = refusal(periodic(8) + from_two + stage("fly"));
  EXPECT_NE(said.find("two.csv:4"), std::string::npos) << said;
  EXPECT_NE(said.find("by a ratio of 0.25"), std::string::npos) << said;
  expect_certified(packed(periodic(8) + from_two + stage("relax")));
  const Packing theirs = relaxed(3, 60);
  write("over.csv", theirs.spheres, 1.05);
  const Packing grown =
      packed(periodic_of(theirs, "scalable = true\n") + "[spheres]\nstart = \"over.csv\"\n" +
             stage("grow", "rate = 0.1\npressure = 1e4\n"));
  expect_certified(grown);
  EXPECT_GT(grown.packing_fraction(), 0.58);
  folder.write("two.csv", "x,y,z,r\n2,2,2,0.5\n2,2,2,0.5\n5,5,5,0.5\n");
  EXPECT_NE(refusal(periodic(8) + from_two + stage("grow")).find("have the same place"), std::string::npos);
  expect_certified(packed(periodic(8) + from_two + stage("relax")));
}

TEST_F(Start, BetweenWallsOfABoxKeepsItsPlaces) {
  folder.write("two.csv", two);
  const std::string walled = "walls = [2]\n";
  for (const std::string name : {"insert", "relax", "grow", "fly"}) {
    const Packing packing = packed(periodic(8, walled) + from_two + stage(name));
    expect_certified(packing);
    // In a box that is scaled and scaled back a coordinate is rounded.
    EXPECT_LT((packing.spheres.center(1) - Vector<3>(4, 4, 6)).norm(), 1e-9) << name;
  }
  folder.write("two.csv", "x,y,z,r\n2,2,0.25,0.5\n");
  EXPECT_NE(refusal(periodic(8, walled) + from_two + stage("fly")).find("crosses a wall along axis 2"),
            std::string::npos);
  folder.write("two.csv", "x,y,z,r\n2,2,-0.25,0.5\n");
  EXPECT_NE(refusal(periodic(8, walled) + from_two + stage("fly")).find("does not lie between the walls"),
            std::string::npos);
  EXPECT_NE(refusal(periodic(8, walled) + from_two + "start_box = [9.0, 9.0, 9.0]\n" + stage("relax"))
                .find("the box of the start, 9 x 9 x 9 m, is not the container, 8 x 8 x 8"),
            std::string::npos);
}

/// In a box of given size what overlaps a little is freed there, what only touches stays as it is, and what
/// is loose is squeezed into a smaller one.
TEST_F(Start, InABoxOfGivenSizeStaysInIt) {
  folder.write("overlaps.csv", "x,y,z,r\n2,2,2,0.5\n2.9,2,2,0.5\n7,7,7,0.6\n");
  const std::string from = "[spheres]\nstart = \"overlaps.csv\"\n";
  const Packing freed = packed(periodic(10) + from + stage("relax"));
  expect_certified(freed);
  EXPECT_EQ(freed.outcome, Outcome::converged) << freed.reason;
  EXPECT_EQ(bounds_of<dynamic>(freed.domain).size(), Vector<3>::Constant(10));

  folder.write("touches.csv", "x,y,z,r\n2,2,2,0.5\n3,2,2,0.5\n9.5,2,2,2\n");
  const Packing same = packed(periodic(10) + "[spheres]\nstart = \"touches.csv\"\n" + stage("relax"));
  expect_certified(same);
  EXPECT_EQ(same.outcome, Outcome::converged) << same.reason;
  EXPECT_EQ(same.spheres.x[0], (std::vector<double>{2, 3, 9.5}));

  const Packing loose =
      run(build(parse_scene("[container]\nkind = \"periodic\"\n[spheres]\ncount = 200\nradius = "
                            "1.0\n[[stage]]\ndo = \"relax\"\nphi0 = 0.05\n",
                            "test.toml")),
          {.seed = {}, .threads = 1, .monitor = {}});
  write("loose.csv", loose.spheres);
  const Packing squeezed =
      packed(periodic_of(loose, "scalable = true\n") +
             "[spheres]\nstart = \"loose.csv\"\npacking_fraction = 0.4\n" + stage("relax"));
  expect_certified(squeezed);
  EXPECT_EQ(squeezed.outcome, Outcome::converged) << squeezed.reason;
  EXPECT_NEAR(squeezed.packing_fraction(), 0.4, 1e-9);
}

}  // namespace start_test
}  // namespace bernal

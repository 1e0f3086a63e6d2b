// Discs that push each other apart, or fly and grow, in containers of two dimensions: as dense as random
// close packing less what walls take, certified, and where that is asked for polished until as many contacts
// as just hold them are closed.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bernal/measure/measure.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/discs.hpp"
#include "support/folder.hpp"
#include "support/measured.hpp"

namespace bernal {
namespace relaxed_discs_test {

using test::Container2;
using test::packed;
using test::scene_in;

const std::string relax = "\n[[stage]]\ndo = \"relax\"\n";
const std::string two_sizes =
    "diameter = { distribution = \"classes\", values = [0.36, 0.504], shares = [50, 50], basis = \"number\" "
    "}";

void expect_sound(const Packing& packing, const Domain& domain) {
  ASSERT_EQ(packing.spheres.dimension(), 2);
  const Certificate certificate = certify(packing.spheres, packing.domain);
  EXPECT_TRUE(certificate.certified) << certificate.statement;
  test::expect_free_of_overlap(packing, domain);
}

TEST(RelaxedDiscs, FillEveryContainer) {
  for (const Container2& in : test::containers()) {
    for (const std::string& sizes : {test::equal, test::lognormal, "fill = true\n" + two_sizes}) {
      SCOPED_TRACE(in.name + ": " + sizes);
      const Packing packing = packed(scene_in(in.toml, sizes + relax));
      expect_sound(packing, in.domain);
      EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
      // As many as can be pushed in are more than what is expected, the more of equal discs, which
      // crystallise; hexagonal packing has 0.907.
      EXPECT_GT(packing.packing_fraction(), packing.expected_packing_fraction);
      EXPECT_LT(packing.packing_fraction(), packing.expected_packing_fraction + 0.06);
      const Packing settled = packed(scene_in(in.toml, sizes));
      EXPECT_GT(packing.packing_fraction(), settled.packing_fraction() + 0.01);
    }
  }
}

TEST(RelaxedDiscs, ReachWhatIsAskedFor) {
  for (const Container2& in : test::containers()) {
    SCOPED_TRACE(in.name);
    const Packing by_share = packed(scene_in(in.toml, "packing_fraction = 0.78\n" + two_sizes + relax));
    expect_sound(by_share, in.domain);
    EXPECT_EQ(by_share.outcome, Outcome::converged) << by_share.reason;
    EXPECT_GE(by_share.packing_fraction(), 0.78 * (1 - 1e-12));
    const Packing by_count = packed(scene_in(in.toml, "count = 190\nradius = 0.2" + relax));
    expect_sound(by_count, in.domain);
    EXPECT_EQ(by_count.outcome, Outcome::converged) << by_count.reason;
    EXPECT_EQ(by_count.spheres.size(), 190u);
  }
  // What has no room ends honestly: no arrangement of equal discs has more than 0.9069 of the plane.
  const Packing crowded =
      packed(scene_in(test::containers().front().toml, "packing_fraction = 0.9\n" + two_sizes + relax));
  EXPECT_EQ(crowded.outcome, Outcome::full) << crowded.reason;
  EXPECT_TRUE(certify(crowded.spheres, crowded.domain).certified);
  EXPECT_LT(crowded.packing_fraction(), 0.9);
}

TEST(RelaxedDiscs, ArePolishedUntilAsManyContactsAsHoldThemAreClosed) {
  for (const Container2& in : test::containers()) {
    SCOPED_TRACE(in.name);
    const Packing packing =
        packed(scene_in(in.toml, "packing_fraction = 0.8\n" + two_sizes + relax + "polish = 1e-8\n"));
    expect_sound(packing, in.domain);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_NEAR(packing.size_scale, 1, 0.03);
    const Contacts contacts = measure_contacts(packing, 1e-8);
    EXPECT_GT(2 * contacts.backbone, packing.spheres.size());
    EXPECT_GT(contacts.backbone_walls, 0u);
    ASSERT_TRUE(contacts.isostatic.has_value());
    EXPECT_EQ(*contacts.isostatic, 2 * contacts.backbone + 1);
    // A few gaps that bear nothing are that small by chance.
    EXPECT_NEAR(static_cast<double>(contacts.backbone_contacts()), static_cast<double>(*contacts.isostatic),
                0.005 * static_cast<double>(*contacts.isostatic) + 1);
  }
}

TEST(RelaxedDiscs, AreTheSameForAnyNumberOfThreads) {
  for (const Container2& in : test::containers()) {
    const std::string toml = scene_in(in.toml, "packing_fraction = 0.8\n" + two_sizes + relax);
    const std::string alone = hash_of(packed(toml, 1).spheres);
    for (const int threads : {2, 5})
      EXPECT_EQ(hash_of(packed(toml, threads).spheres), alone) << in.name << threads;
  }
}

/// A comb whose teeth take discs one by one, besides a square.
TEST(RelaxedDiscs, StandOneByOneInSlits) {
  const Polygon comb{{{{0, 0},
                       {8, 0},
                       {8, 3},
                       {14, 3},
                       {14, 4.0},
                       {8, 4.0},
                       {8, 5},
                       {14, 5},
                       {14, 6.02},
                       {8, 6.02},
                       {8, 8},
                       {0, 8}}}};
  const Packing packing = packed(scene_in(test::toml_of(comb), "fill = true\nradius = 0.5" + relax));
  expect_sound(packing, comb);
  std::size_t in_wide = 0;
  for (std::size_t i = 0; i < packing.spheres.size(); ++i)
    if (packing.spheres.x[0][i] > 8.5 && packing.spheres.x[1][i] > 4.5) ++in_wide;
  EXPECT_GE(in_wide, 5u);
}

TEST(RelaxedDiscs, FreeAStartOfItsOverlap) {
  const testing::Folder folder;
  folder.write("start.csv", "x,y,r\n2,2,1\n3,2,1\n7.6,4,1\n2,2,0.5\n");
  for (const std::string& container :
       {std::string("[container]\nkind = \"box\"\nsize = [8, 8]\n"),
        std::string("[container]\nkind = \"polygon\"\nvertices = [[0, 0], [8, 0], [8, 8], [0, 8]]\n")}) {
    const auto scene = folder.write("scene.toml", container + "[spheres]\nstart = \"start.csv\"\n" + relax);
    const Packing packing = run(build(read_scene(scene)), {.threads = 1});
    expect_sound(packing, packing.domain);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    ASSERT_EQ(packing.spheres.size(), 4u);
    EXPECT_EQ(packing.spheres.r, (std::vector<double>{1, 1, 1, 0.5}));
  }
}

const std::string grow = "\n[[stage]]\ndo = \"grow\"\n";

TEST(GrownDiscs, ReachWhatIsAskedFor) {
  for (const Container2& in : test::containers()) {
    SCOPED_TRACE(in.name);
    const Packing packing = packed(scene_in(in.toml, "packing_fraction = 0.78\n" + two_sizes + grow));
    expect_sound(packing, in.domain);
    EXPECT_EQ(packing.outcome, Outcome::converged) << packing.reason;
    EXPECT_GE(packing.packing_fraction(), 0.78 * (1 - 1e-12));
  }
}

TEST(GrownDiscs, JamAsDenselyAsRelaxedOnes) {
  for (const Container2& in : test::containers()) {
    SCOPED_TRACE(in.name);
    const std::string filled = "fill = true\n" + two_sizes;
    const Packing grown = packed(scene_in(in.toml, filled + grow + "rate = 0.03\npressure = 1e4\n"));
    expect_sound(grown, in.domain);
    const Packing relaxed = packed(scene_in(in.toml, filled + relax));
    EXPECT_NEAR(grown.packing_fraction(), relaxed.packing_fraction(), 0.015);
  }
}

}  // namespace relaxed_discs_test
}  // namespace bernal

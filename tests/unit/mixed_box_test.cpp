#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/measure/contacts.hpp"
#include "bernal/run/run.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/measured.hpp"
#include "support/periodic_certificates.hpp"

// A box that repeats itself along some axes and ends at walls along others.
namespace bernal {
namespace mixed_box_test {

using testing::rows;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

/// 10 along both axes; walls along the second.
const Box mixed = periodic_box(Vector<2>(10, 10), {false, true});

Certificate both_ways(const Spheres<dynamic>& spheres, const Box& box = mixed) {
  const Certificate filtered = certify(spheres, box, {.arithmetic = Arithmetic::filtered});
  const Certificate exact = certify(spheres, box, {.arithmetic = Arithmetic::exact});
  EXPECT_EQ(filtered.certified, exact.certified);
  EXPECT_EQ(filtered.statement, exact.statement);
  EXPECT_EQ(exact.decided_double, 0u);
  return filtered;
}

TEST(MixedBox, HasImagesOnlyAlongAxesWithoutWalls) {
  // Across the face of axis 0 these overlap; across that of axis 1, a wall, they do not.
  EXPECT_EQ(both_ways(rows({{0.5, 5, 1}, {9.5, 5, 1}})).overlapping_pairs, 1u);
  EXPECT_TRUE(both_ways(rows({{5, 1, 1}, {5, 9, 1}})).certified);
  EXPECT_FALSE(certify(rows({{5, 0.5, 1}, {5, 9.5, 1}}), periodic_box(mixed.size)).certified);
}

TEST(MixedBox, IsDecidedAtItsWallsToTheUlp) {
  EXPECT_TRUE(both_ways(rows({{0, 1, 1}})).certified);
  EXPECT_TRUE(both_ways(rows({{0, 9, 1}})).certified);
  for (const double y : {down(1), up(9)}) {
    const Certificate c = both_ways(rows({{0, y, 1}}));
    EXPECT_FALSE(c.certified);
    EXPECT_EQ(c.protruding_spheres, 1u);
    EXPECT_EQ(c.worst_wall, 0u);
    EXPECT_LT(c.min_wall_gap, 0);
  }
  const Certificate c = both_ways(rows({{0, 3, 1}, {5, 5, 1}}));
  EXPECT_EQ(c.walls_tested, 4u);
  EXPECT_NE(c.statement.find("no protrusion"), std::string::npos) << c.statement;
  EXPECT_NE(c.statement.find("along axis 1"), std::string::npos) << c.statement;
}

TEST(MixedBox, TakesCentresModuloTheBoxOnlyWhereItRepeatsItself) {
  EXPECT_TRUE(both_ways(rows({{1234, 5, 1}})).certified);
  EXPECT_EQ(both_ways(rows({{5, 15, 1}})).protruding_spheres, 1u);
}

TEST(MixedBox, LetsASphereTouchItselfOnlyAlongAxesWithoutWalls) {
  const Box thin = periodic_box(Vector<2>(10, 2), {false, true});
  EXPECT_TRUE(both_ways(rows({{5, 1, 1}}), thin).certified);
  EXPECT_EQ(both_ways(rows({{5, 1, 1}}), thin).pairs_tested, 0u);
  EXPECT_EQ(both_ways(rows({{5, 1, 1}}), periodic_box(thin.size, {true, false})).pairs_tested, 1u);
}

TEST(MixedBox, RefusesWallsOnTooManyAxes) {
  EXPECT_THROW(certify(rows({{5, 5, 1}}), Box{{0, 0}, mixed.size, {true}}), Error);
}

TEST(MixedBox, CountsContactsWithWallsAndImages) {
  Packing packing;
  packing.domain = mixed;
  packing.spheres = rows({{1, 1, 1}, {9, 1, 1}, {5, 9, 1}});
  const Contacts contacts = measure_contacts(packing, 1e-9);
  EXPECT_EQ(contacts.pairs, 1u);  // the first two, across the face
  EXPECT_EQ(contacts.walls, 3u);
  EXPECT_FALSE(contacts.isostatic.has_value());
}

TEST(MixedBox, IsNamedByItsAxes) {
  EXPECT_EQ(name_of(periodic_box(mixed.size)), "periodic box");
  EXPECT_EQ(name_of(mixed), "box periodic but along axis 1");
  EXPECT_EQ(name_of(periodic_box(mixed.size, {true, true})), "box");
}

TEST(MixedBox, ComesFromASceneAndGoesIntoIt) {
  const Scene scene = parse_scene(
      "[container]\nkind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [2, 0]\n[spheres]\npacking_fraction = "
      "0.2\n"
      "radius = 0.1\n[[stage]]\ndo = \"fly\"\n",
      "test.toml");
  const Packing packing = run(build(scene));
  for (const Domain& domain : {domain_of(scene), packing.domain, domain_of(packing.scene)})
    EXPECT_EQ(std::get<Box>(domain).periodic, (std::vector<bool>{false, true, false}));
}

TEST(MixedBox, OfNoWallsIsAPeriodicBox) {
  const Scene scene = parse_scene(
      "[container]\nkind = \"periodic\"\nsize = [1, 2, 3]\nwalls = []\n[spheres]\ncount = 3\nradius = 0.1\n",
      "test.toml");
  EXPECT_EQ(name_of(domain_of(scene)), "periodic box");
}

TEST(MixedBox, IsRefusedByWhatDoesNotKnowWalls) {
  const auto message = [](const std::string& stage) -> std::string {
    try {
      build(
          parse_scene("[container]\nkind = \"periodic\"\nsize = [1, 2, 3]\nwalls = [2]\n[spheres]\n"
                      "packing_fraction = 0.2\nradius = 0.1\n[[stage]]\n" +
                          stage,
                      "test.toml"));
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_scene);
      return error.what();
    }
  };
  EXPECT_EQ(message("do = \"relax\"\npolish = 1e-6\n"), "");
  EXPECT_NE(message("do = \"relax\"\nmethod = \"reference\"\n").find("\"method\""), std::string::npos);
  EXPECT_EQ(message("do = \"relax\"\n"), "");
  EXPECT_EQ(message("do = \"insert\"\n[[stage]]\ndo = \"compress\"\n"), "");
  EXPECT_NE(message("do = \"compress\"\n").find("none places any"), std::string::npos);
  EXPECT_NE(message("do = \"fly\"\nmethod = \"classes\"\n").find("\"flight\""), std::string::npos);
  EXPECT_EQ(message("do = \"fly\"\n"), "");
}

}  // namespace mixed_box_test
}  // namespace bernal

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/gap_oracle.hpp"
#include "support/meshes.hpp"
#include "support/packing_oracle.hpp"
#include "support/polygons.hpp"

// Gaps are proven as overlaps are: of doubles that are exact numbers, to the last bit.
namespace bernal {
namespace gap_certificate_test {

constexpr double infinity = std::numeric_limits<double>::infinity();

double above(double x) { return std::nextafter(x, infinity); }
double below(double x) { return std::nextafter(x, -infinity); }

Spheres<dynamic> spheres(int dimension, const std::vector<std::vector<double>>& rows) {
  Spheres<dynamic> all(dimension);
  for (const auto& row : rows)
    all.push_back(Eigen::Map<const Eigen::VectorXd>(row.data(), dimension), row.back());
  return all;
}

/// Whether it keeps the gaps, by both arithmetics, which agree.
bool keeps(const Spheres<dynamic>& s, const Domain& domain, double gap, double wall_gap) {
  const CertifyOptions filtered{.gap = gap, .wall_gap = wall_gap};
  CertifyOptions exact = filtered;
  exact.arithmetic = Arithmetic::exact;
  const Certificate by_filter = certify(s, domain, filtered), by_exact = certify(s, domain, exact);
  EXPECT_EQ(by_filter.certified, by_exact.certified);
  EXPECT_EQ(by_filter.statement.substr(0, 14), by_exact.statement.substr(0, 14));
  EXPECT_EQ(by_filter.least_distance, by_exact.least_distance);
  EXPECT_EQ(by_filter.least_wall_distance, by_exact.least_wall_distance);
  EXPECT_EQ(by_filter.certified, by_filter.overlapping_pairs + by_filter.protruding_spheres == 0);
  if (gap > 0 && by_filter.overlapping_pairs > 0) {
    EXPECT_LT(*by_filter.least_distance, gap);
  }
  if (by_filter.least_distance && by_filter.overlapping_pairs == 0) {
    EXPECT_GE(*by_filter.least_distance, gap);
  }
  return by_filter.certified;
}

TEST(GapCertificate, AllowsExactlyTheGapAndNotOneBitLess) {
  // 3-4-5: the distance is 5, of which the radii take 4; all sums are exact.
  const Domain space = Box{Vector<3>(-20, -20, -20), Vector<3>(40, 40, 40)};
  const Spheres<dynamic> pair = spheres(3, {{0, 0, 0, 1.5}, {3, 4, 0, 2.5}});
  EXPECT_TRUE(keeps(pair, space, 1, 0));
  EXPECT_TRUE(keeps(pair, space, below(1), 0));
  EXPECT_FALSE(keeps(pair, space, above(1), 0));
  // The same by a smaller step than a sum of doubles has: 4 + 1 + 2^-60 is no double.
  EXPECT_FALSE(keeps(spheres(3, {{0, 0, 0, 1.5 + 0x1p-52}, {3, 4, 0, 2.5}}), space, 1, 0));
  EXPECT_TRUE(keeps(spheres(3, {{0, 0, 0, 1.5}, {3, 4, 0, 0x1p-60}}), space, 3.5 - 0x1p-51, 0));
  EXPECT_FALSE(keeps(spheres(3, {{0, 0, 0, 1.5}, {3, 4, 0, 0x1p-60}}), space, 3.5, 0));
  EXPECT_TRUE(keeps(spheres(3, {{0, 0, 0, 1.5}, {3, 4, 0, 0x1p-60}}), space, below(3.5), 0));
}

TEST(GapCertificate, KnowsWhichPairIsNearerThanTheGapThoughABetterOneOverlapsLessByRatio) {
  const Domain space = Box{Vector<3>(-90, -90, -90), Vector<3>(180, 180, 180)};
  // Large ones 0.2 apart, small ones 0.09 apart, which is more of their sum of radii.
  const Spheres<dynamic> s =
      spheres(3, {{0, 0, 0, 10}, {20.2, 0, 0, 10}, {0, 40, 0, 0.25}, {0.59, 40, 0, 0.25}});
  const Certificate c = certify(s, space, {.gap = 0.1, .list = 10});
  EXPECT_FALSE(c.certified);
  EXPECT_EQ(c.overlapping_pairs, 1u);
  EXPECT_EQ(*c.worst_pair, (std::array<std::uint64_t, 2>{2, 3}));
  ASSERT_EQ(c.overlaps.size(), 1u);
  EXPECT_NEAR(c.overlaps[0].ratio, 0.01 / 0.6, 1e-12);
  EXPECT_NEAR(*c.least_distance, 0.09, 1e-12);
  EXPECT_NE(c.statement.find("nearer than the gap of 0.1"), std::string::npos) << c.statement;
}

TEST(GapCertificate, SeesImages) {
  const Domain box = periodic_box(Vector<3>(4, 4, 4));
  EXPECT_TRUE(keeps(spheres(3, {{0.5, 1, 1, 0.5}, {3.75, 1, 1, 0.125}}), box, 0.125, 0));
  EXPECT_FALSE(keeps(spheres(3, {{0.5, 1, 1, 0.5}, {3.75, 1, 1, 0.125}}), box, above(0.125), 0));
  // Its own: the edge less the diameter.
  EXPECT_TRUE(keeps(spheres(3, {{0.5, 1, 1, 1.75}}), box, 0.5, 0));
  EXPECT_FALSE(keeps(spheres(3, {{0.5, 1, 1, 1.75}}), box, above(0.5), 0));
  EXPECT_FALSE(keeps(spheres(3, {{0.5, 1, 1, 0.25}}), box, 3.75, 0));
}

TEST(GapCertificate, ProvesTheGapFromEveryKindOfWall) {
  struct Wall {
    std::string name;
    Domain domain;
    Spheres<dynamic> sphere;
    double gap;
  };
  const Cylinder cylinder{.base = {0, 0, 0}, .axis = {0, 0, 2}, .radius = 4, .height = 8};
  Cylinder column = cylinder;
  column.periodic = true;
  const std::vector<Wall> walls = {
      {"box", Box{Vector<3>(0, 0, 0), Vector<3>(8, 8, 8)}, spheres(3, {{4, 6.5, 4, 1}}), 0.5},
      {"rectangle", Box{Vector<2>(0, 0), Vector<2>(8, 8)}, spheres(2, {{1.75, 4, 1}}), 0.75},
      {"slab", periodic_box(Vector<3>(8, 8, 8), {false, false, true}), spheres(3, {{7.9, 4, 6.75, 1}}), 0.25},
      {"side", cylinder, spheres(3, {{0, -2.5, 4, 1}}), 0.5},
      {"base", cylinder, spheres(3, {{0, 0, 1.25, 1}}), 0.25},
      {"top", cylinder, spheres(3, {{0, 0, 6.25, 1}}), 0.75},
      {"column", column, spheres(3, {{0, -2.5, 0.25, 1}}), 0.5},
      {"sphere", Sphere{{0, 0, 0}, 8}, spheres(3, {{0, 3, 4, 2.5}}), 0.5},
      {"mesh", test::box_mesh(Vector<3>(0, 0, 0), Vector<3>(8, 8, 8)), spheres(3, {{4, 6.5, 4, 1}}), 0.5},
      // Towards the reflex edge of an L, at (1, 1) there: 3-4-5 again.
      {"reflex edge", test::l_shape_mesh(), spheres(3, {{0.625, 0.5, 0.5, 0.25}}), 0.125},
      {"polygon", test::l_shape(), spheres(2, {{3, 7, 0.5}}), 0.5},
      {"reflex corner", test::l_shape(), spheres(2, {{1.75, 1.75, 1}}), 0.75},
  };
  for (const Wall& wall : walls) {
    SCOPED_TRACE(wall.name);
    const double least = testing::least_wall_gap(wall.sphere, wall.domain);
    // The truth by formulas with rounding, which is none here but for the reflex edges.
    ASSERT_NEAR(least, wall.name == "reflex edge" ? least : wall.gap, 1e-14);
    const double exact = wall.name == "reflex edge" ? std::min(least, 0.25) : wall.gap;
    EXPECT_TRUE(keeps(wall.sphere, wall.domain, 0, exact * (1 - 1e-14)));
    if (wall.name != "reflex edge") {
      EXPECT_TRUE(keeps(wall.sphere, wall.domain, 0, exact));
    }
    EXPECT_FALSE(keeps(wall.sphere, wall.domain, 0, exact * (1 + 1e-14)));
    if (wall.name != "reflex edge") {
      EXPECT_FALSE(keeps(wall.sphere, wall.domain, 0, above(exact)));
    }
    const Certificate c = certify(wall.sphere, wall.domain, {.wall_gap = exact * (1 - 1e-14)});
    ASSERT_TRUE(c.least_wall_distance);
    EXPECT_NEAR(*c.least_wall_distance, least, 1e-14);
  }
}

// What the oracle of rational numbers says of larger spheres, whose radii have the gap in them, is true of
// these with the gap, where no sum is rounded: multiples of 2^-10.
TEST(GapCertificate, SaysWhatTheOracleSaysOfLargerSpheres) {
  Random random(7, 1);
  const auto grain = [&](double low, double high) {
    return std::round(random.uniform(low, high) * 0x1p10) * 0x1p-10;
  };
  const Domain shapes[] = {Box{Vector<3>(0, 0, 0), Vector<3>(1, 1, 1)}, Sphere{{0.5, 0.5, 0.5}, 0.625},
                           Cylinder{.base = {0.5, 0.5, 0}, .radius = 0.5, .height = 1}, test::l_shape_mesh()};
  std::size_t kept = 0, broken = 0;
  for (int round = 0; round < 400; ++round) {
    Spheres<3> s, larger;
    const double gap = grain(0, 0.1);
    for (int i = 0; i < 3; ++i) {
      const Vector<3> c(grain(0.1, 0.9), grain(0.1, 0.9), grain(0.1, 0.9));
      const double r = grain(0.02, 0.15);
      s.push_back(c, r);
      larger.push_back(c, r + 0.5 * gap);
    }
    const Domain& shape = shapes[round % 4];
    const oracle::Verdict truth = oracle::judge(larger, shape, 0);
    const Certificate c = certify(s, shape, {.gap = gap, .wall_gap = 0.5 * gap});
    EXPECT_EQ(c.overlapping_pairs, truth.overlapping) << round;
    EXPECT_EQ(c.protruding_spheres, truth.protruding) << round;
    ++(c.certified ? kept : broken);
  }
  EXPECT_GT(kept, 20u);
  EXPECT_GT(broken, 20u);
}

TEST(GapCertificate, KnowsTheLeastDistancesUpToTwiceTheGap) {
  const Domain space = Box{Vector<3>(0, 0, 0), Vector<3>(8, 8, 8)};
  // Across all axes, so that boxes around them meet long before they do.
  const double step = 2 / std::sqrt(3.0);
  for (const double apart : {0.5, 0.99, 1.5, 1.99, 2.5}) {
    const double d = step * (1 + apart / 2);
    const Spheres<dynamic> s = spheres(3, {{3, 3, 3, 1}, {3 + d, 3 + d, 3 + d, 1}});
    const Certificate c = certify(s, space, {.gap = 1});
    EXPECT_EQ(c.certified, apart > 1);
    EXPECT_EQ(c.least_distance.has_value(), apart < 2);
    if (c.least_distance) {
      EXPECT_NEAR(*c.least_distance, apart, 1e-12);
    }
  }
}

TEST(GapCertificate, RefusesWhatIsNoGap) {
  const Domain space = Box{Vector<3>(0, 0, 0), Vector<3>(8, 8, 8)};
  const Spheres<dynamic> s = spheres(3, {{3, 3, 3, 1}});
  for (const double bad : {-1e-300, infinity, std::nan("")}) {
    EXPECT_THROW(certify(s, space, {.gap = bad}), Error);
    EXPECT_THROW(certify(s, space, {.wall_gap = bad}), Error);
  }
  Mesh moved = test::l_shape_mesh();
  moved.inset = 0.1;
  EXPECT_THROW(certify(s, Domain(moved)), Error);
}

}  // namespace gap_certificate_test
}  // namespace bernal

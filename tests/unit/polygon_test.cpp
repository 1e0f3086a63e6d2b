#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/polygons.hpp"

namespace bernal {
namespace polygon_test {

using Points = std::vector<Vector<2>>;

std::string refusal_of(const std::vector<Points>& loops) {
  try {
    require_simple(Polygon{loops});
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    return error.what();
  }
  return "";
}

TEST(Polygon, SimpleOnesAreTaken) {
  for (const auto& [name, domain] : test::flat_domains()) {
    const auto* polygon = std::get_if<Polygon>(&domain);
    if (!polygon) continue;
    EXPECT_NO_THROW(require_simple(*polygon)) << name;
  }
  // Two regions apart, and an island in a hole.
  const Points outer = {{0, 0}, {9, 0}, {9, 9}, {0, 9}}, hole = {{2, 2}, {7, 2}, {7, 7}, {2, 7}},
               island = {{4, 4}, {5, 4}, {5, 5}, {4, 5}};
  EXPECT_EQ(refusal_of({outer, hole, island}), "");
  EXPECT_EQ(volume_of(Polygon{{outer, hole, island}}), 81 - 25 + 1);
}

TEST(Polygon, CrossingsAreRefusedWithTheirPlace) {
  const std::string bow_tie = refusal_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}});
  EXPECT_NE(bow_tie.find("edge 1 of the outline, from (0, 0) to (4, 4), and edge 3 of the outline"),
            std::string::npos)
      << bow_tie;
  EXPECT_NE(bow_tie.find("meet at about (2, 2)"), std::string::npos) << bow_tie;
  const std::string across = refusal_of({{{0, 0}, {9, 0}, {9, 9}, {0, 9}}, {{5, 5}, {12, 5.5}, {5, 6}}});
  EXPECT_NE(across.find("edge 2 of the outline"), std::string::npos) << across;
  EXPECT_NE(across.find("of hole 1"), std::string::npos) << across;
}

TEST(Polygon, WhatTouchesIsRefusedExactly) {
  const Points outer = {{0, 0}, {9, 0}, {9, 9}, {0, 9}};
  const double below = std::nextafter(9.0, 0.0);
  EXPECT_NE(refusal_of({outer, {{4, 4}, {9, 5}, {4, 6}}}), "");
  EXPECT_EQ(refusal_of({outer, {{4, 4}, {below, 5}, {4, 6}}}), "");
  // A corner on an edge of a third, whose coordinates are no doubles: 1e6 away, by one rounding.
  EXPECT_NE(refusal_of({{{0, 0}, {2, 0}, {2, 2}, {1, 0}, {0, 2}}}), "");
  EXPECT_EQ(refusal_of({{{0, 0}, {2, 0}, {2, 2}, {1, std::numeric_limits<double>::denorm_min()}, {0, 2}}}),
            "");
  EXPECT_NE(refusal_of({{{0, 0}, {4, 0}, {2, 0}, {2, 3}}}).find("runs back along"), std::string::npos);
  EXPECT_NE(refusal_of({{{0, 0}, {3, 3}, {1, 1}}}).find("runs back along"), std::string::npos);
}

TEST(Polygon, WithoutThreeCornersThereIsNone) {
  EXPECT_NE(refusal_of({}).find("three corners"), std::string::npos);
  EXPECT_NE(refusal_of({{{0, 0}, {1, 1}}}).find("has 2 different corners"), std::string::npos);
  EXPECT_NE(refusal_of({{{0, 0}, {1, 1}, {1, 1}, {0, 0}}}).find("has 2 different corners"),
            std::string::npos);
  EXPECT_NE(refusal_of({{{0, 0}, {1, std::nan("")}, {2, 2}}}).find("corner 2 of the outline is not finite"),
            std::string::npos);
}

TEST(Polygon, MeasuresDoNotDependOnTheSense) {
  for (const Polygon& polygon : {test::triangle(), test::l_shape(), test::with_hole(), test::star(50)}) {
    EXPECT_NEAR(volume_of(test::clockwise(polygon)), volume_of(polygon), 1e-12 * volume_of(polygon));
    EXPECT_NEAR(area_of(test::clockwise(polygon)), area_of(polygon), 1e-12 * area_of(polygon));
  }
  EXPECT_EQ(volume_of(test::l_shape()), 64);
  EXPECT_EQ(area_of(test::l_shape()), 40);
  EXPECT_EQ(volume_of(test::triangle()), 45);
  EXPECT_EQ(area_of(Box{{1, 1}, {3, 4}}), 14);
}

Certificate certificate_of(const Polygon& polygon, const Vector<2>& c, double r,
                           Arithmetic arithmetic = Arithmetic::filtered) {
  Spheres<2> disc;
  disc.push_back(c, r);
  return certify(disc, polygon, {.arithmetic = arithmetic});
}

TEST(PolygonCertificate, DecidesToTheLastBit) {
  for (const Arithmetic arithmetic : {Arithmetic::filtered, Arithmetic::exact}) {
    const auto holds = [&](const Polygon& polygon, const Vector<2>& c, double r) {
      return certificate_of(polygon, c, r, arithmetic).certified;
    };
    const double more = std::nextafter(2.0, 3.0);
    for (const Polygon& l : {test::l_shape(), test::clockwise(test::l_shape())}) {
      EXPECT_TRUE(holds(l, {2, 2}, 2));
      EXPECT_FALSE(holds(l, {2, 2}, more));
      EXPECT_TRUE(holds(l, {2, 8}, 2));
      EXPECT_FALSE(holds(l, {std::nextafter(2.0, 0.0), 8}, 2));
      // The reflex corner at (4, 4): a 3-4-5 triangle away.
      EXPECT_TRUE(holds(Polygon{{{{0, 0}, {20, 0}, {20, 8}, {8, 8}, {8, 20}, {0, 20}}}}, {5, 4}, 4));
      EXPECT_FALSE(holds(l, {6, 6}, 1)) << "outside";
      EXPECT_FALSE(holds(l, {4, 7}, 0.5)) << "on an edge";
    }
    EXPECT_TRUE(holds(Polygon{{{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, {{3, 4}, {5, 4}, {5, 6}}}}, {0, 0}, 5));
    EXPECT_FALSE(holds(Polygon{{{{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}, {{3, 4}, {5, 4}, {5, 6}}}}, {0, 0},
                       std::nextafter(5.0, 6.0)));
    EXPECT_FALSE(holds(test::with_hole(), {5, 5}, 0.5)) << "in the hole";
  }
}

TEST(PolygonCertificate, AgreesWithThePlainestDefinition) {
  Random random(5, stream(Stream::test));
  for (const auto& [name, domain] : test::flat_domains()) {
    const auto* polygon = std::get_if<Polygon>(&domain);
    if (!polygon) continue;
    const Bounds<dynamic> bounds = bounds_of<dynamic>(domain);
    const Bounds<2> all{bounds.lower, bounds.upper};
    int inside = 0;
    for (int i = 0; i < 300; ++i) {
      const Vector<2> p = uniform_point(random, all);
      const auto clearance = static_cast<double>(test::precise_clearance_flat(domain, p));
      const double r = random.uniform(0.1, 1.5) * std::max(std::abs(clearance), 1e-3);
      if (std::abs(clearance - r) < 1e-9) continue;
      const Certificate certificate = certificate_of(*polygon, p, r);
      EXPECT_EQ(certificate.certified, clearance >= r) << name;
      EXPECT_EQ(certificate_of(*polygon, p, r, Arithmetic::exact).certified, clearance >= r) << name;
      inside += clearance > 0;
      EXPECT_NEAR(certificate.min_wall_gap, (clearance - r) / r, 1e-8 * std::max(1.0, clearance / r));
    }
    EXPECT_GT(inside, 50) << name;
  }
}

}  // namespace polygon_test
}  // namespace bernal

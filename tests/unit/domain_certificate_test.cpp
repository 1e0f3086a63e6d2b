// What the certificate says where walls and periods come together: boxes that end on some axes, and cylinders
// that repeat themselves.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/periodic_certificates.hpp"

namespace bernal {
namespace domain_certificate_test {

using testing::expect_same_verdict;
using testing::expect_truth;
using testing::rows;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

struct DomainUnderTest {
  std::string name;
  Domain domain;
};

/// Every choice of axes with walls in up to four dimensions, and cylinders along and against every axis; on a
/// lattice of eighths, so that touches are met exactly.
std::vector<DomainUnderTest> domains_under_test() {
  std::vector<DomainUnderTest> all;
  for (int dimension = 1; dimension <= 4; ++dimension)
    for (int mask = 0; mask < 1 << dimension; ++mask) {
      Box box{Vector<dynamic>::Zero(dimension), Vector<dynamic>::Zero(dimension)};
      std::string name = "Box" + std::to_string(dimension) + "D";
      for (int k = 0; k < dimension; ++k) {
        box.corner[k] = 0.5 * k - 1;
        box.size[k] = 3 + 0.5 * k;
        box.periodic.push_back((mask >> k & 1) != 0);
        name += box.repeats(k) ? "Repeats" : "Ends";
      }
      all.push_back({name, box});
    }
  for (int axis = 0; axis < 3; ++axis)
    for (const double length : {1.0, -3.0}) {
      const Vector<3> direction = length * Vector<3>::Unit(axis);
      all.push_back({std::string(length > 0 ? "CylinderAlong" : "CylinderAgainst") + "XYZ" [axis], Cylinder {
                       {0.5, -1, 2}, direction, 2, 3.5, true
                     }});
    }
  return all;
}

class DomainCertificate : public ::testing::TestWithParam<DomainUnderTest> {
 protected:
  const Domain& domain() const { return GetParam().domain; }
  int dimension() const { return dimension_of(domain()); }
  Vector<dynamic> periods() const { return oracle::periods_of(domain()); }

  /// Spheres on eighths in and a little around the domain, some of them periods away. `large` are as large as
  /// the domain.
  Spheres<dynamic> spheres(std::size_t n, std::uint64_t seed, bool lattice, bool large = false) const {
    Random random(seed, stream(Stream::test));
    const Bounds<dynamic> bounds = bounds_of<dynamic>(domain());
    Spheres<dynamic> s(dimension());
    for (std::size_t i = 0; i < n; ++i) {
      Vector<dynamic> c(dimension());
      for (int k = 0; k < dimension(); ++k) {
        c[k] = random.uniform(bounds.lower[k] - 0.1, bounds.upper[k] + 0.1);
        if (lattice) c[k] = std::round(8 * c[k]) / 8;
        if (i % 3 == 0) c[k] += periods()[k] * std::floor(random.uniform(-2, 3));
      }
      const double r = random.uniform(0.05, large ? 2.5 : 0.8);
      s.push_back(c, lattice ? std::max(0.125, std::round(8 * r) / 8) : r);
    }
    return s;
  }
};

INSTANTIATE_TEST_SUITE_P(All, DomainCertificate, ::testing::ValuesIn(domains_under_test()),
                         [](const auto& test) { return test.param.name; });

TEST_P(DomainCertificate, AgreesWithTheOracle) {
  std::uint64_t overlapping = 0, protruding = 0, certified = 0;
  const std::size_t n = dimension() < 4 ? 12 : 6;
  for (std::uint64_t seed = 1; seed <= (dimension() < 4 ? 12u : 4u); ++seed) {
    Spheres<dynamic> s = spheres(n, seed, seed % 3 != 0, seed % 4 == 0);
    if (seed % 2 == 0) {
      s.r[1] = up(s.r[1]);
      s.x[0][2] = down(s.x[0][2]);
    }
    const Certificate c = expect_truth(s, domain());
    overlapping += c.overlapping_pairs;
    protruding += c.protruding_spheres;
    expect_truth(s, domain(), 0.25);
  }
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    certified += expect_truth(spheres(1 + seed % 2, 100 + seed, true), domain()).certified;
  EXPECT_GT(overlapping, 0u);
  EXPECT_EQ(protruding > 0, has_walls(domain()));
  EXPECT_GT(certified, 0u);
}

TEST_P(DomainCertificate, HasNoPlaceAlongWhatRepeats) {
  const Spheres<dynamic> s = spheres(60, 7, true);
  const Certificate here = certify(s, domain(), {.list = 10});
  EXPECT_GT(here.overlapping_pairs, 0u);
  Spheres<dynamic> moved = s;
  for (int k = 0; k < dimension(); ++k) {
    if (!(periods()[k] > 0)) continue;
    for (std::size_t i = 0; i < s.size(); ++i)
      moved.x[static_cast<std::size_t>(k)][i] += 0.625 + periods()[k] * static_cast<double>(i % 7);
  }
  const Certificate there = certify(moved, domain(), {.list = 10});
  EXPECT_EQ(there.overlapping_pairs, here.overlapping_pairs);
  EXPECT_EQ(there.max_overlap, here.max_overlap);
  EXPECT_EQ(there.protrusions, here.protrusions);
}

/// Where two periods stand for one, every sphere has its image among the others.
TEST_P(DomainCertificate, TwoPeriodsAreAsGoodAsOne) {
  for (int k = 0; k < dimension(); ++k) {
    if (!(periods()[k] > 0)) continue;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Spheres<dynamic> s = spheres(1 + seed % 5, seed, true);
      Domain longer = domain();
      if (auto* box = std::get_if<Box>(&longer)) box->size[k] *= 2;
      if (auto* cylinder = std::get_if<Cylinder>(&longer)) cylinder->height *= 2;
      Spheres<dynamic> both = s;
      for (std::size_t i = 0; i < s.size(); ++i) {
        Vector<dynamic> c = s.center(i);
        c[k] += periods()[k];
        both.push_back(c, s.r[i]);
      }
      const Certificate one = certify(s, domain()), two = certify(both, longer);
      EXPECT_EQ(two.certified, one.certified);
      EXPECT_EQ(two.protruding_spheres, 2 * one.protruding_spheres);
      EXPECT_EQ(two.min_wall_gap, one.min_wall_gap);
      if (one.max_overlap > 0) {
        EXPECT_EQ(two.max_overlap, one.max_overlap);
      }
    }
  }
}

TEST_P(DomainCertificate, ScalesByPowersOfTwo) {
  Spheres<dynamic> s = spheres(50, 3, false);
  const Certificate c = certify(s, domain(), {.list = 5});
  for (const double factor : {0x1p40, 0x1p-90}) {
    for (auto& column : s.x)
      for (double& x : column) x *= factor;
    for (double& r : s.r) r *= factor;
    Domain scaled = domain();
    if (auto* box = std::get_if<Box>(&scaled)) {
      box->corner *= factor == 0x1p40 ? factor : 0x1p-50;  // of the one before
      box->size *= factor == 0x1p40 ? factor : 0x1p-50;
    }
    if (auto* cylinder = std::get_if<Cylinder>(&scaled)) {
      const double by = factor == 0x1p40 ? factor : 0x1p-50;
      cylinder->base *= by;
      cylinder->radius *= by;
      cylinder->height *= by;
    }
    expect_same_verdict(certify(s, scaled, {.list = 5}), c);
  }
}

TEST_P(DomainCertificate, DoesNotDependOnTheNumberOfThreads) {
  const Spheres<dynamic> s = spheres(2000, 5, false);
  const Certificate one = certify(s, domain(), {.list = 100, .threads = 1});
  EXPECT_EQ(one.overlaps.size(), 100u);
  for (const int threads : {2, 5}) {
    const Certificate many = certify(s, domain(), {.list = 100, .threads = threads});
    expect_same_verdict(many, one);
    EXPECT_EQ(many.decided_exact, one.decided_exact);
  }
  expect_same_verdict(tbb::task_arena(3).execute([&] { return certify(s, domain(), {.list = 100}); }), one);
}

// ---- Periodic cylinders by hand

/// Along y from y = 1, of radius 2 and period 8.
const Cylinder column{{0, 1, 0}, {0, 5, 0}, 2, 8, true};

TEST(PeriodicCylinder, HasASideAndNoLids) {
  // 0.75 and 1 from the axis: 1.25 away.
  for (const double y : {1.0, 0.0, -1e9, 8.99, 123.0}) {
    const Certificate c = expect_truth(rows({{0.75, y, 1, 0.75}}), column, 0, std::abs(y) < 200);
    EXPECT_TRUE(c.certified) << y;
    EXPECT_EQ(c.walls_tested, 1u);
    EXPECT_EQ(c.min_wall_gap, 0);
    EXPECT_FALSE(expect_truth(rows({{0.75, y, 1, up(0.75)}}), column, 0, std::abs(y) < 200).certified) << y;
    EXPECT_FALSE(expect_truth(rows({{up(0.75), y, 1, 0.75}}), column, 0, std::abs(y) < 200).certified) << y;
    EXPECT_TRUE(expect_truth(rows({{0.75, y, down(1), 0.75}}), column, 0, std::abs(y) < 200).certified) << y;
  }
  Cylinder closed = column;
  closed.periodic = false;
  EXPECT_FALSE(certify(rows({{0, 1, 0, 0.5}}), closed).certified);
  EXPECT_EQ(
      certify(rows({{0, 1, 0, 0.5}}), column).statement,
      "Certified: 1 sphere in a periodic cylinder, 0 near pairs and 1 wall decided exactly, no overlap, "
      "no protrusion; closest pair gap 7 of the sum of radii.");
}

TEST(PeriodicCylinder, HasImagesAlongItsAxisToTheUlp) {
  // 0.6 apart across the axis and 0.8 along it, through the end at y = 9, which is y = 1.
  const Spheres<dynamic> pair = rows({{0, 8.5, 0.375, 0.25}, {0, 1.3125, 0, 0.640625}});
  // |(0.375, 0.8125)|² = 0.80078125 and 0.890625² = 0.7932...: near, and apart.
  EXPECT_TRUE(expect_truth(pair, column).certified);
  const Spheres<dynamic> touching = rows({{0, 8.5, 0.375, 0.25}, {0, 1, 0, 0.375}});  // 3, 4, 5 eighths
  const Certificate c = expect_truth(touching, column);
  EXPECT_TRUE(c.certified);
  EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 1}));
  EXPECT_EQ(c.max_overlap, 0);
  for (const std::size_t i : {0, 1}) {
    Spheres<dynamic> swollen = touching;
    swollen.r[i] = up(swollen.r[i]);
    EXPECT_EQ(expect_truth(swollen, column).overlapping_pairs, 1u);
  }
  Cylinder shorter = column;
  shorter.height = down(8);
  EXPECT_EQ(expect_truth(touching, shorter).overlapping_pairs, 1u);
}

TEST(PeriodicCylinder, ASphereMayTouchItsOwnImageAndNoMore) {
  const Cylinder disc{{0, 0, 0}, {0, 0, -2}, 3, 2, true};
  EXPECT_TRUE(expect_truth(rows({{1, 1, 0.3, 1}}), disc).certified);
  const Certificate c = expect_truth(rows({{1, 1, 0.3, up(1)}}), disc);
  EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 0}));
  EXPECT_EQ(c.overlapping_pairs, 1u);
}

TEST(PeriodicCylinder, IsRefusedWhereItsAxisIsOblique) {
  const Spheres<dynamic> one = rows({{0, 0, 0, 0.1}});
  EXPECT_THROW(certify(one, Cylinder{{0, 0, 0}, {0, 1, 1}, 1, 1, true}), Error);
  EXPECT_THROW(certify(one, Cylinder{{0, 0, 0}, {0, 0, 0}, 1, 1, true}), Error);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(certify(one, Cylinder{{0, 0, 0}, {0, 0, 1}, 1, bad, true}), Error) << bad;
    EXPECT_THROW(certify(one, Cylinder{{0, 0, 0}, {0, 0, 1}, bad, 1, true}), Error) << bad;
  }
}

TEST(DomainCertificate, RefusesABoxOfTwoMinds) {
  const Spheres<dynamic> one = rows({{0, 0, 0, 0.1}});
  EXPECT_THROW(certify(one, Box{{0, 0}, {1, 1, 1}}), Error);
  EXPECT_THROW(certify(one, Box{{0, 0, 0}, {1, 1, 1}, {true, true}}), Error);
  EXPECT_THROW(certify(one, Box{{0, 0, 0}, {1, 1, 1}, {false}}), Error);
  EXPECT_THROW(certify(one, Box{{0, 0, 0}, {1, 1, 0}, {true, true, false}}), Error);
  EXPECT_THROW(certify(one, Box{{0, 0, std::nan("")}, {1, 1, 1}, {true, true, false}}), Error);
}

// ---- What the caller asks for

/// 40 overlapping pairs, the k-th by 2^-k or so, and 20 spheres across a wall.
Spheres<dynamic> faulty() {
  Spheres<dynamic> s(3);
  for (int k = 0; k < 40; ++k) {
    s.push_back(Vector<3>(4 * k + 2, 2, 2), 1);
    s.push_back(Vector<3>(4 * k + 2, 4 - std::exp2(-(k * 7 % 40)), 2), 1);
  }
  for (int k = 0; k < 20; ++k) s.push_back(Vector<3>(4 * k + 2, 8, 0.5 + std::exp2(-(k * 3 % 20) - 2)), 1);
  return s;
}
const Box hall{{0, 0, 0}, {200, 10, 4}, {true, false, false}};

TEST(ListedFaults, AreTheWorstFirst) {
  const Certificate all = certify(faulty(), hall, {.list = CertifyOptions::all});
  EXPECT_EQ(all.overlapping_pairs, 40u);
  EXPECT_EQ(all.protruding_spheres, 20u);
  ASSERT_EQ(all.overlaps.size(), 40u);
  ASSERT_EQ(all.protrusions.size(), 20u);
  EXPECT_EQ(all.overlaps.front().pair, all.worst_pair);
  EXPECT_EQ(all.overlaps.front().ratio, all.max_overlap);
  EXPECT_EQ(all.protrusions.front().sphere, all.worst_wall);
  EXPECT_EQ(all.protrusions.front().gap, all.min_wall_gap);
  for (std::size_t k = 1; k < 40; ++k) EXPECT_GT(all.overlaps[k - 1].ratio, all.overlaps[k].ratio);
  for (std::size_t k = 1; k < 20; ++k) EXPECT_LT(all.protrusions[k - 1].gap, all.protrusions[k].gap);
  for (const std::size_t most : {1, 2, 7, 19, 30, 41}) {
    const Certificate some = certify(faulty(), hall, {.list = most});
    const auto first = [&](auto list) {
      list.resize(std::min(list.size(), most));
      return list;
    };
    EXPECT_EQ(some.overlaps, first(all.overlaps)) << most;
    EXPECT_EQ(some.protrusions, first(all.protrusions)) << most;
    EXPECT_EQ(some.overlapping_pairs, 40u);
  }
  EXPECT_TRUE(certify(faulty(), hall).overlaps.empty());
}

TEST(ListedFaults, AreOnlyThoseAboveTheAllowedOverlap) {
  const Certificate c = certify(faulty(), hall, {.allowed_overlap = 0.01, .list = CertifyOptions::all});
  EXPECT_EQ(c.allowed_overlap, 0.01);
  EXPECT_EQ(c.overlaps.size(), c.overlapping_pairs);
  EXPECT_LT(c.overlaps.size(), 40u);
  for (const auto& [pair, ratio] : c.overlaps) EXPECT_GT(ratio, 0.01);
}

TEST(WatchedCertificate, TellsHowFarItHasComeAndIsTheSame) {
  const Spheres<dynamic> s = faulty();
  std::vector<std::pair<std::string, double>> heard;
  CertifyOptions options{.list = 3};
  options.monitor.on_progress = [&](const Progress& p) { heard.emplace_back(p.activity, p.fraction); };
  expect_same_verdict(certify(s, hall, options), certify(s, hall, {.list = 3}));
  ASSERT_FALSE(heard.empty());
  EXPECT_EQ(heard.front().first, "pairs");
  for (std::size_t k = 0; k < heard.size(); ++k) {
    EXPECT_GT(heard[k].second, 0);
    EXPECT_LE(heard[k].second, 1);
  }
}

TEST(WatchedCertificate, CertifiesNothingOnceItIsStopped) {
  Spheres<dynamic> s(3);
  for (int i = 0; i < 2000; ++i)
    s.push_back(Vector<3>(i % 100 * 2 + 1, i / 100 % 4 * 2 + 1, i / 400 * 0.7 + 0.3), 0.3);
  const Certificate whole = certify(s, hall);
  ASSERT_TRUE(whole.certified) << whole.statement;
  for (const int after : {0, 1}) {
    int asked = 0;
    CertifyOptions options;
    options.monitor.cancelled = [&] { return asked++ >= after; };
    const Certificate c = certify(s, hall, options);
    EXPECT_TRUE(c.cancelled);
    EXPECT_FALSE(c.certified);
    EXPECT_LT(c.pairs_tested + c.walls_tested, whole.pairs_tested + whole.walls_tested);
    EXPECT_NE(c.statement.find("stopped"), std::string::npos) << c.statement;
  }
}

}  // namespace domain_certificate_test
}  // namespace bernal

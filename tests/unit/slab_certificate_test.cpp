#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/integer_meshes.hpp"
#include "support/periodic_certificates.hpp"

// The certificate looks at so many spheres at once; of more it is made slab by slab, and says the same.
namespace bernal {
namespace slab_certificate_test {

void expect_same(const Certificate& a, const Certificate& b, std::size_t at_once) {
  const ::testing::ScopedTrace trace(__FILE__, __LINE__, "at once " + std::to_string(at_once));
  testing::expect_same_verdict(a, b);
  EXPECT_EQ(a.spheres, b.spheres);
  EXPECT_EQ(a.centers_tested, b.centers_tested);
  EXPECT_EQ(a.decided_double, b.decided_double);
  EXPECT_EQ(a.decided_exact, b.decided_exact);
  EXPECT_EQ(a.least_distance, b.least_distance);
  EXPECT_EQ(a.least_wall_distance, b.least_wall_distance);
}

/// Told row by row, as a file would.
SphereRows rows_of(const Spheres<dynamic>& spheres) {
  return {spheres.size(), spheres.dimension(), [&spheres](std::uint64_t first, std::span<double> rows) {
            for (std::size_t at = 0; at < rows.size(); ++first) {
              for (const auto& column : spheres.x) rows[at++] = column[first];
              rows[at++] = spheres.r[first];
            }
          }};
}

void expect_same_in_slabs(const Spheres<dynamic>& spheres, const Domain& domain,
                          CertifyOptions options = {}) {
  options.list = CertifyOptions::all;
  const Certificate whole = certify(spheres, domain, options);
  EXPECT_TRUE(whole.worst_pair);
  for (const std::size_t at_once :
       {std::size_t{1}, std::size_t{2}, spheres.size() / 7 + 1, spheres.size() / 2 + 1, spheres.size() - 1}) {
    options.at_once = at_once;
    expect_same(whole, certify(spheres, domain, options), at_once);
    expect_same(whole, certify(rows_of(spheres), domain, options), at_once);
  }
  options.at_once = spheres.size();
  expect_same(whole, certify(rows_of(spheres), domain, options), options.at_once);
}

/// Of radii up to so many times the least, anywhere in [-1, 11) along every axis.
Spheres<dynamic> anywhere(int dimension, std::size_t count, double least, double ratio, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Spheres<dynamic> spheres(dimension);
  for (std::size_t i = 0; i < count; ++i) {
    Vector<dynamic> c(dimension);
    for (int k = 0; k < dimension; ++k) c[k] = 12 * random.uniform() - 1;
    spheres.push_back(c, least * std::pow(ratio, std::pow(random.uniform(), 4)));
  }
  return spheres;
}

Box box(int dimension, bool periodic) {
  const Vector<dynamic> size = Vector<dynamic>::Constant(dimension, 10);
  return {Vector<dynamic>::Zero(dimension), size,
          std::vector<bool>(static_cast<std::size_t>(dimension), periodic)};
}

TEST(SlabCertificate, SaysTheSameOfSpheresAnywhere) {
  for (const int dimension : {1, 2, 3, 5})
    for (const bool periodic : {false, true})
      for (const double ratio : {1.0, 3.0})
        expect_same_in_slabs(anywhere(dimension, 150,
                                      dimension < 3    ? 0.05
                                      : dimension == 3 ? 0.4
                                                       : 1.2,
                                      ratio, 7),
                             box(dimension, periodic));
}

// No boxes touch, so that only the closest pair is looked for, across slabs.
TEST(SlabCertificate, SaysTheSameOfSpheresFarApart) {
  for (const int dimension : {1, 2, 3, 5})
    for (const bool periodic : {false, true})
      for (const double gap : {0.0, 1e-4})
        expect_same_in_slabs(anywhere(dimension, 150, 1e-6, 10, 8), box(dimension, periodic), {.gap = gap});
}

TEST(SlabCertificate, SaysTheSameOfSizesFarApart) {
  for (const bool periodic : {false, true})
    expect_same_in_slabs(anywhere(3, 400, 0.03, 100, 3), box(3, periodic));
  Spheres<dynamic> one = anywhere(3, 300, 0.1, 1, 4);  // and one that every slab meets
  one.push_back(Vector<3>(0.1, 5, 5), 4.9);
  expect_same_in_slabs(one, box(3, true));
}

TEST(SlabCertificate, SaysTheSameOfGapsAndOfExactArithmetic) {
  const Spheres<dynamic> spheres = anywhere(3, 200, 0.3, 2, 5);
  expect_same_in_slabs(spheres, box(3, true), {.gap = 0.25});
  expect_same_in_slabs(spheres, box(3, false), {.gap = 0.1, .wall_gap = 0.5});
  expect_same_in_slabs(spheres, box(3, true), {.allowed_overlap = 0.3, .arithmetic = Arithmetic::exact});
}

TEST(SlabCertificate, SaysTheSameInEveryContainer) {
  const Spheres<dynamic> spheres = anywhere(3, 250, 0.3, 2, 6);
  expect_same_in_slabs(spheres, Cylinder{.base = {5, 5, 0}, .axis = {0, 0, 1}, .radius = 5, .height = 10});
  expect_same_in_slabs(
      spheres, Cylinder{.base = {5, 5, 0}, .axis = {0, 0, 1}, .radius = 5, .height = 10, .periodic = true});
  expect_same_in_slabs(spheres, Sphere{{5, 5, 5}, 5});
  expect_same_in_slabs(spheres, meshes::cube(0, 10));
}

// Touching spheres, all of them on the limits of slabs and of the period, and in one plane.
TEST(SlabCertificate, SaysTheSameOfALattice) {
  for (const double edge : {6.0, std::nextafter(6.0, 0.0)}) {
    Spheres<dynamic> lattice(3);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        for (int k = 0; k < 6; ++k) lattice.push_back(Vector<3>(i, j, k), 0.5);
    const Box six{Vector<3>::Zero(), Vector<3>::Constant(edge), std::vector<bool>(3, true)};
    expect_same_in_slabs(lattice, six);
    EXPECT_EQ(certify(lattice, six, {.at_once = 10}).certified, edge == 6);
  }
  Spheres<dynamic> plane(3), point(3);
  for (int i = 0; i < 50; ++i) plane.push_back(Vector<3>(3, 0.1 * i, 3), 0.06);
  for (int i = 0; i < 20; ++i) point.push_back(Vector<3>(3, 3, 3), 0.1 + 0.01 * i);
  expect_same_in_slabs(plane, box(3, true));
  expect_same_in_slabs(point, box(3, true));
  EXPECT_EQ(certify(point, box(3, true), {.at_once = 3}).overlapping_pairs, 190u);
}

TEST(SlabCertificate, FindsTheOnePairAcrossTheLimitOfTwoSlabs) {
  for (const double at : {0.0, 2.5, 5.0, 9.5}) {
    Spheres<dynamic> spheres(3);
    for (int i = 0; i < 10; ++i) spheres.push_back(Vector<3>(i, 5, 5), 0.45);
    spheres.push_back(Vector<3>(std::fmod(at + 0.6, 10.0), 5.6, 5), 0.3);
    const Certificate whole = certify(spheres, box(3, true));
    const Certificate slabs = certify(spheres, box(3, true), {.at_once = 2});
    EXPECT_FALSE(slabs.certified);
    expect_same(whole, slabs, 2);
  }
}

TEST(SlabCertificate, RefusesToLookAtNone) {
  EXPECT_THROW(certify(anywhere(3, 3, 0.1, 1, 1), box(3, true), {.at_once = 0}), Error);
}

TEST(SlabCertificate, StopsWhereItIsAsked) {
  const Spheres<dynamic> spheres = anywhere(3, 400, 0.4, 1, 2);
  int asked = 0;
  const Certificate stopped =
      certify(spheres, box(3, true), {.at_once = 20, .monitor = {{}, [&] { return ++asked > 3; }}});
  EXPECT_TRUE(stopped.cancelled);
  EXPECT_FALSE(stopped.certified);
  EXPECT_LT(stopped.pairs_tested, certify(spheres, box(3, true)).pairs_tested);
}

// What an interval of progress says grows to the end.
TEST(SlabCertificate, TellsHowFarItIs) {
  double last = 0;
  bool falls = false;
  const Spheres<dynamic> spheres = anywhere(3, 20000, 0.1, 1, 2);
  certify(spheres, box(3, true),
          {.at_once = 500,
           .monitor = {[&](const Progress& p) {
                         falls = falls || p.fraction < last - 0.01;
                         last = p.fraction;
                       },
                       {}}});
  EXPECT_FALSE(falls);
  EXPECT_GT(last, 0);
}

TEST(SlabCertificate, ReadsRowsThatAreSortedAFewTimes) {
  // Along y, although the box is longest along x: it is the order that tells what to cut across.
  constexpr std::size_t count = 20'000;
  Random random(3, stream(Stream::test));
  std::vector<Vector<3>> centers;
  const Domain domain = Box{Vector<3>::Zero().eval(), Vector<3>(300, 100, 50), {true, true, true}};
  for (std::size_t i = 0; i < count; ++i)
    centers.push_back(uniform_point(random, Bounds<3>{Vector<3>::Zero(), Vector<3>(300, 100, 50)}));
  std::ranges::sort(centers, {}, [](const Vector<3>& c) { return c[1]; });
  Spheres<dynamic> spheres(3);
  for (const Vector<3>& c : centers) spheres.push_back(c, 0.3);
  SphereRows rows = rows_of(spheres);
  std::size_t read = 0, most = 0;
  rows.read = [&, inner = rows.read](std::uint64_t first, std::span<double> values) {
    inner(first, values);
    read += values.size() / 4;
    most = std::max(most, values.size() / 4);
  };
  const Certificate whole = certify(spheres, domain), streamed = certify(rows, domain, {.at_once = 1000});
  expect_same(whole, streamed, 1000);
  EXPECT_LT(read, 8 * count);
  EXPECT_LE(most, 4096u) << "a piece";
}

TEST(SlabCertificate, SaysOfRowsWhichIsNoSphere) {
  Spheres<dynamic> spheres = anywhere(3, 5000, 0.1, 2, 1);
  spheres.r[4200] = 0;
  spheres.x[1][4300] = std::nan("");
  const Certificate whole = certify(spheres, box(3, true)), rows = certify(rows_of(spheres), box(3, true));
  EXPECT_FALSE(rows.certified);
  EXPECT_EQ(rows.statement, whole.statement);
  EXPECT_THROW(certify(rows_of(spheres), box(2, true)), Error);
  EXPECT_TRUE(certify(SphereRows{}, box(3, true)).certified) << "of none there is nothing to prove";
}

}  // namespace slab_certificate_test
}  // namespace bernal

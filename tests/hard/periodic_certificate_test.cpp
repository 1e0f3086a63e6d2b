#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/periodic_certificates.hpp"

namespace bernal {
namespace periodic_certificate_test {

using testing::expect_same_verdict;
using testing::expect_truth;
using testing::periodic_box;
using testing::rows;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

TEST(HardPeriodicCertificate, ScaleDoesNotMatter) {
  // Powers of ten are not exact, so every size is a new set of near-ties; far beyond 1e±75 squares leave the
  // range of double and exact arithmetic has to take over.
  for (const double scale : {1e-6, 1e6, 1e-100, 1e100, 1e-160, 1e160, 1e-300}) {
    SCOPED_TRACE(scale);
    Random random(3, stream(Stream::test));
    Spheres<dynamic> s(3);
    for (int i = 0; i < 10; ++i) {
      const Vector<3> c = uniform_point(random, Bounds<3>{{0, 0, 0}, {8, 8, 8}});
      s.push_back(scale * c, scale * random.uniform(0.1, 2.0));
    }
    s.push_back(scale * Vector<3>{1, 7, 1}, scale);
    s.push_back(scale * Vector<3>{1, 1, 1}, scale);
    s.push_back(scale * Vector<3>{7, 7, 1}, scale);
    expect_truth(s, bernal::periodic_box(Vector<3>::Constant(8 * scale)));
  }
}

TEST(HardPeriodicCertificate, EdgesAndRadiiOfWildlyDifferentSize) {
  expect_truth(rows({{0, 0, 1e-300}, {1e-290, 0, 1e-300}}), periodic_box({1e300, 1e-200}));
  expect_truth(rows({{0, 0, 1e-300}, {1e300, 1e-210, 1e-300}}), periodic_box({up(1e300), 1e-200}));
  EXPECT_FALSE(expect_truth(rows({{0.5, 0.5, 1e300}, {0.1, 0.1, 1e-300}}), periodic_box({1, 1})).certified);
  // The largest double as an edge, the smallest as a radius.
  constexpr double largest = std::numeric_limits<double>::max(),
                   least = std::numeric_limits<double>::denorm_min();
  EXPECT_TRUE(expect_truth(rows({{0, least}, {largest / 2, least}}), periodic_box({largest})).certified);
  EXPECT_TRUE(expect_truth(rows({{0, least}, {2 * least, least}}), periodic_box({4 * least})).certified);
  EXPECT_EQ(
      expect_truth(rows({{0, 2 * least}, {2 * least, least}}), periodic_box({5 * least})).overlapping_pairs,
      1u);
}

TEST(HardPeriodicCertificate, CentresFarAwayAreTakenModuloTheBoxWithoutRounding) {
  // 2^60 + 2^8 k is a double; modulo 3 it is 1 + k (2^60 = 4^30 and 2^8 = 4^4 are 1).
  const double far = 0x1p60;
  const Box box = periodic_box({3});
  EXPECT_TRUE(certify(rows({{far, 0.5}, {far + 0x1p8, 0.5}, {far + 0x1p9, 0.5}}), box).certified);
  EXPECT_EQ(certify(rows({{far, 0.5}, {far + 0x1p8, up(0.5)}, {far + 0x1p9, 0.5}}), box).overlapping_pairs,
            2u);
  // A double near 1e300 modulo 0.1: std::fmod is exact, and this is what it leaves.
  const double x = 1e300, rest = std::fmod(x, 0.1);
  const Spheres<dynamic> distant = rows({{x, 0.025}, {0, 0.01}}), near = rows({{rest, 0.025}, {0, 0.01}});
  expect_same_verdict(certify(distant, periodic_box({0.1})), certify(near, periodic_box({0.1})));
  expect_truth(near, periodic_box({0.1}));
}

TEST(HardPeriodicCertificate, JustOutsideOrOnTheFace) {
  const Box box = periodic_box({4, 4});
  for (const double x : {-5e-324, -0.0, 0.0, 4.0, down(4.0), up(4.0), 2.0, up(2.0), down(2.0), -2.0, 6.0}) {
    SCOPED_TRACE(x);
    for (const double r : {1.0, up(1.0), down(1.0)}) expect_truth(rows({{x, 1, r}, {2, 1, 1}}), box);
    for (const double r : {1.0, up(1.0), down(1.0)}) expect_truth(rows({{1, x, r}, {1, 0, 1}}), box);
  }
}

TEST(HardPeriodicCertificate, HalfAnEdgeApartIsATieOfImages) {
  // The two images on an axis are equally near, or differ by an ulp; the touch is exact.
  for (const double edge : {2.0, up(2.0), down(2.0), 3.0, 0.1})
    for (const double shift : {0.0, 0.25, 0.7}) {
      const double r = edge / 4;
      expect_truth(rows({{shift, 0, r}, {shift + edge / 2, 0, r}}), periodic_box({edge, 4 * edge}));
      expect_truth(rows({{shift, 0, up(r)}, {shift + edge / 2, 0, r}}), periodic_box({edge, 4 * edge}));
    }
}

TEST(HardPeriodicCertificate, BoxesSmallerThanTheSpheres) {
  Random random(6, stream(Stream::test));
  for (const double edge : {0.3, 0.9, 1.7, 2.0}) {
    Spheres<dynamic> s(2);
    for (int i = 0; i < 6; ++i) {
      const Vector<2> c = uniform_point(random, Bounds<2>{{0, 0}, {edge, 4}});
      s.push_back(c, random.uniform(0.2, 1));
    }
    expect_truth(s, periodic_box({edge, 4}));
    expect_truth(s, periodic_box({4, edge}), 0.5);
  }
}

TEST(HardPeriodicCertificate, AllCoincident) {
  Spheres<dynamic> s(3);
  for (int i = 0; i < 500; ++i) s.push_back(Vector<3>(0.1 + i, 0.2, 3.3 - 2 * i), 0.01);
  const Certificate c = certify(s, periodic_box({1, 1, 1}));
  EXPECT_EQ(c.pairs_tested, 499u * 500 / 2);
  EXPECT_EQ(c.overlapping_pairs, c.pairs_tested);
  EXPECT_GT(c.max_overlap, 1 - 1e-10);
}

TEST(HardPeriodicCertificate, ABoulderAcrossEveryFaceAndItsDust) {
  // One ball as wide as the box, and dust that touches it or its images from outside.
  Random random(5, stream(Stream::test));
  Spheres<dynamic> s(3);
  s.push_back(Vector<3>::Zero(), 0.5);
  for (int i = 0; i < 100; ++i) s.push_back(0.501 * uniform_direction<3>(random), 0.001);
  const Box box = periodic_box({1, 1, 1});
  const Certificate c = certify(s, box);
  std::uint64_t overlapping = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      const oracle::Rational reach = oracle::Rational(s.r[i]) + oracle::Rational(s.r[j]);
      overlapping += oracle::least_squared_distance(s, i, j, box.size) < reach * reach ? 1 : 0;
    }
  EXPECT_EQ(c.overlapping_pairs, overlapping);
  EXPECT_GT(overlapping, 20u);
  EXPECT_GT(c.decided_exact, 50u);
}

}  // namespace periodic_certificate_test
}  // namespace bernal

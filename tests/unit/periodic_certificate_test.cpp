#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "bernal/verify/certificate.hpp"
#include "support/periodic_certificates.hpp"

namespace bernal {
namespace periodic_certificate_test {

using testing::expect_truth;
using testing::periodic_box;
using testing::rows;

double up(double x) { return std::nextafter(x, std::numeric_limits<double>::infinity()); }
double down(double x) { return std::nextafter(x, -std::numeric_limits<double>::infinity()); }

TEST(PeriodicCertificate, OfNothingIsTrue) {
  const Certificate c = expect_truth(Spheres<2>(), periodic_box({1, 2}));
  EXPECT_TRUE(c.certified);
  EXPECT_EQ(c.statement, "Certified: there are no discs.");
}

TEST(PeriodicCertificate, ALatticeTouchesItselfAcrossEveryFace) {
  // 3 x 3 x 3 unit spheres: each has six neighbours, no sphere being its own.
  Spheres<dynamic> lattice(3);
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) lattice.push_back(Vector<3>(2 * x, 2 * y, 2 * z), 1);
  const Certificate touching = expect_truth(lattice, periodic_box({6, 6, 6}));
  EXPECT_TRUE(touching.certified);
  EXPECT_EQ(touching.max_overlap, 0);
  EXPECT_EQ(touching.worst_wall, std::nullopt);
  // Nine pairs touch across each face.
  EXPECT_EQ(expect_truth(lattice, periodic_box({6, down(6), 6})).overlapping_pairs, 9u);
  lattice.r[13] = up(1);
  EXPECT_EQ(expect_truth(lattice, periodic_box({6, 6, 6})).overlapping_pairs, 6u);
}

TEST(PeriodicCertificate, DecidesTouchesAcrossCornersByAnUlp) {
  // Across the corner of the box the offsets are 2, 3 and 6, the distance 7.
  const Spheres<dynamic> pair = rows({{1, 1, 2, 3}, {19, 28, 36, 4}});
  const Box box = periodic_box({20, 30, 40});
  EXPECT_TRUE(expect_truth(pair, box).certified);
  for (const std::size_t i : {0, 1}) {
    Spheres<dynamic> swollen = pair;
    swollen.r[i] = up(swollen.r[i]);
    const Certificate c = expect_truth(swollen, box);
    EXPECT_EQ(c.overlapping_pairs, 1u);
    EXPECT_EQ(c.worst_pair, (std::array<std::uint64_t, 2>{0, 1}));
    EXPECT_GT(c.max_overlap, 0);
    swollen.r[i] = down(pair.r[i]);
    EXPECT_TRUE(expect_truth(swollen, box).certified);
  }
  for (const std::size_t k : {0, 1, 2}) {
    Spheres<dynamic> moved = pair;
    moved.x[k][0] = down(pair.x[k][0]);
    EXPECT_FALSE(expect_truth(moved, box).certified) << k;
    moved.x[k][0] = up(pair.x[k][0]);
    EXPECT_TRUE(expect_truth(moved, box).certified) << k;
    Box other = box;
    other.size[static_cast<int>(k)] = down(box.size[static_cast<int>(k)]);
    EXPECT_FALSE(expect_truth(pair, other).certified) << k;
  }
}

TEST(PeriodicCertificate, TouchesInEveryDimension) {
  // Half of the squares of the offsets make up a square in each: 1; 3, 4; 2, 3, 6; 1, 1, 1, 1; and so on.
  const std::vector<std::pair<std::vector<double>, double>> offsets = {{{3}, 3},
                                                                       {{3, 4}, 5},
                                                                       {{2, 3, 6}, 7},
                                                                       {{1, 1, 1, 1}, 2},
                                                                       {{1, 1, 1, 2, 3}, 4},
                                                                       {{1, 1, 1, 1, 4, 4}, 6},
                                                                       {{1, 1, 1, 1, 1, 2, 4}, 5},
                                                                       {{1, 1, 1, 1, 1, 1, 1, 3}, 4}};
  for (const auto& [offset, d] : offsets) {
    const int dimension = static_cast<int>(offset.size());
    Spheres<dynamic> pair(dimension);
    pair.push_back(Vector<dynamic>::Zero(dimension), 0.25 * d);
    pair.push_back(Vector<dynamic>::Constant(dimension, 20) -
                       Eigen::Map<const Eigen::VectorXd>(offset.data(), dimension),
                   0.75 * d);
    const Box box = bernal::periodic_box(Vector<dynamic>::Constant(dimension, 20));
    const Certificate touching = expect_truth(pair, box);
    EXPECT_TRUE(touching.certified);
    EXPECT_EQ(touching.max_overlap, 0);
    pair.x.back()[1] = up(pair.x.back()[1]);
    EXPECT_EQ(expect_truth(pair, box).overlapping_pairs, 1u) << dimension;
  }
}

TEST(PeriodicCertificate, ASphereMayTouchItsOwnImageAndNoMore) {
  const Certificate touching = expect_truth(rows({{0.5, 1, 1}}), periodic_box({2, 3}));
  EXPECT_TRUE(touching.certified);
  EXPECT_EQ(
      touching.statement,
      "Certified: 1 disc in a periodic box, 1 near pair decided exactly, no overlap; closest pair gap 0 of "
      "the sum of radii.");
  EXPECT_EQ(touching.worst_pair, (std::array<std::uint64_t, 2>{0, 0}));

  const Certificate overlapping = expect_truth(rows({{0.5, 1, 1.25}}), periodic_box({2, 3}));
  EXPECT_FALSE(overlapping.certified);
  EXPECT_EQ(overlapping.statement,
            "Not certified: 1 overlapping pair (worst 0 and its own image, overlap ratio 0.2).");
  EXPECT_FALSE(expect_truth(rows({{0.5, 1, up(1)}}), periodic_box({2, 3})).certified);
  EXPECT_FALSE(expect_truth(rows({{0.5, 1, 1}}), periodic_box({3, down(2)})).certified);
  EXPECT_EQ(expect_truth(rows({{0.5, 1, down(1)}}), periodic_box({2, 3})).pairs_tested, 0u);
}

TEST(PeriodicCertificate, APairCountsOnceHoweverManyImagesMeet) {
  // Half an edge apart on both axes: four images of either at the same distance. Then a box within a sphere.
  const Box box = periodic_box({2, 2});
  EXPECT_EQ(expect_truth(rows({{0, 0, 0.5}, {1, 1, 0.95}}), box).overlapping_pairs, 1u);
  EXPECT_TRUE(expect_truth(rows({{0, 0, 0.5}, {1, 1, 0.875}}), box).certified);
  EXPECT_EQ(expect_truth(rows({{0, 0, 0.5}, {1, 1, 40}, {0.5, 1.75, 0.01}}), box).overlapping_pairs, 3u);
}

TEST(PeriodicCertificate, CentresStandForTheirImagesInTheBox) {
  const Box box = periodic_box({20, 30, 40});
  for (const double n : {-1.0, 1.0, 3.0, -1024.0, 0x1p40}) {
    const Spheres<dynamic> pair = rows({{1 + 20 * n, 1, 2, 3}, {19, 28 - 60 * n, 36 + 40 * n, 4}});
    EXPECT_TRUE(expect_truth(pair, box, 0, std::abs(n) <= 3).certified) << n;
    Spheres<dynamic> closer = pair;
    closer.r[0] = up(3);
    EXPECT_EQ(expect_truth(closer, box, 0, std::abs(n) <= 3).overlapping_pairs, 1u) << n;
  }
}

TEST(PeriodicCertificate, AllowedOverlapIsARatioOfTheSumOfRadii) {
  // Distance 1.5 across a face, sum of radii 2; then an edge of 1.5 and a diameter of 2.
  const Spheres<dynamic> pair = rows({{0.5, 5, 1}, {9, 5, 1}});
  for (const auto& [spheres, box] :
       {std::pair(pair, periodic_box({10, 10})), std::pair(rows({{0, 0, 1}}), periodic_box({1.5, 10}))}) {
    EXPECT_FALSE(expect_truth(spheres, box).certified);
    EXPECT_FALSE(expect_truth(spheres, box, down(0.25)).certified);
    const Certificate c = expect_truth(spheres, box, 0.25);
    EXPECT_TRUE(c.certified);
    EXPECT_DOUBLE_EQ(c.max_overlap, 0.25);
    EXPECT_TRUE(c.statement.ends_with("no overlap above 0.25; largest overlap 0.25 of the sum of radii."))
        << c.statement;
  }
}

TEST(PeriodicCertificate, RefusesBoxesAndSpheresThatAreNone) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Spheres<dynamic> one = rows({{0.5, 0.5, 0.1}});
  for (const double edge : {0.0, -1.0, infinity, std::nan("")})
    EXPECT_THROW(certify(one, periodic_box({1, edge})), Error) << edge;
  EXPECT_THROW(certify(one, periodic_box({1, 1, 1})), Error);
  EXPECT_THROW(certify(one, periodic_box({})), Error);
  for (const auto& [x, r] :
       {std::pair(0.5, 0.0), {0.5, -1.0}, {infinity, 0.1}, {std::nan(""), 0.1}, {0.5, infinity}}) {
    const Certificate c = certify(rows({{0.5, 0.5, 0.1}, {0.2, x, r}}), periodic_box({1, 1}));
    EXPECT_FALSE(c.certified);
    EXPECT_NE(c.statement.find("first: sphere 1 at 0.2, "), std::string::npos) << c.statement;
  }
}

// ---- Against the oracle, and laws

class PeriodicCertificateLaw : public ::testing::TestWithParam<int> {
 protected:
  int dimension() const { return GetParam(); }
  /// Few enough that the oracle can afford all images of all pairs.
  std::size_t spheres() const { return dimension() <= 3 ? 14 : dimension() == 4 ? 9 : 4; }
};

INSTANTIATE_TEST_SUITE_P(Dimensions, PeriodicCertificateLaw, ::testing::Values(1, 2, 3, 4, 8),
                         [](const auto& test) { return "D" + std::to_string(test.param); });

TEST_P(PeriodicCertificateLaw, AgreesWithTheOracleOnRandomPackings) {
  std::uint64_t overlapping = 0, near = 0;
  const std::uint64_t seeds = dimension() <= 3 ? 12 : dimension() == 4 ? 6 : 4;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Random random(seed, stream(Stream::test));
    // On a lattice faces, ties and touches are met exactly; seeds divisible by three are anywhere. Even seeds
    // are in boxes that are as small as the spheres, and seeds divisible by four have a number nudged by an
    // ulp.
    const bool lattice = seed % 3 != 0;
    const double edge = seed % 2 == 0 ? 2 : 8;
    Box box = bernal::periodic_box(Vector<dynamic>::Zero(dimension()));
    for (int k = 0; k < dimension(); ++k) box.size[k] = edge + (lattice ? 0.5 * (k % 3) : random.uniform());
    Spheres<dynamic> s(dimension());
    for (std::size_t i = 0; i < spheres(); ++i) {
      Vector<dynamic> c(dimension());
      for (int k = 0; k < dimension(); ++k) {
        c[k] = random.uniform(0, box.size[k]);
        if (dimension() <= 3 && i % 4 == 0) c[k] += box.size[k] * std::floor(random.uniform(-2, 2));
        if (lattice) c[k] = std::round(4 * c[k]) / 4;
      }
      double r = dimension() < 8 ? random.uniform(0.05, edge / 4) : random.uniform(edge / 4, edge / 2);
      if (i == 0 && seed % 5 == 0) r = 0.6 * edge;
      s.push_back(c, lattice ? std::max(0.125, std::round(8 * r) / 8) : r);
    }
    if (seed % 4 == 0) {
      s.r[1] = up(s.r[1]);
      s.x[0][2] = down(s.x[0][2]);
    }
    const Certificate c = expect_truth(s, box);
    overlapping += c.overlapping_pairs;
    near += c.pairs_tested;
    expect_truth(s, box, 0.25);
  }
  EXPECT_GT(overlapping, 0u);
  EXPECT_GT(near, overlapping);
}

TEST_P(PeriodicCertificateLaw, CatchesAPairPushedIntoOverlapByAnUlp) {
  // Two spheres grow until they touch in double; then the oracle says which ulp is the last that is allowed.
  Random random(21, stream(Stream::test));
  const Box box = bernal::periodic_box(Vector<dynamic>::Constant(dimension(), 1.0));
  for (int trial = 0; trial < (dimension() < 8 ? 4 : 1); ++trial) {
    Spheres<dynamic> s(dimension());
    double squared = 0;
    Vector<dynamic> a(dimension()), b(dimension());
    for (int k = 0; k < dimension(); ++k) {  // on both sides of the face
      a[k] = random.uniform(0, 0.1);
      b[k] = random.uniform(0.9, 1);
      squared += (1 - b[k] + a[k]) * (1 - b[k] + a[k]);
    }
    s.push_back(a, 0.5 * std::sqrt(squared));
    s.push_back(b, 0.5 * std::sqrt(squared));
    bool before = false, after = true;
    for (int ulps = 0; ulps < 8; ++ulps) s.r[0] = down(s.r[0]);
    for (int ulps = -8; ulps < 8; ++ulps) {
      const bool certified = expect_truth(s, box).certified;
      if (ulps == -8) before = certified;
      after = certified;
      s.r[0] = up(s.r[0]);
    }
    EXPECT_TRUE(before);
    EXPECT_FALSE(after);
  }
}

struct Sample {
  Spheres<dynamic> spheres;
  Box box;
};

/// On a lattice, so that translations are exact.
Sample sample(int dimension, std::size_t n, std::uint64_t seed) {
  Random random(seed, stream(Stream::test));
  Sample sample{Spheres<dynamic>(dimension), bernal::periodic_box(Vector<dynamic>::Zero(dimension))};
  for (int k = 0; k < dimension; ++k) sample.box.size[k] = 4 + 0.5 * k;
  for (std::size_t i = 0; i < n; ++i) {
    Vector<dynamic> c(dimension);
    for (int k = 0; k < dimension; ++k) c[k] = std::floor(random.uniform(0, 64 * sample.box.size[k])) / 64;
    sample.spheres.push_back(c, std::round(random.uniform(1, 40)) / (dimension < 8 ? 64 : 32));
  }
  return sample;
}

void expect_same_counts(const Certificate& a, const Certificate& b) {
  EXPECT_EQ(a.certified, b.certified);
  EXPECT_EQ(a.overlapping_pairs, b.overlapping_pairs);
  EXPECT_NEAR(a.max_overlap, b.max_overlap, 1e-14);
}

TEST_P(PeriodicCertificateLaw, HasNoPlaceAndNoAxisOfItsOwn) {
  const auto [s, box] = sample(dimension(), 300, 4);
  const Certificate c = certify(s, box);
  EXPECT_GT(c.overlapping_pairs, 0u);

  Spheres<dynamic> images = s, moved = s;
  for (std::size_t k = 0; k < s.x.size(); ++k)
    for (std::size_t i = 0; i < s.size(); ++i) {
      images.x[k][i] += box.size[static_cast<int>(k)] * (static_cast<double>((i + k) % 7) - 3);
      moved.x[k][i] += 1.625 + static_cast<double>(k);
    }
  const Certificate of_images = certify(images, box);
  expect_same_counts(c, of_images);
  EXPECT_EQ(of_images.max_overlap, c.max_overlap);
  expect_same_counts(c, certify(moved, box));

  Spheres<dynamic> turned = s;
  Box turned_box = box;
  std::ranges::reverse(turned.x);
  turned_box.size.reverseInPlace();
  expect_same_counts(c, certify(turned, turned_box));
}

TEST_P(PeriodicCertificateLaw, ScalesByPowersOfTwo) {
  auto [s, box] = sample(dimension(), 300, 5);
  const Certificate c = certify(s, box);
  for (const double factor : {0x1p30, 0x1p-90}) {
    for (auto& column : s.x)
      for (double& x : column) x *= factor;
    for (double& r : s.r) r *= factor;
    box.size *= factor;
    testing::expect_same_verdict(certify(s, box), c);
  }
}

TEST_P(PeriodicCertificateLaw, DoesNotDependOnTheNumberOfThreads) {
  const auto [s, box] = sample(dimension(), 3000, 6);
  const auto with_threads = [&](int n) {
    return tbb::task_arena(n).execute([&] { return certify(s, box); });
  };
  const Certificate one = with_threads(1), two = with_threads(2);
  testing::expect_same_verdict(one, two);
  EXPECT_EQ(one.decided_exact, two.decided_exact);
}

TEST_P(PeriodicCertificateLaw, FindsEveryNearPair) {
  // Against all pairs in double with a margin for the outward rounding; sizes 1:1000, clusters at a corner.
  Random random(8, stream(Stream::test));
  const Box box = bernal::periodic_box(Vector<dynamic>::Constant(dimension(), 3.0));
  Spheres<dynamic> s(dimension());
  for (int i = 0; i < 1500; ++i) {
    Vector<dynamic> c(dimension());
    for (int k = 0; k < dimension(); ++k)
      c[k] = i % 3 == 0 ? random.uniform(-0.05, 0.05) : random.uniform(0, 3);
    s.push_back(c, std::pow(10.0, -3 * random.uniform()));
  }
  std::uint64_t certain = 0, possible = 0;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (std::size_t j = i + 1; j < s.size(); ++j) {
      double gap = -1e300;
      for (const auto& x : s.x) {
        const double d = std::abs(std::remainder(x[i] - x[j], 3.0));
        gap = std::max(gap, d - (s.r[i] + s.r[j]));
      }
      certain += gap < -1e-14 ? 1 : 0;
      possible += gap < 1e-14 ? 1 : 0;
    }
  const Certificate c = certify(s, box);
  EXPECT_GE(c.pairs_tested, certain);
  EXPECT_LE(c.pairs_tested, possible);
  EXPECT_GT(certain, 10'000u);
}

TEST(PeriodicCertificate, FarFromTheFacesIsTheSameAsInAContainer) {
  Random random(9, stream(Stream::test));
  Spheres<dynamic> s(3);
  for (int i = 0; i < 2000; ++i)
    s.push_back(uniform_point(random, Bounds<3>{{10, 10, 10}, {20, 20, 20}}), random.uniform(0.05, 0.5));
  const Certificate periodic = certify(s, periodic_box({30, 30, 30}));
  const Certificate open = certify(s, Box{.size = {30, 30, 30}});
  EXPECT_EQ(periodic.pairs_tested, open.pairs_tested);
  EXPECT_EQ(periodic.overlapping_pairs, open.overlapping_pairs);
  EXPECT_EQ(periodic.worst_pair, open.worst_pair);
}

}  // namespace periodic_certificate_test
}  // namespace bernal

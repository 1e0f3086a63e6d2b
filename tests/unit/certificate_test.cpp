#include "bernal/verify/certificate.hpp"

#include <cmath>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "support/integer_meshes.hpp"
#include "support/packing_oracle.hpp"

namespace bernal {
namespace certificate_test {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Spheres<3> spheres(std::initializer_list<std::array<double, 4>> rows) {
  Spheres<3> result;
  for (const auto& row : rows) result.push_back({row[0], row[1], row[2]}, row[3]);
  return result;
}

void expect_same_verdict(const Certificate& a, const Certificate& b) {
  EXPECT_EQ(a.certified, b.certified);
  EXPECT_EQ(a.pairs_tested, b.pairs_tested);
  EXPECT_EQ(a.walls_tested, b.walls_tested);
  EXPECT_EQ(a.centers_tested, b.centers_tested);
  EXPECT_EQ(a.overlapping_pairs, b.overlapping_pairs);
  EXPECT_EQ(a.protruding_spheres, b.protruding_spheres);
  EXPECT_EQ(a.worst_pair, b.worst_pair);
  EXPECT_EQ(a.max_overlap, b.max_overlap);
  EXPECT_EQ(a.worst_wall, b.worst_wall);
  EXPECT_EQ(a.min_wall_gap, b.min_wall_gap);
  EXPECT_EQ(a.statement, b.statement);
}

/// The law of this file: whatever the packing, the certificate says what the oracle says, in both
/// arithmetics.
Certificate expect_truth(const Spheres<3>& s, const Domain& shape, double allowed = 0) {
  const Certificate filtered =
      certify(s, shape, {.allowed_overlap = allowed, .arithmetic = Arithmetic::filtered});
  const Certificate exact = certify(s, shape, {.allowed_overlap = allowed, .arithmetic = Arithmetic::exact});
  expect_same_verdict(filtered, exact);
  EXPECT_EQ(exact.decided_double, 0u);
  for (const Certificate& c : {filtered, exact})
    EXPECT_EQ(c.decided_double + c.decided_exact, c.pairs_tested + c.walls_tested + c.centers_tested);

  const oracle::Verdict truth = oracle::judge(s, shape, allowed);
  EXPECT_EQ(filtered.overlapping_pairs, truth.overlapping);
  EXPECT_EQ(filtered.protruding_spheres, truth.protruding);
  EXPECT_EQ(filtered.certified, truth.overlapping == 0 && truth.protruding == 0);
  EXPECT_GE(filtered.pairs_tested, truth.near_at_least);
  EXPECT_LE(filtered.pairs_tested, truth.near_at_most);
  EXPECT_EQ(filtered.min_wall_gap<0, truth.protruding> 0);
  EXPECT_EQ(filtered.worst_pair.has_value(), s.size() > 1);
  if (filtered.worst_pair) {
    EXPECT_NEAR(filtered.max_overlap, truth.max_overlap, 1e-13 * (1 + std::abs(truth.max_overlap)));
    const auto [first, second] = *filtered.worst_pair;
    EXPECT_LT(first, second);
    EXPECT_EQ(filtered.max_overlap > 0, oracle::overlap(s, first, second));
  }
  return filtered;
}

TEST(Certificate, OfNothingIsTrue) {
  const Certificate c = expect_truth({}, Box{});
  EXPECT_TRUE(c.certified);
  EXPECT_EQ(c.statement, "Certified: there are no spheres.");
}

TEST(Certificate, AllowsTouchingAndNothingMore) {
  // Integer lattice: every gap, to neighbours and to the walls, is exactly zero.
  Spheres<3> lattice;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 3; ++z) lattice.push_back({2.0 * x + 1, 2.0 * y + 1, 2.0 * z + 1}, 1);
  Box box{.corner = {0, 0, 0}, .size = {6, 6, 6}};
  const Certificate touching = expect_truth(lattice, box);
  EXPECT_TRUE(touching.certified);
  EXPECT_EQ(touching.max_overlap, 0);
  EXPECT_EQ(touching.min_wall_gap, 0);

  // One unit in the last place of one radius breaks it: 3 to 6 neighbours and 0 to 3 walls of that sphere.
  Spheres<3> swollen = lattice;
  swollen.r[0] = std::nextafter(1.0, 2.0);
  const Certificate broken = expect_truth(swollen, box);
  EXPECT_EQ(broken.overlapping_pairs, 3u);
  EXPECT_EQ(broken.protruding_spheres, 1u);
  EXPECT_EQ(broken.worst_pair->at(0), 0u);
  EXPECT_EQ(broken.worst_wall, 0u);

  box.size[2] = std::nextafter(6.0, 0.0);
  EXPECT_EQ(expect_truth(lattice, box).protruding_spheres, 9u);
}

TEST(Certificate, DecidesObliqueTouchesByAnUlp) {
  // Pythagorean quadruples: |(2, 3, 6)| = 7, |(1, 4, 8)| = 9, |(4, 4, 7)| = 9, |(12, 15, 16)| = 25.
  const Sphere room{.center = {0, 0, 0}, .radius = 100};
  for (const auto& [x, y, z, d] :
       {std::array{2., 3., 6., 7.}, {1., 4., 8., 9.}, {4., 4., 7., 9.}, {12., 15., 16., 25.}}) {
    const double r = 0.375 * d;
    Spheres<3> pair = spheres({{0, 0, 0, d - r}, {x, y, z, r}});
    EXPECT_TRUE(expect_truth(pair, room).certified);
    pair.r[1] = std::nextafter(r, 100.0);
    EXPECT_EQ(expect_truth(pair, room).overlapping_pairs, 1u);
    pair.r[1] = std::nextafter(r, 0.0);
    EXPECT_TRUE(expect_truth(pair, room).certified);

    const Spheres<3> one = spheres({{x, y, z, 1}});
    EXPECT_TRUE(expect_truth(one, Sphere{.center = {0, 0, 0}, .radius = d + 1}).certified);
    EXPECT_FALSE(
        expect_truth(one, Sphere{.center = {0, 0, 0}, .radius = std::nextafter(d + 1, 0.0)}).certified);
  }
}

TEST(Certificate, CylinderWallsAreDecidedWithoutARoot) {
  // Axis (2, 3, 6) of length 7, base at its foot: the centre 2a is 14 up; (6, 2, -3) is across the axis,
  // also 7.
  const Vector<3> axis{2, 3, 6}, across{6, 2, -3};
  const Cylinder cylinder{.base = {5, -3, 1}, .axis = axis, .radius = 10, .height = 28};
  const auto certified = [&](const Vector<3>& at, double r, const Cylinder& c) {
    Spheres<3> one;
    one.push_back(c.base + at, r);
    return expect_truth(one, c).certified;
  };
  const auto up = [](double r) { return std::nextafter(r, infinity); };
  EXPECT_TRUE(certified(axis, 7, cylinder));  // rests on the base
  EXPECT_FALSE(certified(axis, up(7), cylinder));
  EXPECT_TRUE(certified(3 * axis, 7, cylinder));  // touches the top
  EXPECT_FALSE(certified(3 * axis, up(7), cylinder));
  EXPECT_TRUE(certified(2 * axis + across, 3, cylinder));  // touches the side
  EXPECT_FALSE(certified(2 * axis + across, up(3), cylinder));
  EXPECT_FALSE(certified(-axis, 1, cylinder));
  EXPECT_FALSE(certified(5 * axis, 1, cylinder));
  EXPECT_FALSE(certified(2 * axis, 11, cylinder));
  EXPECT_FALSE(certified(2 * axis, 40, cylinder));
  // The length of the axis is no measure of the cylinder.
  Cylinder scaled = cylinder;
  scaled.axis *= 0x1p-40;
  EXPECT_TRUE(certified(2 * axis + across, 3, scaled));
  EXPECT_FALSE(certified(2 * axis + across, up(3), scaled));
}

TEST(Certificate, RefusesSpheresThatAreNone) {
  const Box box{.corner = {0, 0, 0}, .size = {10, 10, 10}};
  for (const auto& bad : {std::array{5., 5., 5., 0.},
                          {5., 5., 5., -1.},
                          {5., 5., 5., nan},
                          {5., 5., 5., infinity},
                          {nan, 5., 5., 1.},
                          {5., -infinity, 5., 1.}}) {
    const Certificate c = certify(spheres({{1, 1, 1, 1}, {3, 1, 1, 1}, bad}), box);
    EXPECT_FALSE(c.certified);
    EXPECT_NE(c.statement.find("first: sphere 2 at"), std::string::npos) << c.statement;
  }
}

TEST(Certificate, RefusesContainersThatAreNone) {
  const Spheres<3> one = spheres({{5, 5, 5, 1}});
  EXPECT_THROW(certify(one, Box{.corner = {0, 0, 0}, .size = {10, 0, 10}}), Error);
  EXPECT_THROW(certify(one, Box{.corner = {0, 0, 0}, .size = {10, nan, 10}}), Error);
  EXPECT_THROW(certify(one, Sphere{.center = {0, 0, 0}, .radius = -1}), Error);
  EXPECT_THROW(certify(one, Cylinder{.axis = {0, 0, 0}}), Error);
  EXPECT_THROW(certify(one, Mesh{}), Error);

  Mesh open = meshes::cube();
  open.triangles.pop_back();
  EXPECT_THROW(certify(one, open), Error);
  Mesh twisted = meshes::cube();
  std::swap(twisted.triangles[0][0], twisted.triangles[0][1]);
  EXPECT_THROW(certify(one, twisted), Error);
  Mesh wild = meshes::cube();
  wild.triangles[0][0] = 99;
  EXPECT_THROW(certify(one, wild), Error);
  Mesh lost = meshes::cube();
  lost.vertices[0][0] = nan;
  EXPECT_THROW(certify(one, lost), Error);
  EXPECT_THROW(certify(one, Box{}, {.allowed_overlap = -1e-3}), Error);
  EXPECT_THROW(certify(one, Box{}, {.allowed_overlap = nan}), Error);
  // A container has three dimensions.
  EXPECT_THROW(certify(Spheres<2>(), Box{}), Error);
  EXPECT_THROW(certify(Spheres<4>(), Sphere{}), Error);
}

TEST(Certificate, WeldsATriangleSoup) {
  const Mesh cube = meshes::cube();
  Mesh soup;
  for (const auto& t : cube.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(cube.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(expect_truth(spheres({{4, 4, 4, 4}}), soup).certified);
}

TEST(Certificate, AllowedOverlapIsARatioOfTheSumOfRadii) {
  const Box box{.corner = {0, 0, 0}, .size = {10, 10, 10}};
  const Spheres<3> pair = spheres({{2, 5, 5, 1}, {3.5, 5, 5, 1}});  // d = 1.5 = (1 - 0.25) 2
  EXPECT_FALSE(expect_truth(pair, box).certified);
  EXPECT_FALSE(expect_truth(pair, box, std::nextafter(0.25, 0.0)).certified);
  const Certificate c = expect_truth(pair, box, 0.25);
  EXPECT_TRUE(c.certified);
  EXPECT_DOUBLE_EQ(c.max_overlap, 0.25);
}

TEST(Certificate, SaysOneSentence) {
  const Box box{.corner = {0, 0, 0}, .size = {10, 10, 10}};
  EXPECT_EQ(certify(spheres({{2, 5, 5, 1}, {4.5, 5, 5, 1}, {5.5, 8, 8, 0.5}}), box).statement,
            "Certified: 3 spheres, 0 near pairs and 18 walls decided exactly, no overlap, no protrusion; "
            "closest pair gap 0.25 of the sum of radii.");
  EXPECT_EQ(certify(spheres({{2, 5, 5, 1}, {3.75, 6.75, 5, 1}}), box).statement,
            "Certified: 2 spheres, 1 near pair and 12 walls decided exactly, no overlap, no protrusion; "
            "closest pair "
            "gap 0.24 of the sum of radii.");
  EXPECT_EQ(
      certify(spheres({{2, 5, 5, 1}, {3.5, 5, 5, 1}, {9.5, 8, 8, 1}}), box).statement,
      "Not certified: 1 overlapping pair (worst 0 and 1, overlap ratio 0.25), 1 sphere across or outside the "
      "wall (worst 2, gap -0.5 of its radius).");
}

/// Random packings in every container that the oracle can afford, with planted touches, overlaps and strays.
struct Case {
  std::string name;
  Domain shape;
  Vector<3> lower, upper;  // where centres are drawn

  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

std::vector<Case> cases() {
  const Vector<3> low{-0.5, -0.5, -0.5}, high{8.5, 8.5, 8.5};
  return {{"box", Box{.corner = {0, 0, 0}, .size = {8, 8, 8}}, low, high},
          {"sphere", Sphere{.center = {4, 4, 4}, .radius = 4}, low, high},
          {"cylinder", Cylinder{.base = {4, 4, 0}, .axis = {0, 0, 3}, .radius = 4, .height = 8}, low, high},
          {"oblique_cylinder", Cylinder{.base = {2, 1, 0}, .axis = {2, 3, 6}, .radius = 3, .height = 7}, low,
           high},
          {"tetrahedron", meshes::tetrahedron(), low, {5, 5, 5}},
          {"cube", meshes::cube(), low, high},
          {"l_shape", meshes::l_shape(), low, high},
          {"cube_with_cavity", meshes::cube_with_cavity(), low, high},
          {"inside_out_cube", meshes::flipped(meshes::cube()), low, high},
          {"prism", meshes::moved(meshes::regular_prism(7, 4, 8), 1, {4, 4, 0}), low, high}};
}

class CertificateLaw : public ::testing::TestWithParam<Case> {};

TEST_P(CertificateLaw, AgreesWithTheOracleOnRandomPackings) {
  const auto& [name, shape, lower, upper] = GetParam();
  std::uint64_t inside = 0, protruding = 0, overlapping = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed, stream(Stream::test));
    Spheres<3> s;
    // Centres on a coarse lattice, so that rays, faces, edges and neighbours are met exactly; then anywhere.
    const double lattice = seed % 3 == 0 ? 0 : (seed % 3 == 1 ? 1 : 0.25);
    for (int i = 0; i < 25; ++i) {
      Vector<3> c = uniform_point(random, Bounds<3>{lower, upper});
      double r = std::exp(random.uniform(std::log(0.01), std::log(1.2)));
      if (lattice > 0) {
        c = (c / lattice).array().round() * lattice;
        r = std::max(lattice / 4, std::round(4 * r / lattice) * lattice / 4);
      }
      s.push_back(c, r);
    }
    const Certificate c = expect_truth(s, shape);
    protruding += c.protruding_spheres;
    inside += s.size() - c.protruding_spheres;
    overlapping += c.overlapping_pairs;
  }
  EXPECT_GT(protruding, 0u);
  EXPECT_GT(overlapping, 0u);
  EXPECT_EQ(inside > 0, name != "inside_out_cube");
}

TEST_P(CertificateLaw, DoesNotDependOnTheNumberOfThreads) {
  const auto& [name, shape, lower, upper] = GetParam();
  Random random(7, stream(Stream::test));
  Spheres<3> s;
  for (int i = 0; i < 4000; ++i)
    s.push_back(uniform_point(random, Bounds<3>{lower, upper}), std::exp(random.uniform(-6.0, -1.0)));
  const auto with_threads = [&](int n) {
    return tbb::task_arena(n).execute([&] { return certify(s, shape); });
  };
  const Certificate one = with_threads(1), two = with_threads(2);
  expect_same_verdict(one, two);
  EXPECT_EQ(one.decided_exact, two.decided_exact);
}

INSTANTIATE_TEST_SUITE_P(Containers, CertificateLaw, ::testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

TEST(Certificate, FindsEveryNearPair) {
  // Against all pairs in double with a margin for the outward rounding; sizes 1:1000, clusters, far off.
  for (const double offset : {0.0, 1e4, -1e8}) {
    Random random(11, stream(Stream::test));
    Spheres<3> s;
    for (int i = 0; i < 3000; ++i) {
      const double r = std::pow(10.0, -3 * random.uniform());
      const double spread = i % 3 == 0 ? 0.01 : 20;
      Vector<3> c =
          uniform_point(random, Bounds<3>{Vector<3>::Constant(-spread), Vector<3>::Constant(spread)});
      s.push_back(c + Vector<3>::Constant(offset), r);
    }
    std::uint64_t certain = 0, possible = 0;
    for (std::size_t i = 0; i < s.size(); ++i)
      for (std::size_t j = i + 1; j < s.size(); ++j) {
        double gap = -infinity;
        for (int k = 0; k < 3; ++k) gap = std::max(gap, std::abs(s.x[k][i] - s.x[k][j]) - (s.r[i] + s.r[j]));
        const double margin = 8 * 0x1p-52 * (std::abs(offset) + 30);
        certain += gap < -margin ? 1 : 0;
        possible += gap < margin ? 1 : 0;
      }
    const Certificate c = certify(s, Box{.corner = {-2e8, -2e8, -2e8}, .size = {4e8, 4e8, 4e8}});
    EXPECT_GE(c.pairs_tested, certain);
    EXPECT_LE(c.pairs_tested, possible);
    EXPECT_GT(certain, 100000u);
  }
}

}  // namespace certificate_test
}  // namespace bernal

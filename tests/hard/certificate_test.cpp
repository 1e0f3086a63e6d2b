#include "bernal/verify/certificate.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "bernal/core/random.hpp"
#include "support/integer_meshes.hpp"
#include "support/packing_oracle.hpp"

namespace bernal {
namespace certificate_test {

Certificate expect_truth(const Spheres<3>& s, const Domain& shape) {
  const Certificate filtered = certify(s, shape, {.arithmetic = Arithmetic::filtered});
  const Certificate exact = certify(s, shape, {.arithmetic = Arithmetic::exact});
  const oracle::Verdict truth = oracle::judge(s, shape);
  for (const Certificate& c : {filtered, exact}) {
    EXPECT_EQ(c.overlapping_pairs, truth.overlapping);
    EXPECT_EQ(c.protruding_spheres, truth.protruding);
    EXPECT_GE(c.pairs_tested, truth.near_at_least);
  }
  EXPECT_EQ(filtered.max_overlap, exact.max_overlap);
  EXPECT_EQ(filtered.min_wall_gap, exact.min_wall_gap);
  EXPECT_EQ(filtered.statement, exact.statement);
  return filtered;
}

Spheres<3> one(const Vector<3>& c, double r) {
  Spheres<3> s;
  s.push_back(c, r);
  return s;
}

TEST(HardCertificate, RayThroughVertexEdgeAndVerticalFace) {
  // Every centre sits exactly below, in x and y, a vertex, an edge or a vertical face of the mesh.
  for (const Mesh& mesh :
       {meshes::cube(), meshes::l_shape(), meshes::cube_with_cavity(), meshes::tetrahedron()})
    for (double x = -1; x <= 9; x += 1)
      for (double y = -1; y <= 9; y += 1)
        for (const double z : {-1.0, 0.5, 2.0, 4.0, 7.5, 9.0}) {
          SCOPED_TRACE(::testing::Message() << x << ' ' << y << ' ' << z);
          expect_truth(one({x, y, z}, 0.125), mesh);
        }
}

TEST(HardCertificate, BallTouchesFaceEdgeAndVertexByAnUlp) {
  const auto up = [](double r) { return std::nextafter(r, 100.0); };
  // L-shape: the reflex edge x = y = 4 is 5 from (1, 0+..); (3, 4) legs give a distance of exactly 5 units
  // / 4.
  const Mesh l = meshes::moved(meshes::l_shape(), 4, {0, 0, 0});  // edge at x = y = 16
  const Vector<3> beside_edge{16 - 3, 16 - 4, 16};
  EXPECT_TRUE(expect_truth(one(beside_edge, 5), l).certified);
  EXPECT_FALSE(expect_truth(one(beside_edge, up(5)), l).certified);

  // The corner of a cubic cavity seen along (2, 3, 6): a vertex at a distance of exactly 7.
  const Mesh cavity = meshes::moved(meshes::cube_with_cavity(), 8, {0, 0, 0});  // cavity corner (40, 40, 40)
  const Vector<3> beside_vertex{42, 43, 46};
  EXPECT_TRUE(expect_truth(one(beside_vertex, 7), cavity).certified);
  EXPECT_FALSE(expect_truth(one(beside_vertex, up(7)), cavity).certified);

  // A face, across its diagonal.
  EXPECT_TRUE(expect_truth(one({4, 4, 4}, 4), meshes::cube()).certified);
  EXPECT_FALSE(expect_truth(one({4, 4, 4}, up(4)), meshes::cube()).certified);
}

TEST(HardCertificate, OneUlpDecidesFarFromTheOrigin) {
  for (const double offset : {1e4, 1e6, 1e8}) {
    const Vector<3> o{offset, -offset, 2 * offset};
    Spheres<3> s;
    for (int i = 0; i < 4; ++i) s.push_back(o + Vector<3>{2.0 * i + 1, 1, 1}, 1);
    const Box box{.corner = o, .size = {8, 2, 2}};
    EXPECT_TRUE(expect_truth(s, box).certified);
    const Mesh mesh = meshes::moved(meshes::cube(), 1, o);
    EXPECT_TRUE(expect_truth(s, mesh).certified);
    s.x[0][2] = std::nextafter(s.x[0][2], 1e300);
    const Certificate c = expect_truth(s, box);
    EXPECT_EQ(c.overlapping_pairs, 1u);
    EXPECT_EQ(c.worst_pair->at(0), 2u);
    EXPECT_EQ(c.worst_pair->at(1), 3u);
  }
}

TEST(HardCertificate, ScaleDoesNotMatter) {
  // Powers of ten are not exact, so every size is a new set of near-ties; far beyond 1e±75 squares of squares
  // leave the range of double and exact arithmetic has to take over.
  for (const double scale : {1e-6, 1e6, 1e-100, 1e100, 1e-160, 1e160, 1e-300}) {
    SCOPED_TRACE(scale);
    Random random(3, stream(Stream::test));
    Spheres<3> s;
    for (int i = 0; i < 12; ++i)
      s.push_back(scale * uniform_point(random, Bounds<3>{{0, 0, 0}, {8, 8, 8}}),
                  scale * random.uniform(0.1, 2.0));
    s.push_back(scale * Vector<3>{1, 1, 1}, scale);
    s.push_back(scale * Vector<3>{3, 1, 1}, scale);
    const Box box{.corner = {0, 0, 0}, .size = Vector<3>::Constant(8 * scale)};
    const Cylinder cylinder{
        .base = {0, 0, 0}, .axis = scale * Vector<3>{1, 1, 1}, .radius = 4 * scale, .height = 10 * scale};
    expect_truth(s, box);
    expect_truth(s, Sphere{.center = Vector<3>::Constant(4 * scale), .radius = 4 * scale});
    expect_truth(s, cylinder);
    expect_truth(s, meshes::moved(meshes::l_shape(), scale, {0, 0, 0}));
  }
}

TEST(HardCertificate, AllCoincident) {
  Spheres<3> s;
  for (int i = 0; i < 1000; ++i) s.push_back({0.1, 0.2, 0.3}, 0.01);
  const Certificate c = certify(s, Box{});
  EXPECT_EQ(c.pairs_tested, 999u * 1000 / 2);
  EXPECT_EQ(c.overlapping_pairs, c.pairs_tested);
  EXPECT_EQ(c.max_overlap, 1);
  EXPECT_EQ(c.worst_pair->at(0), 0u);
  EXPECT_EQ(c.worst_pair->at(1), 1u);
}

TEST(HardCertificate, DustAroundABoulder) {
  // One sphere a thousand times as large as 5,000 others that touch it from outside: every one is a near tie.
  Random random(5, stream(Stream::test));
  Spheres<3> s;
  s.push_back({0, 0, 0}, 1);
  for (int i = 0; i < 5000; ++i) {
    const Vector<3> c = 1.001 * uniform_direction<3>(random);
    s.push_back(c, 0.001);
  }
  const Certificate c = certify(s, Box{.corner = {-2, -2, -2}, .size = {4, 4, 4}});
  std::uint64_t overlapping = 0;
  for (std::size_t j = 1; j < s.size(); ++j) overlapping += oracle::overlap(s, 0, j) ? 1 : 0;
  std::uint64_t among_dust = 0;
  for (std::size_t i = 1; i < s.size(); ++i)
    for (std::size_t j = i + 1; j < s.size(); ++j)
      among_dust += (s.center(i) - s.center(j)).norm() < 0.002 ? 1 : 0;
  EXPECT_EQ(c.overlapping_pairs, overlapping + among_dust);
  EXPECT_GT(overlapping, 1000u);
  EXPECT_GT(c.decided_exact, 4000u);
}

TEST(HardCertificate, SphereLargerThanItsContainer) {
  for (const Domain& shape :
       {Domain{Box{}}, Domain{Sphere{}}, Domain{Cylinder{}}, Domain{meshes::cube(0, 1)}}) {
    EXPECT_FALSE(expect_truth(one({0.5, 0.5, 0.5}, 100), shape).certified);
    EXPECT_FALSE(expect_truth(one({0.5, 0.5, 0.5}, 1e300), shape).certified);
    EXPECT_FALSE(expect_truth(one({0.5, 0.5, 1e300}, 1e-300), shape).certified);
  }
}

TEST(HardCertificate, FarOutsideIsFarBelowZero) {
  // Ten units beside a cube of eight: clearance -2, radius 0.5.
  const Certificate c = expect_truth(one({10, 4, 4}, 0.5), meshes::cube());
  EXPECT_DOUBLE_EQ(c.min_wall_gap, -5);
  EXPECT_DOUBLE_EQ(expect_truth(one({10, 4, 4}, 0.5), Box{.size = {8, 8, 8}}).min_wall_gap, -5);
}

TEST(HardCertificate, NeedlesSliversAndFacesWithoutArea) {
  // A cube whose top is a fan about a vertex on its edge: a collinear triangle, and slivers of width 1e-13.
  Mesh cube = meshes::cube();
  const auto add = [&](const Vector<3>& v) {
    cube.vertices.push_back(v);
    return static_cast<std::uint32_t>(cube.vertices.size() - 1);
  };
  const std::uint32_t middle = add({4, 4, 8}), beside = add({4 + 1e-13, 4, 8});
  std::erase_if(cube.triangles, [](const auto& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
  // Vertices 4, 5, 6, 7 bound the top counter-clockwise; `middle` lies on the diagonal 4-6.
  for (const auto& t : {std::array{4u, 5u, beside},
                        {5u, 6u, beside},
                        {6u, 7u, middle},
                        {7u, 4u, middle},
                        {4u, beside, middle},
                        {beside, 6u, middle}})
    cube.triangles.push_back(t);
  for (const double r : {4.0, std::nextafter(4.0, 8.0), 3.9999999})
    for (const double x : {4.0, 4 + 1e-13, 4 + 0.5e-13, 3.9999}) expect_truth(one({x, 4, 8 - r}, r), cube);
  // Collinear: `middle` becomes a corner of a triangle that lies on the diagonal.
  Mesh flat = meshes::cube();
  std::erase_if(flat.triangles, [](const auto& t) { return t[0] >= 4 && t[1] >= 4 && t[2] >= 4; });
  flat.vertices.push_back({4, 4, 8});
  for (const auto& t : {std::array{4u, 5u, 6u}, {4u, 6u, 8u}, {8u, 6u, 7u}, {4u, 8u, 7u}})
    flat.triangles.push_back(t);
  for (const double x : {4.0, 3.0, 4.5})
    for (const double z : {4.0, std::nextafter(4.0, 8.0), -5.0, 12.0})
      expect_truth(one({x, x, z}, 3.5), flat);
}

}  // namespace certificate_test
}  // namespace bernal

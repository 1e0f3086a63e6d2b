// Spheres as triangles: inside the true ones, free of overlap, and the same at both ends of a period.
#include "surfaces/surfaces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "support/ball_in_box.hpp"
#include "surfaces/icosphere.hpp"

namespace bernal {
namespace surfaces_test {

using Rational = boost::multiprecision::cpp_rational;
using testing::ball_in_box;

const Monitor nobody;

/// Spheres that touch their nearest neighbour or image, or nearly do; some cross faces, edges and corners.
Spheres<dynamic> touching_in(const Domain& domain, std::size_t n, double largest, std::uint64_t seed) {
  const Boundary<3> boundary = boundary_of<3>(domain);
  const Bounds<3> bounds = bounds_of(domain);
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  Random random(seed, 1);
  Spheres<3> spheres;
  for (int k = 0; k < 20'000 && spheres.size() < n; ++k) {
    Vector<3> c = bounds.lower;
    for (int a = 0; a < 3; ++a) c[a] += random.uniform(0, 1) * bounds.size()[a];
    if (k == 0 && !cylinder)  // in a corner, as far as there is one
      for (int a = 0; a < 3; ++a)
        if (boundary.repeats(a)) c[a] = bounds.lower[a];
    double room = largest;
    for (int a = 0; a < 3; ++a)
      if (!boundary.repeats(a) && !cylinder)
        room = std::min({room, c[a] - bounds.lower[a], bounds.upper[a] - c[a]});
    if (cylinder)
      room =
          std::min(room, cylinder->radius - std::hypot(c[0] - cylinder->base[0], c[1] - cylinder->base[1]));
    for (std::size_t i = 0; i < spheres.size(); ++i)
      room = std::min(room, boundary.minimum_image(spheres.center(i) - c).norm() - spheres.r[i]);
    room *= 1 - 1e-14;
    if (room > 0.2 * largest) spheres.push_back(c, room);
  }
  return spheres;
}

struct Case {
  const char* name;
  Domain domain;
};
std::vector<Case> periodic_cases() {
  return {{"box", bernal::periodic_box(Vector<3>(3, 3.7, 4.1))},
          {"slab", bernal::periodic_box(Vector<3>(3, 3.7, 4.1), {false, false, true})},
          {"column", Cylinder{.base = {0.3, -0.2, 0.1}, .radius = 2, .height = 3, .periodic = true}}};
}

Mesh mesh_of(const Surfaces& surfaces) {
  Mesh mesh;
  surfaces.visit([&](const SurfacePart& part) {
    EXPECT_EQ(part.first_vertex, mesh.vertices.size());
    for (const FloatPoint& p : part.vertices) mesh.vertices.emplace_back(p[0], p[1], p[2]);
    mesh.triangles.insert(mesh.triangles.end(), part.triangles.begin(), part.triangles.end());
  });
  EXPECT_EQ(mesh.vertices.size(), surfaces.vertices());
  EXPECT_EQ(mesh.triangles.size(), surfaces.triangles());
  return mesh;
}

double volume_in(const Mesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  return volume;
}

/// Edges that are not passed once in each direction.
std::size_t open_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : 1000;
    }
  std::size_t open = 0;
  for (const auto& [edge, times] : edges) open += times != 1001;
  return open;
}

double volume_of_balls_in(const Spheres<dynamic>& spheres) {
  double volume = 0;
  for (const double r : spheres.r) volume += 4 * std::numbers::pi / 3 * r * r * r;
  return volume;
}

TEST(Icosphere, HasCornersOnTheSphereAndAsManyAsItShould) {
  for (const int n : {1, 2, 3, 7}) {
    const Icosphere& sphere = icosphere(n);
    EXPECT_EQ(sphere.triangles.size(), 20U * n * n);
    EXPECT_EQ(sphere.vertices.size(), 10U * n * n + 2);
    for (const Vector<3>& v : sphere.vertices) EXPECT_NEAR(v.norm(), 1, 1e-15);
    EXPECT_EQ(open_edges({sphere.vertices, sphere.triangles}), 0U);
    EXPECT_LT(sphere.volume, 4 * std::numbers::pi / 3);
    EXPECT_GT(sphere.volume, 4 * std::numbers::pi / 3 * std::pow(sphere.inradius, 3));
  }
  for (const double deflection : {0.2, 0.05, 0.02, 0.001}) {
    const int n = frequency_for(deflection);
    EXPECT_LE(1 - icosphere(n).inradius, deflection);
    EXPECT_TRUE(n == 1 || 1 - icosphere(n - 1).inradius > deflection);
  }
}

TEST(Surfaces, EveryFloatLiesInTheTrueBall) {
  for (const Case& of : periodic_cases()) {
    const Spheres<dynamic> spheres = touching_in(of.domain, 60, 0.5, 3);
    const Surfaces surfaces(spheres, of.domain, 0.05, SurfaceChoice::spheres, nobody);
    const Boundary<3> boundary = boundary_of<3>(of.domain);
    std::size_t tested = 0;
    surfaces.visit([&](const SurfacePart& part) {
      const std::uint32_t i = *part.sphere;
      // The image whose piece this is: the nearest to any of its points.
      const FloatPoint first = part.vertices.front();
      for (const FloatPoint& p : part.vertices) {
        Rational squared = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const int axis = static_cast<int>(k);
          const double off = first[k] - spheres.x[k][i];
          const double times = boundary.repeats(axis) ? std::nearbyint(off / boundary.edges[axis]) : 0;
          const Rational d = Rational(static_cast<double>(p[k])) - Rational(spheres.x[k][i]) -
                             Rational(times) * Rational(boundary.edges[axis]);
          squared += d * d;
        }
        ASSERT_LT(squared, Rational(spheres.r[i]) * Rational(spheres.r[i])) << of.name << ' ' << i;
        ++tested;
      }
    });
    EXPECT_EQ(tested, surfaces.vertices());
    EXPECT_LE(surfaces.measures().deflection, 0.05) << of.name;
    EXPECT_NE(surfaces.note().find("no two of them touch"), std::string::npos) << surfaces.note();
  }
}

TEST(Surfaces, SpheresThatTouchHaveTrianglesThatDoNot) {
  // A lattice of 1,000 spheres that touch, far enough from the origin for rounding to matter.
  Spheres<3> spheres;
  for (int k = 0; k < 1000; ++k)
    spheres.push_back(Vector<3>(1000.1 + k % 10, 3.3 + k / 10 % 10, 0.7 + k / 100), 0.5 * (1 - 1e-13));
  const Domain box = Box{Vector<3>(999.6, 2.8, 0.2), Vector<3>(10, 10, 10)};
  const Surfaces surfaces(spheres, box, 0.1, SurfaceChoice::all, nobody);
  const Mesh mesh = mesh_of(surfaces);
  EXPECT_GT(mesh.triangles.size(), 80'000U);
  EXPECT_EQ(cad::count_self_intersections(mesh), 0U);
  EXPECT_EQ(open_edges(mesh), 0U);
  EXPECT_NE(surfaces.note().find("no two of them touch each other or the walls"), std::string::npos)
      << surfaces.note();
}

TEST(Surfaces, TheSameTestFindsTrianglesThatMeet) {  // as those would that no rounding was allowed for
  Mesh mesh;
  for (const double x : {0.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vector<3>& v : icosphere(2).vertices) mesh.vertices.push_back(0.51 * v + Vector<3>(x, 0, 0));
    for (const auto& [a, b, c] : icosphere(2).triangles)
      mesh.triangles.push_back({first + a, first + b, first + c});
  }
  EXPECT_GT(cad::count_self_intersections(mesh), 0U);
}

TEST(Surfaces, OppositeEndsCarryTheSameTriangles) {
  std::vector<std::pair<Case, std::uint64_t>> cases;
  for (const Case& of : periodic_cases())
    for (std::uint64_t seed = 5; seed < 13; ++seed) cases.emplace_back(of, seed);
  for (const auto& [of, seed] : cases) {
    const Spheres<dynamic> spheres = touching_in(of.domain, 80, 0.6, seed);
    const Boundary<3> boundary = boundary_of<3>(of.domain);
    const SphereSurfaces surfaces(pieces_of(spheres, of.domain), of.domain, 0.05, single_precision_shift(10));
    std::array<std::set<std::set<FloatPoint>>, 6> ends;
    for (std::size_t i = 0; i < surfaces.spheres(); ++i)
      surfaces.visit(i, [&](const FloatSurface& surface) {
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
          const int face = surface.faces[t];
          if (face < 0) continue;
          const auto axis = static_cast<std::size_t>(face / 2);
          const int k = face / 2;
          const auto end = static_cast<float>(boundary.origin[k] + (face % 2 == 1 ? boundary.edges[k] : 0.0));
          std::set<FloatPoint> corners;
          for (const std::uint32_t v : surface.triangles[t]) {
            FloatPoint p = surface.vertices[v];
            ASSERT_EQ(p[axis], end);
            p[axis] = 0;
            corners.insert(p);
          }
          EXPECT_TRUE(ends[static_cast<std::size_t>(face)].insert(corners).second);
        }
      });
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(ends[2 * k].empty(), !boundary.repeats(static_cast<int>(k)));
      std::vector<std::set<FloatPoint>> differ;
      std::ranges::set_symmetric_difference(ends[2 * k], ends[2 * k + 1], std::back_inserter(differ));
      EXPECT_TRUE(differ.empty()) << of.name << ' ' << seed << " axis " << k << ": "
                                  << ::testing::PrintToString(differ);
    }
  }
}

TEST(Surfaces, PiecesAreClosedAndSumUpToTheirSpheres) {
  for (const Case& of : periodic_cases()) {
    const Spheres<dynamic> spheres = touching_in(of.domain, 80, 0.6, 7);
    const Surfaces surfaces(spheres, of.domain, 0.03, SurfaceChoice::spheres, nobody);
    const Mesh mesh = mesh_of(surfaces);
    EXPECT_EQ(open_edges(mesh), 0U) << of.name;
    EXPECT_GT(surfaces.measures().surfaces, spheres.size());
    const double share = volume_in(mesh) / volume_of_balls_in(spheres);
    EXPECT_NEAR(share, surfaces.measures().volume_share, 1e-5) << of.name;
    EXPECT_GT(share, std::pow(1 - surfaces.measures().deflection, 3)) << of.name;
    EXPECT_LT(share, 1);
    EXPECT_EQ(cad::count_self_intersections(mesh), 0U) << of.name;
  }
}

TEST(Surfaces, BallsOfThePiecesHaveThePackingFraction) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Domain domain = bernal::periodic_box(Vector<3>(3, 3.7, 4.1));
    const Spheres<dynamic> spheres = touching_in(domain, 80, 0.7, seed);
    double volume = 0;
    for (const Piece& piece : pieces_of(spheres, domain))
      volume += ball_in_box(piece.center, piece.radius, bounds_of(domain));
    EXPECT_NEAR(volume / volume_of(domain), volume_of_balls_in(spheres) / volume_of(domain), 1e-9);
  }
}

TEST(Surfaces, ThePoreSpaceHasOneClosedBoundary) {
  std::vector<Case> cases = periodic_cases();
  cases.push_back({"cylinder", Cylinder{.base = {1, 2, -1}, .radius = 2, .height = 3}});
  cases.push_back({"sphere", Sphere{.center = {1, 2, -1}, .radius = 2}});
  for (const Case& of : cases) {
    Spheres<dynamic> spheres = touching_in(of.domain, 60, 0.6, 11);
    if (!is_periodic(of.domain)) {
      Spheres<3> one;
      one.push_back(Vector<3>(1, 2, 0), 0.9999);
      spheres = one;
    }
    const Surfaces surfaces(spheres, of.domain, 0.05, SurfaceChoice::pores, nobody);
    const Mesh mesh = mesh_of(surfaces);
    EXPECT_EQ(open_edges(mesh), 0U) << of.name;
    EXPECT_EQ(cad::count_self_intersections(mesh), 0U) << of.name;
    // What it encloses is the container without the spheres, all of triangles.
    const Surfaces alone(spheres, of.domain, 0.05, SurfaceChoice::spheres, nobody);
    const Surfaces container(spheres, of.domain, 0.05, SurfaceChoice::container, nobody);
    EXPECT_EQ(open_edges(mesh_of(container)), 0U) << of.name;
    const double whole = volume_in(mesh_of(container));
    EXPECT_NEAR(volume_in(mesh), whole - volume_in(mesh_of(alone)), 1e-5 * whole) << of.name;
    EXPECT_GT(whole, volume_of(of.domain) * (1 - 1e-6));
    EXPECT_LT(whole, volume_of(of.domain) * 1.1);
  }
}

/// Each with a sphere in the corner, cut into eight, and others near faces and edges.
TEST(Surfaces, ThePoreSpaceOfAnyPeriodicBoxIsClosed) {
  const Domain box = bernal::periodic_box(Vector<3>(3, 3.7, 4.1));
  int open = 0, crossing = 0;
  for (std::uint64_t seed = 1; seed <= 48; ++seed) {
    const double deflection = std::array{0.05, 0.02, 0.01}[seed % 3];
    const Surfaces surfaces(touching_in(box, 30, 0.9, seed), box, deflection, SurfaceChoice::pores, nobody);
    const Mesh mesh = mesh_of(surfaces);
    open += open_edges(mesh) > 0;
    crossing += cad::count_self_intersections(mesh) > 0;
  }
  EXPECT_EQ(open, 0);
  EXPECT_EQ(crossing, 0);
}

TEST(Surfaces, ClaimNothingOfSpheresThatOverlap) {
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(1, 1, 1), 0.5);
  spheres.push_back(Vector<3>(1.9, 1, 1), 0.5);
  const Surfaces surfaces(spheres, Box{Vector<3>(0, 0, 0), Vector<3>(3, 3, 3)}, 0.05, SurfaceChoice::spheres,
                          nobody);
  EXPECT_EQ(surfaces.note().find("touch"), std::string::npos) << surfaces.note();
  EXPECT_NE(surfaces.note().find("overlap"), std::string::npos) << surfaces.note();
}

TEST(Surfaces, ThePoresOfSpheresThatOverlapAtTheEndOfAPeriodAreRefusedWithARemedy) {
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(0.1, 1, 1), 0.5);
  spheres.push_back(Vector<3>(0.1, 1.7, 1), 0.5);
  const Domain box = bernal::periodic_box(Vector<3>(3, 3, 3));
  try {
    const Surfaces surfaces(spheres, box, 0.05, SurfaceChoice::pores, nobody);
    FAIL() << "no pore space has such a boundary";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("contact gap"), std::string::npos) << error.what();
  }
  EXPECT_NO_THROW(Surfaces(spheres, box, 0.05, SurfaceChoice::all, nobody));
}

TEST(Surfaces, RefuseSpheresThatSinglePrecisionCannotHold) {
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(1e6, 1, 1), 0.5);
  const Domain box = Box{Vector<3>(1e6 - 1, 0, 0), Vector<3>(2, 2, 2)};
  try {
    Surfaces(spheres, box, 0.02, SurfaceChoice::spheres, nobody);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("origin"), std::string::npos) << error.what();
  }
}

/// Slivers have the better of these cuts for every polyhedron of that deflection.
TEST(Surfaces, ASphereThatCannotBeClosedIsRefusedWithARemedy) {
  const Domain domain = bernal::periodic_box(Vector<3>(3, 3, 3));
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(0.63240011480680813, 0.16736818328378505, 0.78696825049284469), 1);
  std::vector<Piece> pieces = pieces_of(spheres, domain);
  const std::pair<Vector<3>, double> planes[] = {
      {{0.7401548899410394, 0.47708601701835063, 0.47387727447297362}, 0.44819831897301587},
      {{0.16688173019517188, -0.90805570059516971, 0.38416836510009694}, 0.31006061792636608},
      {{-0.00016500403703276122, 0.00031620173159884043, 0.99999993639506424}, 0.69804581199097204}};
  for (Piece& piece : pieces)
    for (const auto& [normal, depth] : planes)
      piece.cuts.push_back({{normal, normal.dot(piece.center) + depth}});
  const double shift = single_precision_shift(4);
  try {
    SphereSurfaces(pieces, domain, 0.023118355623494471, shift).measure();
    FAIL() << "the case is no hard one any more: find another";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(std::string(error.what()).find("closed"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("another one"), std::string::npos) << error.what();
  }
  const SphereSurfaces surfaces(pieces, domain, 0.03, shift);
  surfaces.visit(0, [&](const FloatSurface& surface) {
    Mesh mesh;
    for (const FloatPoint& p : surface.vertices) mesh.vertices.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = surface.triangles;
    EXPECT_EQ(open_edges(mesh), 0U);
  });
}

TEST(Surfaces, AContactCutTakesItsCapAway) {
  const Domain domain = bernal::periodic_box(Vector<3>(3, 3, 3));
  Spheres<3> spheres;
  spheres.push_back(Vector<3>(0.1, 1.5, 1.5), 1);
  std::vector<Piece> pieces = pieces_of(spheres, domain);
  const Vector<3> normal = Vector<3>(0.1, 1, 0.2).normalized();
  for (Piece& piece : pieces) piece.cuts.push_back({{normal, normal.dot(piece.center) + 0.7}});
  const SphereSurfaces surfaces(pieces, domain, 0.01, single_precision_shift(3));
  double volume = 0;
  surfaces.visit(0, [&](const FloatSurface& surface) {
    Mesh mesh;
    for (const FloatPoint& p : surface.vertices) mesh.vertices.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = surface.triangles;
    EXPECT_EQ(open_edges(mesh), 0U);
    volume += volume_in(mesh);
  });
  // A ball without a cap of height 0.3: pi/3 (4 - h^2 (3 - h)).
  const double ball = std::numbers::pi / 3 * (4 - 0.09 * 2.7);
  EXPECT_LT(volume, ball);
  EXPECT_GT(volume, 0.98 * ball);
}

TEST(PorePoint, IsFartherFromAllThanItSays) {
  std::vector<Case> cases = periodic_cases();
  for (const Case& of : cases) {
    const Spheres<dynamic> spheres = touching_in(of.domain, 60, 0.6, 13);
    const auto point = point_in_pores(spheres, of.domain, wall_surface(of.domain, 0.01));
    ASSERT_TRUE(point) << of.name;
    const Boundary<3> boundary = boundary_of<3>(of.domain);
    EXPECT_GT(point->clearance, 0.05) << of.name;
    for (std::size_t i = 0; i < spheres.size(); ++i)
      EXPECT_GE((boundary.minimum_image(spheres.center(i) - point->place)).norm(),
                spheres.r[i] + point->clearance - 1e-12);
  }
}

}  // namespace surfaces_test
}  // namespace bernal

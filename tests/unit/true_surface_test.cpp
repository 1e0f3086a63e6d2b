// How far the surface of a CAD file is from its triangles, as it is proven, against closed forms and a
// million points; and spheres certified against that surface.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/verify/certificate.hpp"
#include "cad/read/polygon_soup.hpp"
#include "geometry/curved_patch.hpp"
#include "geometry/deviation_bounds.hpp"
#include "kernels/closest_point.hpp"
#include "support/folder.hpp"

namespace bernal {
namespace true_surface_test {

constexpr double pi = std::numbers::pi;
using Parameters = std::array<double, 2>;

TrueSurface::Patch torus(double large, double small) {
  TrueSurface::Swept swept;
  swept.c[2] = {large * Vector<3>::UnitX(), Vector<3>::Zero(), small * Vector<3>::UnitX(), Vector<3>::Zero()};
  swept.c[3] = {large * Vector<3>::UnitY(), Vector<3>::Zero(), small * Vector<3>::UnitY(), Vector<3>::Zero()};
  swept.c[0][3] = small * Vector<3>::UnitZ();
  return swept;
}

TrueSurface::Patch cylinder(double radius) {
  TrueSurface::Swept swept;
  swept.c[2][0] = radius * Vector<3>::UnitX();
  swept.c[3][0] = radius * Vector<3>::UnitY();
  swept.c[0][1] = Vector<3>::UnitZ();
  return swept;
}

TrueSurface::Patch random_bezier(std::mt19937_64& random, bool rational) {
  std::uniform_real_distribution<double> any(-0.3, 0.3), weight(rational ? 0.5 : 1, rational ? 2 : 1);
  TrueSurface::Bezier bezier{{3, 4}, {2, -1}, {3, 1}, {}};
  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= 4; ++j) {
      const double w = weight(random);
      bezier.points.push_back({w * (i + any(random)), w * (j + any(random)), w * any(random), w});
    }
  return bezier;
}

ParameterTriangle random_triangle(std::mt19937_64& random, const Parameters& middle, double size) {
  std::uniform_real_distribution<double> any(-size, size);
  ParameterTriangle t;
  for (auto& p : t) p = {middle[0] + any(random), middle[1] + any(random)};
  return t;
}

/// The largest distance of the surface over a triangle from where the flat one has the same point.
double bends_by(const TrueSurface::Patch& patch, const ParameterTriangle& t) {
  std::array<Vector<3>, 3> corners;
  for (int k = 0; k < 3; ++k) corners[k] = point_at(patch, t[k]);
  double most = 0;
  constexpr int fineness = 24;
  for (int i = 0; i <= fineness; ++i)
    for (int j = 0; i + j <= fineness; ++j) {
      const double a = double(i) / fineness, b = double(j) / fineness, c = 1 - a - b;
      const Parameters at{a * t[0][0] + b * t[1][0] + c * t[2][0], a * t[0][1] + b * t[1][1] + c * t[2][1]};
      most = std::max(most, (point_at(patch, at) - a * corners[0] - b * corners[1] - c * corners[2]).norm());
    }
  return most;
}

// An arc over the angle 2 a is R (1 - cos a) off its chord; the bound is R a² / 2.
TEST(CurvedPatch, ACylinderBendsAsAnArc) {
  for (const double half : {0.4, 0.1, 0.01}) {
    const ParameterTriangle t{{{-half, 0}, {half, 0}, {half, 3}}};
    const double bend = bend_of(t, bending_of(t, derivative_bounds(cylinder(5), box_of(t))));
    EXPECT_GE(bend, 5 * (1 - std::cos(half)));
    EXPECT_NEAR(bend, 5 * half * half / 2, 1e-12);
  }
}

TEST(CurvedPatch, NoPieceBendsMoreThanItsBoundAndMostNearlyAsMuch) {
  std::mt19937_64 random(7);
  for (const int kind : {0, 1, 2}) {
    double closest = 0;
    for (int n = 0; n < 300; ++n) {
      const TrueSurface::Patch patch = kind == 0 ? torus(3, 1 + n % 3) : random_bezier(random, kind == 2);
      const ParameterTriangle t = random_triangle(random, {2.5, 0}, n % 2 ? 0.4 : 0.05);
      const Bending bending = bending_of(t, derivative_bounds(patch, box_of(t)));
      const double bend = bend_of(t, bending), is = bends_by(patch, t);
      EXPECT_LE(is, bend);
      closest = std::max(closest, is / bend);
      const int edge = edge_to_halve(t, bending);
      ParameterTriangle half = t;
      half[edge] = middle_of_edge(t, edge);
      EXPECT_LE(bends_by(patch, half), bend_of(half, bending));
      EXPECT_LE(bend_of(half, bending), bend);
    }
    EXPECT_GT(closest, 0.5);
  }
}

// Derivatives against differences of points.
TEST(CurvedPatch, NoDerivativeIsLargerThanItsBound) {
  std::mt19937_64 random(8);
  constexpr double h = 1e-4;
  for (int n = 0; n < 200; ++n) {
    const TrueSurface::Patch patch = n % 2 ? torus(3, 2) : random_bezier(random, true);
    const ParameterTriangle t = random_triangle(random, {2.5, 0}, 0.3);
    const DerivativeBounds bounds = derivative_bounds(patch, box_of(t));
    const auto at = [&](double u, double v) { return point_at(patch, {t[0][0] + u, t[0][1] + v}); };
    const Vector<3> here = at(0, 0);
    const auto le = [](double is, double bound) { EXPECT_LE(is, bound * 1.001 + 1e-5); };
    le((at(h, 0) - at(-h, 0)).norm() / (2 * h), bounds.u);
    le((at(0, h) - at(0, -h)).norm() / (2 * h), bounds.v);
    le((at(h, 0) + at(-h, 0) - 2 * here).norm() / (h * h), bounds.uu);
    le((at(0, h) + at(0, -h) - 2 * here).norm() / (h * h), bounds.vv);
    le((at(h, h) + at(-h, -h) - at(h, -h) - at(-h, h)).norm() / (4 * h * h), bounds.uv);
  }
}

class InCadFile : public ::testing::Test {
 protected:
  void SetUp() override {
    if (cad::read_with_opencascade(path("frustum.brep"), 1).failure.find("without OpenCASCADE") !=
        std::string::npos)
      GTEST_SKIP() << "built without OpenCASCADE";
  }

  static std::filesystem::path path(const std::string& name) {
    return std::filesystem::path(BERNAL_DATA) / "meshes" / name;
  }

  static Mesh part(const std::string& name, double smallest_radius, const std::string& solid = "") {
    MeshFile file{.file = path(name), .unit = Unit::mm, .true_surface = true};
    if (!solid.empty()) file.solids = {solid};
    if (!name.ends_with(".brep")) file.unit.reset();
    return read_container_mesh(file, {Unit::mm, smallest_radius}).mesh;
  }

  static Certificate certificate(const Mesh& mesh, const Vector<3>& c, double r) {
    Spheres<dynamic> spheres(3);
    spheres.push_back(c, r);
    return certify(spheres, mesh);
  }
  static bool certified(const Mesh& mesh, const Vector<3>& c, double r) {
    return certificate(mesh, c, r).certified;
  }

  /// A sphere that touches the wall but for a millionth of its radius in a direction, and beyond it.
  static void expect_touching(const Mesh& mesh, const Vector<3>& touching, double r,
                              const Vector<3>& outward) {
    const Vector<3> n = outward.normalized();
    EXPECT_TRUE(certified(mesh, touching - 1e-6 * r * n, r));
    EXPECT_FALSE(certified(mesh, touching + 1e-6 * r * n, r));
    EXPECT_FALSE(certified(mesh, touching + 2 * mesh.surface->worst_face().apart * n, r));
    for (const double gap : {1e-6, 1e-3, 0.02})
      EXPECT_NEAR(certificate(mesh, touching - gap * r * n, r).min_wall_gap, gap, 1e-7);
    EXPECT_NEAR(certificate(mesh, touching - 0.01 * r * n, 1e-3 * r).min_wall_gap, 1009, 1e-4);
  }
};

// In micrometres a block of millimetres is known a thousand times less well, by the number.
TEST_F(InCadFile, TolerancesFollowTheUnit) {
  const MeshFile file{.file = path("block_fillets_bore.step"), .true_surface = true};
  const TrueSurface mm = *read_container_mesh(file, {Unit::mm, 2}).mesh.surface;
  const TrueSurface um = *read_container_mesh(file, {Unit::um, 2000}).mesh.surface;
  ASSERT_EQ(um.pieces.size(), mm.pieces.size());
  ASSERT_EQ(um.faces.size(), mm.faces.size());
  double slack = 0;
  for (std::size_t k = 0; k < mm.pieces.size(); ++k) {
    EXPECT_GE(um.pieces[k].slack, 1000 * mm.pieces[k].slack);
    EXPECT_LE(um.pieces[k].slack, 1000.0001 * mm.pieces[k].slack);
    slack = std::max(slack, mm.pieces[k].slack);
  }
  EXPECT_GT(slack, 0);
  for (std::size_t k = 0; k < mm.faces.size(); ++k)
    EXPECT_NEAR(um.faces[k].tolerance, 1000 * mm.faces[k].tolerance, 1e-12);
}

// The bore has the radius 6 about x = y = 20, fillets and corners have the radius 3.
TEST_F(InCadFile, ASphereTouchesAFilletABoreAndASphericalCap) {
  const Mesh block = part("block_fillets_bore.step", 2);
  const double r = 2, bound = block.surface->worst_face().apart;
  EXPECT_LT(bound, 1e-3 * r);
  EXPECT_EQ(block.margin(), bound);
  expect_touching(block, {20 + 6 + r, 20, 10}, r, {-1, 0, 0});
  expect_touching(block, {20 - 6 - r, 20.0, 7}, r, {1, 0, 0});
  const double off = (3 - r) / std::sqrt(2), cap = (3 - r) / std::sqrt(3);
  expect_touching(block, {30, 3 - off, 3 - off}, r, {0, -1, -1});
  expect_touching(block, {3 - cap, 3 - cap, 3 - cap}, r, {-1, -1, -1});
  expect_touching(block, {45, 20, 20 - r}, r, {0, 0, 1});
}

TEST_F(InCadFile, ASphereTouchesACylinderABallAndATorusFromInside) {
  constexpr double inch = 25.4, r = 50;
  const Mesh tin = part("round_bodies_inch.step", 400, "1"), ball = part("round_bodies_inch.step", 400, "2"),
             ring = part("round_bodies_inch.step", 400, "3");
  for (const double angle : {0.1, 1.0, 2.7, 4.4}) {
    const Vector<3> d(std::cos(angle), std::sin(angle), 0);
    expect_touching(tin, (10 * inch - r) * d + 100 * Vector<3>::UnitZ(), r, d);
    const Vector<3> e = (d + Vector<3>(0, 0, 2)).normalized();
    expect_touching(ball, Vector<3>(40 * inch, 0, 0) + (7 * inch - r) * e, r, e);
    const Vector<3> tube = (0.6 * d + Vector<3>(0, 0, 0.8)).normalized();
    expect_touching(ring, Vector<3>(0, 50 * inch, 0) + 12 * inch * d + (4 * inch - r) * tube, r, tube);
    const Vector<3> hole = (-0.9 * d + Vector<3>(0, 0, 0.3)).normalized();
    expect_touching(ring, Vector<3>(0, 50 * inch, 0) + 12 * inch * d + (4 * inch - r) * hole, r, hole);
  }
}

/// The distance of a point from the pieces of a surface, by dividing those that may be nearest: an oracle
/// that knows no bounds but that of the triangle inequality with a generous Lipschitz constant.
double distance_by_samples(const TrueSurface& surface, const Vector<3>& p) {
  double best = 1e300;
  Parameters at{};
  const TrueSurface::Patch* patch = nullptr;
  for (const TrueSurface::Piece& piece : surface.pieces)
    for (int n = 0; n < 28; ++n) {  // points of a lattice on it, corners among them
      const int i = n % 7, j = n / 7;
      const double a = std::min(i, 6 - j) / 6.0, b = j / 6.0;
      Parameters q{};
      for (int k = 0; k < 2; ++k)
        q[k] = a * piece.at[0][k] + b * piece.at[1][k] + (1 - a - b) * piece.at[2][k];
      if (const double d = (point_at(surface.patches[piece.patch], q) - p).norm(); d < best)
        best = d, at = q, patch = &surface.patches[piece.patch];
    }
  for (double step = 0.1; step > 1e-12; step *= 0.5)  // downhill in a pattern
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [u, v] : {std::pair(step, 0.0),
                                 {-step, 0.0},
                                 {0.0, step},
                                 {0.0, -step},
                                 {step, step},
                                 {-step, -step},
                                 {step, -step},
                                 {-step, step}})
        if (const double d = (point_at(*patch, {at[0] + u, at[1] + v}) - p).norm(); d < best)
          best = d, at = {at[0] + u, at[1] + v}, moved = true;
    }
  return best;
}

TEST_F(InCadFile, ASphereTouchesABSpline) {
  const Mesh wall = part("twisted.brep", 20);
  for (const Vector<3>& c : {Vector<3>(1, 2, 15), Vector<3>(-2, 1, 9), Vector<3>(0, -1, 20)}) {
    const double r = distance_by_samples(*wall.surface, c);
    EXPECT_TRUE(certified(wall, c, r * (1 - 1e-6)));
    for (const double share : {1 - 1e-4, 0.3})
      EXPECT_NEAR(certificate(wall, c, r * share).min_wall_gap, 1 / share - 1, 1e-6 / share);
    EXPECT_FALSE(certified(wall, c, r * (1 + 1e-6)));
    EXPECT_FALSE(certified(wall, c, r + 2 * wall.surface->worst_face().apart));
  }
}

// Closed forms: what the triangles are off a cylinder, a ball and a torus; one way and the other.
TEST_F(InCadFile, TheBoundsHoldAgainstClosedForms) {
  constexpr double inch = 25.4;
  const auto off = [](const std::string& solid, const Vector<3>& p) {
    if (solid == "1") return std::max(0.0, 10 * inch - std::hypot(p[0], p[1]));
    if (solid == "2") return 7 * inch - (p - Vector<3>(40 * inch, 0, 0)).norm();
    return 4 * inch - std::hypot(std::hypot(p[0], p[1] - 50 * inch) - 12 * inch, p[2]);
  };
  for (const std::string solid : {"1", "2", "3"}) {
    const Mesh mesh = part("round_bodies_inch.step", 400, solid);
    double deepest = 0;
    for (const TrueSurface::Flat& flat : mesh.surface->flats) {
      if (mesh.surface->faces[flat.face].kind == "plane") continue;
      const auto& [a, b, c] = flat.corners;
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; i + j <= 8; ++j)
          deepest = std::max(deepest, off(solid, (i * a + j * b + (8 - i - j) * c) / 8));
    }
    const double bound = mesh.surface->worst_face().apart;
    EXPECT_GE(bound, deepest) << solid;
    EXPECT_LE(bound, 3 * deepest) << solid;
  }
}

TEST_F(InCadFile, AMillionPointsOfABSplineAreWithinTheBound) {
  const Mesh wall = part("twisted.brep", 5);
  const TrueSurface& surface = *wall.surface;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<double> track(surface.faces.size());
  for (int n = 0; n < 1'000'000; ++n) {
    const auto& piece =
        surface.pieces[static_cast<std::size_t>(unit(random) * double(surface.pieces.size()))];
    double a = unit(random), b = unit(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    Parameters at{};
    for (int k = 0; k < 2; ++k)
      at[k] = a * piece.at[0][k] + b * piece.at[1][k] + (1 - a - b) * piece.at[2][k];
    const auto& flat = surface.flats[piece.flat];
    const auto& [p, q, r] = flat.corners;
    const double d = PreparedTriangle(p, q, r).offset(point_at(surface.patches[piece.patch], at)).norm();
    track[flat.face] = std::max(track[flat.face], d);
  }
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    EXPECT_LE(track[f], surface.faces[f].track);
    EXPECT_LE(surface.faces[f].track, 3 * track[f] + surface.faces[f].apart);
  }
}

// Pieces are shared out to threads in groups that do not depend on how many there are.
TEST_F(InCadFile, TheBoundsAreTheSameForAnyNumberOfThreads) {
  TrueSurface surface = *part("round_bodies_inch.step", 400, "3").surface;
  const std::vector<TrueSurface::Face> known = surface.faces;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control most(tbb::global_control::max_allowed_parallelism, threads);
    set_deviation_bounds(surface);
    for (std::size_t f = 0; f < known.size(); ++f) {
      EXPECT_EQ(surface.faces[f].apart, known[f].apart);
      EXPECT_EQ(surface.faces[f].track, known[f].track);
      EXPECT_EQ(surface.faces[f].worst, known[f].worst);
    }
  }
}

/// What is proven of a ball whose triangles meet at its poles: no more than of a thousand more triangles
/// elsewhere.
TEST_F(InCadFile, ABallIsAsNearAtItsPoles) {
  const Mesh ball = part("round_bodies_inch.step", 40, "2");
  const auto& face = ball.surface->worst_face();
  EXPECT_LT(face.apart, 1e-3 * 40);
  EXPECT_LT(face.track, 40 / 4.0);
}

TEST_F(InCadFile, WhatCannotBeProvenSaysWhy) {
  const auto refused = [](MeshFile file) -> std::string {
    file.true_surface = true;
    try {
      read_container_mesh(file, {Unit::mm, 2});
    } catch (const OptionError& error) {
      return error.option + ": " + error.what();
    }
    return {};
  };
  EXPECT_EQ(
      refused({.file = path("hopper.stl")}),
      "true_surface: is for STEP, IGES and BREP, but hopper.stl holds triangles, on which the certificate "
      "decides anyway; take the key out");
  EXPECT_EQ(
      refused({.file = path("block_fillets_bore.step"), .fill_level = 10}),
      "true_surface: is of the file as it stands, but fill_level changes its walls: take one of the two out, "
      "and make the change in CAD");
}

TEST_F(InCadFile, AFaceWithoutASurfaceIsNamed) {
  std::string brep = testing::text_of(path("frustum.brep"));
  const std::string face = "\n0  1e-07 1 0\n";
  const std::size_t at = brep.find(face);
  ASSERT_NE(at, std::string::npos);
  brep.replace(at, face.size(), "\n0  1e-07 0 0\n");
  const testing::Folder folder;
  EXPECT_EQ(cad::read_with_opencascade(folder.write("bare.brep", brep), 1).failure,
            "face 1 has no surface; export the part again");
}

TEST_F(InCadFile, NothingOfItIsMadeUnlessAskedFor) {
  const Mesh block = read_mesh({.file = path("block_fillets_bore.step")}).mesh;
  EXPECT_EQ(block.surface, nullptr);
  EXPECT_TRUE(cad::read_with_opencascade(path("frustum.brep"), 1).surface.empty());
}

}  // namespace true_surface_test
}  // namespace bernal

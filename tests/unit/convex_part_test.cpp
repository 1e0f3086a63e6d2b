// Convex parts that are cut out of packings: how they are made, what of balls is in them, and their meshes.
#include "solids/convex_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "bernal/core/error.hpp"
#include "geometry/changes.hpp"
#include "geometry/edges.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/fill_layers.hpp"
#include "meshes/mesh_quality.hpp"
#include "meshes/second_order.hpp"
#include "process/find_program.hpp"
#include "solids/cut_out.hpp"
#include "solids/near_faces.hpp"
#include "voxels/ball_in_cells.hpp"

namespace bernal {
namespace convex_part_test {

constexpr double pi = std::numbers::pi;

#define NEEDS_TETGEN() \
  if (program_at("tetgen").empty()) GTEST_SKIP() << "tetgen is not installed"

using Turn = Eigen::AngleAxisd;
const Turn tilted(0.5, Vector<3>(1, 2, 3).normalized());

Mesh moved(Mesh mesh, const Turn& turn, const Vector<3>& to) {
  move_vertices(mesh, [&](const Vector<3>& p) -> Vector<3> { return turn * p + to; });
  return mesh;
}

Mesh cube(double edge) {
  const Vector<3> half = Vector<3>::Constant(0.5 * edge);
  return mesh_of_box({-half, half});
}

/// About zero, upright.
Mesh prism(std::uint32_t sides, double radius, double height) {
  Mesh mesh;
  for (const double z : {-0.5, 0.5})
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * pi * k / sides;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z * height);
    }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    mesh.triangles.push_back({k, next, sides + next});
    mesh.triangles.push_back({k, sides + next, sides + k});
    if (k == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, k});
    mesh.triangles.push_back({sides, sides + k, sides + next});
  }
  return mesh;
}

/// Sides at an angle of 60 degrees, from an edge through zero.
Mesh wedge(double length, double height) {
  Mesh mesh;
  for (const double z : {0., height}) {
    mesh.vertices.emplace_back(0, 0, z);
    mesh.vertices.emplace_back(length, 0, z);
    mesh.vertices.emplace_back(0.5 * length, std::sqrt(0.75) * length, z);
  }
  mesh.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  return mesh;
}

Mesh tetrahedron(double size) {
  Mesh mesh;
  for (const Vector<3>& p : {Vector<3>(1, 1, 1), {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}})
    mesh.vertices.push_back(size * p);
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

std::string why_not(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "taken";
}

/// The half-spaces of random planes around zero.
std::vector<HalfSpace> random_planes(std::mt19937_64& random, int count) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> depth(-0.3, 1.1);
  std::vector<HalfSpace> planes;
  for (int k = 0; k < count; ++k) {
    const Vector<3> n = Vector<3>(normal(random), normal(random), normal(random)).normalized();
    planes.push_back({n, depth(random)});
  }
  return planes;
}

TEST(ConvexPart, VolumesOfPiecesInBoxesAreThoseInCellsOfGrids) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> place(-1.5, 1.5);
  for (int n = 0; n < 300; ++n) {
    Bounds<3> box;
    for (int k = 0; k < 3; ++k) {
      const double a = place(random), b = place(random);
      box.lower[k] = std::min(a, b);
      box.upper[k] = std::max(a, b);
    }
    const double r = 0.9;
    const Vector<3> center(place(random), place(random), place(random));
    BallInCells ball;
    for (int k = 0; k < 3; ++k)
      ball.planes[static_cast<std::size_t>(k)] = {(box.lower[k] - center[k]) / r,
                                                  (box.upper[k] - center[k]) / r};
    double volume = 0;
    ball.add(r * r * r, box.volume(), &volume, 1, 1);
    const auto piece = piece_in(part_of_box(box), center, r);
    EXPECT_NEAR(piece ? volume_of(*piece) : 0, volume, 1e-12) << n;
  }
}

TEST(ConvexPart, PlanesDivideVolumesOfPieces) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int n = 0; n < 300; ++n) {
    Piece piece{.center = Vector<3>(place(random), place(random), place(random)), .radius = 1};
    for (HalfSpace plane : random_planes(random, 1 + n % 9)) {
      plane.offset += plane.normal.dot(piece.center);
      const double before = volume_of(piece);
      Piece other = piece;
      piece.cuts.push_back({plane, 0});
      other.cuts.push_back({{-plane.normal, -plane.offset}, 1});
      EXPECT_NEAR(volume_of(piece) + volume_of(other), before, 1e-12) << n;
    }
  }
}

TEST(ConvexPart, VolumesOfPiecesAreThoseThatSamplesFind) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int n = 0; n < 12; ++n) {
    Piece piece{.radius = 1};
    for (const HalfSpace& plane : random_planes(random, 4 + n)) piece.cuts.push_back({plane, 0});
    constexpr int samples = 100000;
    int inside = 0;
    for (int k = 0; k < samples; ++k) {
      const Vector<3> p(place(random), place(random), place(random));
      inside += p.norm() < 1 && std::ranges::all_of(piece.cuts, [&](const Cut& cut) {
                  return cut.keeps.normal.dot(p) < cut.keeps.offset;
                });
    }
    const double share = static_cast<double>(inside) / samples, deviation = std::sqrt(share / samples);
    EXPECT_NEAR(volume_of(piece), 8 * share, 8 * (4 * deviation + 1e-4)) << n;
  }
}

TEST(ConvexPart, TrianglesOfAMeshAreJoinedToFaces) {
  const auto expect = [](const Mesh& mesh, std::size_t faces, std::size_t edges, std::size_t corners) {
    const ConvexPart part = part_bounded_by(mesh);
    EXPECT_EQ(part.faces.size(), faces);
    EXPECT_EQ(part.edges.size(), edges);
    EXPECT_EQ(part.corners.size(), corners);
    EXPECT_NEAR(volume_of(part.domain()), volume_of(Domain(mesh)), 1e-6 * volume_of(Domain(mesh)));
    for (const ConvexPart::Edge& edge : part.edges) {
      EXPECT_EQ(part.edge_between(edge.faces[0], edge.faces[1]),
                part.edge_between(edge.faces[1], edge.faces[0]));
      for (const std::uint32_t face : edge.faces)
        for (const std::uint32_t corner : edge.corners)
          EXPECT_NEAR(part.faces[face].keeps.normal.dot(part.corners[corner].point),
                      part.faces[face].keeps.offset, 1e-6);
    }
    EXPECT_LT(part.height(part.bounds().center()), 0);
  };
  const auto in_single = [](Mesh mesh) {  // as STL has coordinates
    move_vertices(mesh, [](const Vector<3>& p) -> Vector<3> { return p.cast<float>().cast<double>(); });
    return mesh;
  };
  const Vector<3> away(7, -3, 5);
  expect(in_single(moved(cube(3), tilted, away)), 6, 12, 8);
  expect(in_single(moved(prism(6, 2, 3), tilted, away)), 8, 18, 12);
  expect(in_single(moved(prism(48, 2, 3), tilted, away)), 50, 144, 96);
  expect(in_single(moved(wedge(3, 4), tilted, away)), 5, 9, 6);
  expect(in_single(moved(tetrahedron(2), tilted, away)), 4, 6, 4);
  EXPECT_FALSE(part_bounded_by(moved(cube(3), tilted, away)).is_box);
  EXPECT_TRUE(part_bounded_by(cube(3)).is_box);
}

TEST(ConvexPart, PlanesClosePartsWithCornersOfManyFaces) {
  const Bounds<3> around{Vector<3>::Constant(-100), Vector<3>::Constant(100)};
  std::vector<HalfSpace> pyramid = {{-Vector<3>::UnitZ(), 0}};
  for (int k = 0; k < 6; ++k) {
    const Vector<3> outward(std::cos(pi * k / 3), std::sin(pi * k / 3), 0);
    pyramid.push_back({std::sqrt(0.5) * (outward + Vector<3>::UnitZ()), std::sqrt(2.)});  // apex at z = 2
  }
  const ConvexPart part = part_between(pyramid, around);
  EXPECT_EQ(part.faces.size(), 7u);
  EXPECT_EQ(part.corners.size(), 7u);
  EXPECT_NEAR(volume_of(part.domain()), 2 * std::sqrt(3.) * 4 * 2 / 3, 1e-9);
  pyramid.push_back({Vector<3>::UnitZ(), 3});  // cuts nothing off
  EXPECT_EQ(part_between(pyramid, around).faces.size(), 7u);
  pyramid.back().offset = -1;
  EXPECT_NE(why_not([&] { part_between(pyramid, around); }).find("holds nothing"), std::string::npos);
  pyramid.pop_back();
  pyramid.erase(pyramid.begin());
  EXPECT_NE(why_not([&] { part_between(pyramid, around); }).find("in the direction ("), std::string::npos);
}

TEST(ConvexPart, RefusesWhatIsNotClosedOrNotConvex) {
  // An L of two boxes: the hollow edge is at x = 1, y = 1.
  Mesh step;
  for (const double z : {0., 1.})
    for (const Vector<2>& p : {Vector<2>(0, 0), {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})
      step.vertices.emplace_back(p[0], p[1], z);
  for (std::uint32_t k = 0; k < 6; ++k) {
    const std::uint32_t next = (k + 1) % 6;
    step.triangles.push_back({k, next, 6 + next});
    step.triangles.push_back({k, 6 + next, 6 + k});
  }
  for (const FaceCorners& t : {FaceCorners{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    step.triangles.push_back({t[0], t[2], t[1]});
    step.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  EXPECT_NE(why_not([&] { part_bounded_by(step); }).find("is not convex at (1, 1, 0.5)"), std::string::npos)
      << why_not([&] { part_bounded_by(step); });
  Mesh two = cube(1);
  append(two, moved(cube(1), tilted, Vector<3>(5, 0, 0)));
  EXPECT_NE(why_not([&] { part_bounded_by(two); }).find("not convex"), std::string::npos);
  Mesh hollow = cube(3), inner = cube(1);
  turn_inside_out(inner);
  append(hollow, inner);
  EXPECT_NE(why_not([&] { part_bounded_by(hollow); }).find("not convex"), std::string::npos);
  Mesh open = cube(1);
  open.triangles.pop_back();
  EXPECT_NE(why_not([&] { part_bounded_by(open); }).find("not closed at"), std::string::npos);
  EXPECT_NE(why_not([&] { part_bounded_by(Mesh{}); }).find("holds nothing"), std::string::npos);
  EXPECT_NE(why_not([&] {
              part_of_box({Vector<3>(0, 0, 0), Vector<3>(1, 0, 1)});
            }).find("holds nothing"),
            std::string::npos);
}

TEST(NearFaces, TiltedPartsAreAsNearAsTheyAreUpright) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(-2.5, 2.5);
  const Vector<3> to(3, 1, -2);
  const ConvexPart upright = part_bounded_by(cube(3)), part = part_bounded_by(moved(cube(3), tilted, to));
  const Bounds<3> box = upright.bounds();
  int changed = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vector<3> p(place(random), place(random), place(random));
    const double radius = NearFaces(box, p).clear_radius(1, 0.01);
    changed += radius < 1;
    EXPECT_EQ(NearFaces(upright, p).clear_radius(1, 0.01), radius);
    EXPECT_NEAR(NearFaces(part, tilted * p + to).clear_radius(1, 0.01), radius, 1e-9);
    EXPECT_NEAR(part.distance(tilted * p + to), upright.distance(p), 1e-9);
  }
  EXPECT_GT(changed, 200);
}

TEST(NearFaces, SpheresKeepFartherFromSharpEdges) {
  const auto cleared = [](double degrees, double radius) {
    const double half = degrees * pi / 360;
    const std::array<HalfSpace, 5> planes = {{{Vector<3>(-std::sin(half), std::cos(half), 0), 0},
                                              {Vector<3>(-std::sin(half), -std::cos(half), 0), 0},
                                              {Vector<3>::UnitX(), 40},
                                              {Vector<3>::UnitZ(), 20},
                                              {-Vector<3>::UnitZ(), 20}}};
    const ConvexPart part = part_between(planes, {Vector<3>::Constant(-100), Vector<3>::Constant(100)});
    return NearFaces(part, Vector<3>(1, 0, 0)).clear_radius(radius, 0.01);  // 1 from the sharp edge
  };
  EXPECT_EQ(cleared(60, 1.07), 1.07);
  EXPECT_NEAR(cleared(60, 1), 1 / (1 + 0.03 * std::sqrt(2)), 1e-12);
  EXPECT_EQ(cleared(90.01, 0.97), 0.97);
  EXPECT_LT(cleared(30, 1.07), 0.93);
  EXPECT_EQ(cleared(30, 1.16), 1.16);
  for (int k = 0; k < 3000; ++k) EXPECT_LE(cleared(20 + 0.02 * k, 1), 1);  // rounding ends everywhere
}

// Meshes

InnerSpheres shells_in(const Spheres<dynamic>& spheres, double share) {
  InnerSpheres shells{.first = {0}, .radius = {}};
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    shells.radius.push_back(share * spheres.r[i]);
    shells.first.push_back(shells.radius.size());
  }
  return shells;
}

Solids scattered(double edge, unsigned seed) {
  const Domain period = periodic_box(Vector<3>::Constant(edge));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, edge), size(0.8, 1);
  const Boundary<3> boundary = boundary_of<3>(period);
  Spheres<dynamic> spheres(3);
  for (int t = 0; t < 3000; ++t) {
    const Vector<3> p(place(random), place(random), place(random));
    const double r = size(random);
    bool is_free = true;
    for (std::size_t j = 0; j < spheres.size() && is_free; ++j)
      is_free = boundary.minimum_image(p - spheres.center(j)).norm() > 1.03 * (r + spheres.r[j]);
    if (is_free) spheres.push_back(p, r);
  }
  return solids_of(spheres, period,
                   {.contact = ContactTreatment::gap, .gap = 0.01, .shells = shells_in(spheres, 0.9)});
}

/// Every region is bounded by a closed surface.
void expect_closed(const ConformingSurface& surface) {
  std::map<std::pair<std::int32_t, std::array<std::uint32_t, 2>>, int> sense;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const std::size_t side : {0, 1}) {
      const std::int32_t region = surface.patches[surface.patch[t]].regions[side];
      if (region == SurfacePatch::nothing) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
        sense[{region, {std::min(a, b), std::max(a, b)}}] += (a < b) == (side == 0) ? 1 : -1;
      }
    }
  std::size_t open = 0;
  for (const auto& [edge, sum] : sense) open += sum != 0;
  EXPECT_EQ(open, 0u);
}

void expect_good_mesh(const Mesh& shape, const Solids& whole) {
  const ConvexPart part = part_bounded_by(shape);
  const CutOut cut = cut_out(whole, part, 0.01);
  ASSERT_GT(cut.solids.spheres.size(), 8u);
  const double volume = volume_of(Domain(shape));
  for (const bool with_solids : {false, true}) {
    const ConformingSurface surface = conforming_surface(cut.solids, {.per_gap = 4, .solids = with_solids});
    expect_closed(surface);
    FillReport report;
    VolumeMesh mesh = fill_with_layers(surface, {}, report);
    EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
    const double stated = *mesh.regions[0].volume;
    EXPECT_NEAR(volumes_of_regions(mesh)[0] / stated, 1, 0.03);
    make_second_order(mesh);
    EXPECT_NEAR(curved_volumes_of_regions(mesh)[0] / stated, 1, 2e-3);
    if (!with_solids) continue;
    double sum = 0, stated_sum = 0;
    for (const double of_region : curved_volumes_of_regions(mesh)) sum += of_region;
    for (const MeshRegion& region : mesh.regions) stated_sum += *region.volume;
    EXPECT_NEAR(sum / volume, 1, 1e-9);
    EXPECT_NEAR(stated_sum / volume, 1, 1e-9);
  }
}

TEST(CutOut, FacesOfTiltedBoxesCutSpheresAndLayers) {
  NEEDS_TETGEN();
  expect_good_mesh(moved(cube(4), tilted, Vector<3>(1, 2, 3)), scattered(6, 5));
}

TEST(CutOut, FacesOfPrismsCutSpheresAndLayers) {
  NEEDS_TETGEN();
  expect_good_mesh(moved(prism(6, 2.5, 4), tilted, Vector<3>(1, 2, 3)), scattered(6, 6));
}

TEST(CutOut, FacesOfWedgesCutSpheresAndLayers) {
  NEEDS_TETGEN();
  expect_good_mesh(moved(wedge(5, 4), tilted, Vector<3>(1, 2, 3)), scattered(6, 7));
}

TEST(CutOut, FacesOfTetrahedraCutSpheresAndLayers) {
  NEEDS_TETGEN();
  expect_good_mesh(moved(tetrahedron(2.4), tilted, Vector<3>(1, 2, 3)), scattered(6, 8));
}

TEST(CutOut, ManyNarrowFacesCutOneSphere) {
  NEEDS_TETGEN();
  expect_good_mesh(moved(prism(24, 2.6, 4), tilted, Vector<3>(1, 2, 3)), scattered(6, 9));
}

TEST(CutOut, NarrowFacesLieWithinBalls) {
  NEEDS_TETGEN();
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0, 0, 0), 1);
  const Solids whole = solids_of(spheres, periodic_box(Vector<3>::Constant(8)),
                                 {.contact = ContactTreatment::gap, .gap = 0.01});
  const ConvexPart part = part_bounded_by(moved(prism(24, 2, 0.5), tilted, tilted * Vector<3>(-2, 0.1, 0)));
  const CutOut cut = cut_out(whole, part, 0.01);
  ASSERT_EQ(cut.solids.spheres.size(), 1u);
  const ConformingSurface surface = conforming_surface(cut.solids, {.per_gap = 4, .solids = true});
  expect_closed(surface);
  FillReport report;
  VolumeMesh mesh = fill_with_layers(surface, {}, report);
  EXPECT_GT(quality_of(mesh).least_sicn, 0.1);
  make_second_order(mesh);
  const std::vector<double> volumes = curved_volumes_of_regions(mesh);
  for (const std::size_t region : {0, 1})
    EXPECT_NEAR(volumes[region] / *mesh.regions[region].volume, 1, 5e-3);
}

}  // namespace convex_part_test
}  // namespace bernal

// Facets of curved walls that are triangulated as one: which are joined, and what comes of it.
#include "meshes/smooth_walls.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "domain/revolved_surface.hpp"
#include "geometry/edges.hpp"
#include "meshes/conforming_surface.hpp"

namespace bernal {
namespace smooth_walls_test {

constexpr double pi = std::numbers::pi;

Mesh cylinder(double radius, double height, int sides) {
  return surface_of(Revolved{.profile = {{0, 0}, {radius, 0}, {radius, height}, {0, height}}}, sides);
}

SmoothWalls joined(const Mesh& mesh, double tolerance) {
  const PlanarWalls walls = flat_walls_of(mesh);
  return smooth_walls_of(mesh, walls, tolerance, std::vector<char>(walls.parts.size(), 0));
}

TEST(SmoothWalls, FineFacetsAreJoinedAndWideOnesAreNot) {
  const Mesh fine = cylinder(10, 20, 256), wide = cylinder(10, 20, 16);
  const SmoothWalls walls = joined(fine, 0.01);
  EXPECT_EQ(joined(wide, 0.01).parts.size(), 18u);
  // Each reaches 25 degrees to both sides, so eight would be enough, with floor and lid.
  EXPECT_GE(walls.parts.size(), 7u);
  EXPECT_LE(walls.parts.size(), 14u);
  const PlanarWalls flat = flat_walls_of(fine);
  for (const SmoothPart& part : walls.parts)
    for (const std::uint32_t p : part.parts)
      EXPECT_GE(flat.parts[p].outward.dot(part.frame.outward), std::cos(38.01 * pi / 180));
  // Lines along the floor and the lid, and those between the parts of the side.
  const std::size_t around = walls.parts.size() - 2;
  ASSERT_EQ(walls.edges.size(), 3 * around);
  double length = 0;
  for (const SmoothEdge& edge : walls.edges) length += edge.length();
  const double rim = 256 * 2 * 10 * std::sin(pi / 256);
  EXPECT_NEAR(length, 2 * rim + 20 * static_cast<double>(around), 1e-9);
  // An edge of this length rises above its arc by the tolerance.
  for (std::size_t p = 0; p < flat.parts.size(); ++p)
    if (std::abs(flat.parts[p].outward[2]) < 0.5) {
      EXPECT_NEAR(walls.longest[p], std::sqrt(8 * 0.01 * 10), 0.01);
    }
}

TEST(SmoothWalls, PartsThatAreKeptApartStayPlanar) {
  const Mesh mesh = cylinder(10, 20, 256);
  const PlanarWalls flat = flat_walls_of(mesh);
  std::vector<char> apart(flat.parts.size(), 0);
  apart[3] = apart[4] = 1;
  const SmoothWalls walls = smooth_walls_of(mesh, flat, 0.01, apart);
  for (const std::uint32_t p : {3u, 4u}) {
    EXPECT_TRUE(walls.parts[walls.of_flat_part[p]].is_planar());
    EXPECT_TRUE(std::isinf(walls.longest[p]));
  }
}

TEST(SmoothWalls, PointsAreFoundOverThePlane) {
  const Mesh mesh = cylinder(10, 20, 256);
  const PlanarWalls flat = flat_walls_of(mesh);
  std::vector<std::vector<std::uint32_t>> triangles(flat.parts.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) triangles[flat.part_of_triangle[t]].push_back(t);
  const SmoothWalls walls = joined(mesh, 0.01);
  for (const SmoothPart& part : walls.parts) {
    if (part.is_planar()) continue;
    const SmoothSurface surface(mesh, part, triangles);
    for (const std::uint32_t p : part.parts)
      for (const std::uint32_t t : triangles[p]) {
        Vector<3> middle = Vector<3>::Zero();
        for (const std::uint32_t corner : mesh.triangles[t]) middle += mesh.vertices[corner] / 3;
        const SmoothSurface::Place place = surface.over(surface.flat(middle));
        EXPECT_NEAR((place.point - middle).norm(), 0, 1e-12);
        EXPECT_EQ(place.flat_part, p);
        // Beside the part: what is over its nearest point.
        EXPECT_LT(std::abs(surface.over({1e3, 0, 0}).height), 10);
      }
  }
}

/// Six small spheres in a large cylinder of needles: with facets kept, 256 of them, 20 high and 0.25 wide,
/// would have some 80 points along each edge, and twice as many triangles in each.
TEST(SmoothWalls, FewSpheresTakeFewTriangles) {
  const Mesh mesh = cylinder(10, 20, 256);
  Solids solids{.spheres = Spheres<dynamic>(3), .domain = mesh, .pieces = {}, .bridges = {}, .contacts = {}};
  for (int k = 0; k < 6; ++k)
    solids.spheres.push_back(Vector<3>(9.4 * std::cos(k), 9.4 * std::sin(k), 3 + 2 * k), 0.4);
  solids.pieces = pieces_of(solids.spheres, solids.domain);
  const ConformingSurface made = conforming_surface(solids, {});
  std::size_t on_walls = 0;
  for (const std::uint32_t patch : made.patch)
    on_walls += made.patches[patch].kind == SurfacePatch::Kind::wall ? 1 : 0;
  EXPECT_GT(on_walls, 500u);
  EXPECT_LT(on_walls, 256u * 2 * 80 / 3);
  EXPECT_GT(made.statement.least_angle, 18);
  EXPECT_GT(made.statement.wall_deviation, 0);
  EXPECT_LE(made.statement.wall_deviation, 2 * 0.02 * 0.4);
  // Closed, and as large as the part but for what is cut off along its side.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const FaceCorners& t : made.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  for (const auto& [edge, sum] : sides) EXPECT_EQ(sum, 0);
  const double fluid = volume_of(solids.domain) - 6 * 4 * pi / 3 * std::pow(0.4, 3);
  EXPECT_NEAR(made.statement.fluid_volume, fluid, 1e-6);
  EXPECT_NEAR(made.statement.meshed_fluid_volume, fluid, 0.008 * 2 * pi * 10 * 20 + 0.5);
}

}  // namespace smooth_walls_test
}  // namespace bernal

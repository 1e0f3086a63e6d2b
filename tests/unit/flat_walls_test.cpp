// Walls that are triangles: their planar parts, the straight edges between them, and where bridges may stand.
#include "meshes/flat_walls.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "bernal/cad/mesh_container.hpp"
#include "domain/revolved_surface.hpp"
#include "geometry/changes.hpp"
#include "meshes/delaunay.hpp"
#include "support/hopper.hpp"

namespace bernal {
namespace flat_walls_test {

/// A cube of edge 4 whose triangles are each cut in four, `times` times.
Mesh cut_cube(int times) {
  Mesh mesh = mesh_of_box({Vector<3>::Zero(), Vector<3>::Constant(4)});
  for (int t = 0; t < times; ++t) {
    std::vector<FaceCorners> finer;
    for (const FaceCorners& c : mesh.triangles) {
      const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
      for (std::size_t k = 0; k < 3; ++k)
        mesh.vertices.push_back(0.5 * (mesh.vertices[c[k]] + mesh.vertices[c[(k + 1) % 3]]));
      finer.insert(finer.end(),
                   {{c[0], n, n + 2}, {c[1], n + 1, n}, {c[2], n + 2, n + 1}, {n, n + 1, n + 2}});
    }
    mesh.triangles = finer;
    weld_equal_points(mesh);
  }
  return mesh;
}

TEST(PlanarWalls, PartsAndEdgesAreThoseOfTheShape) {
  for (const int times : {0, 1, 3}) {
    const Mesh cube = cut_cube(times);
    const PlanarWalls walls = flat_walls_of(cube);
    EXPECT_EQ(walls.parts.size(), 6u);
    ASSERT_EQ(walls.edges.size(), 12u);
    for (const FlatEdge& edge : walls.edges) {
      EXPECT_NEAR((cube.vertices[edge.corners[0]] - cube.vertices[edge.corners[1]]).norm(), 4, 1e-12);
      EXPECT_NE(edge.parts[0], edge.parts[1]);
    }
    for (const FlatPart& part : walls.parts) {
      EXPECT_NEAR((part.origin - Vector<3>::Constant(2)).dot(part.outward), 2, 1e-12);
      EXPECT_NEAR((part.u.cross(part.v) - part.outward).norm(), 0, 1e-12);
    }
  }
  // Four sides of the spout, of the pyramid and of the bin, floor and lid; edges of a box and two rings more.
  const PlanarWalls walls = flat_walls_of(testing::hopper());
  EXPECT_EQ(walls.parts.size(), 14u);
  EXPECT_EQ(walls.edges.size(), 28u);
}

TEST(PlanarWalls, ASideOfManyFacesHasAPartForEach) {
  const Revolved cone{.profile = {{0, 0}, {1, 0}, {2, 3}, {0, 3}}};
  const PlanarWalls walls = flat_walls_of(surface_of(cone, 32));
  EXPECT_EQ(walls.parts.size(), 34u);
  EXPECT_EQ(walls.edges.size(), 96u);
}

TEST(PlanarWalls, BridgesStandWithinParts) {
  const Mesh cube = cut_cube(2);
  const PlanarWalls walls = flat_walls_of(cube);
  const FlatFeet feet(cube, walls, local_container(Domain(cube), nullptr));
  // On the floor, half a radius and more from the wall: the triangles of the floor make no difference.
  for (const double x : {1.0, 1.37, 2.0}) {
    const auto near = feet.near({x, 2.1, 1}, 1, 1.01);
    ASSERT_EQ(near.size(), x == 1.0 ? 2u : 1u);
    for (const FlatFeet::Foot& foot : near) {
      EXPECT_NEAR(foot.distance, 1, 1e-12);
      EXPECT_NEAR(foot.room, 0.5, 1e-12);
      EXPECT_EQ(FlatFeet::radius_in(foot, 0.2, 0.15), 0.2);
    }
  }
  EXPECT_NEAR(FlatFeet::radius_in({0, 1, 0.2}, 0.2, 0.15), 0.125, 1e-12);
  EXPECT_EQ(FlatFeet::radius_in({0, 1, 0.17}, 0.2, 0.15), 0);
}

TEST(PlanarWalls, SpheresWithoutRoomForABridgeGetAGap) {
  const Mesh hopper = testing::hopper();
  // Where the spout ends, an edge stands out into the hopper.
  const Vector<3> edge(0.125, 0, 0.15), slope = Vector<3>(0.375, 0, 0.45).normalized();
  const Vector<3> away = (Vector<3>(-1, 0, 0) + Vector<3>(-slope[2], 0, slope[0])).normalized();
  Spheres<dynamic> spheres(3);
  spheres.push_back(edge + 0.05 * away, 0.05);
  spheres.push_back(Vector<3>(0, 0, 1.35), 0.05);  // on the lid
  const SolidsOptions options{.contact = ContactTreatment::bridge, .gap = 0.01, .bridge_radius = 0.2};
  const SolidsInWalls made = solids_in_walls(spheres, hopper, options, 0.15);
  EXPECT_EQ(made.gaps_at_edges, 1u);
  EXPECT_NEAR(made.solids.spheres.r[0], 0.05 / 1.01, 1e-9);
  EXPECT_NEAR(made.largest_shrink, 1 - 1 / 1.01, 1e-6);
  EXPECT_EQ(made.solids.spheres.r[1], 0.05);
  EXPECT_EQ(solids_in_walls(spheres, hopper, {.contact = ContactTreatment::none}, 0.15).gaps_at_edges, 0u);
}

TEST(PlanarWalls, SolidsOfRevolutionAreWithinFacets) {
  const Revolved cone{.profile = {{0, 0}, {1, 0}, {2, 3}, {0, 3}}};
  Spheres<dynamic> spheres(3);
  spheres.push_back(Vector<3>(0, 0, 1), 0.5);
  const SolidsInWalls made = solids_in_walls(spheres, cone, {.contact = ContactTreatment::bridge}, 0.15);
  ASSERT_TRUE(std::holds_alternative<Mesh>(made.solids.domain));
  EXPECT_GT(made.wall_deviation, 0);
  EXPECT_LE(made.wall_deviation, 0.01);
  EXPECT_GT(volume_of(made.solids.domain), volume_of(Domain(cone)));
  // All sides are farther away by the same share: the volume by its square.
  const double share = 1 + made.wall_deviation / 2;
  EXPECT_LT(volume_of(made.solids.domain), volume_of(Domain(cone)) * share * share);
  EXPECT_EQ(made.gaps_at_edges, 0u);
}

TEST(PlanarWalls, EdgesThatNoTriangleHasAreRecovered) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> place(-1, 1);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vector<3>> points{{-1, 0, 0}, {1, 0, 0}, {0.9, 0.1, 0}, {-0.9, -0.1, 0}};
    while (points.size() < 60) {
      const Vector<3> p(place(engine), 0.05 * place(engine), 0);
      if (std::abs(p[1]) > 1e-3) points.push_back(p);
    }
    Delaunay delaunay(Delaunay::Surface::plane, 1);
    ASSERT_TRUE(delaunay.begin(points));
    const std::array<std::array<std::uint32_t, 2>, 1> edge = {{{0, 1}}};
    EXPECT_FALSE(delaunay.bind(edge));
    ASSERT_TRUE(delaunay.recover(edge));
    std::size_t bound = 0;
    double area = 0;
    for (const Delaunay::Face& f : delaunay.faces()) {
      if (!f.is_alive || !delaunay.is_finite(f)) continue;
      const Vector<3>& a = delaunay.points()[f.corners[0]];
      const double twice =
          (delaunay.points()[f.corners[1]] - a).cross(delaunay.points()[f.corners[2]] - a)[2];
      EXPECT_GT(twice, 0);
      area += 0.5 * twice;
      for (std::size_t k = 0; k < 3; ++k) bound += f.bound[k];
    }
    EXPECT_EQ(bound, 2u);
    // A second edge across the first is none that can be had.
    const std::array<std::array<std::uint32_t, 2>, 1> across = {{{2, 3}}};
    EXPECT_FALSE(delaunay.recover(across));
    EXPECT_GT(area, 0);
  }
}

}  // namespace flat_walls_test
}  // namespace bernal

// Edges, parts and measures of meshes whose answers are known.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/changes.hpp"
#include "geometry/edges.hpp"
#include "geometry/measures.hpp"
#include "geometry/point_numbers.hpp"
#include "geometry/topology.hpp"

namespace bernal {
namespace geometry_test {

const Mesh box = mesh_of_box({{0, 0, 0}, {1, 2, 3}});

TEST(MeshEdges, AreSortedByTheirEndsEachWithItsTriangles) {
  std::size_t edges = 0, uses = 0;
  std::pair<std::uint32_t, std::uint32_t> last{0, 0};
  MeshEdges(box.triangles).for_each([&](std::span<const EdgeUse> at) {
    ++edges;
    uses += at.size();
    const std::pair ends(at.front().low, at.front().high);
    EXPECT_LT(last, ends);
    last = ends;
    for (const EdgeUse& use : at) {
      const FaceCorners& t = box.triangles[use.triangle];
      const std::uint32_t from = t[use.side], to = t[(use.side + 1U) % 3];
      EXPECT_EQ(std::pair(std::min(from, to), std::max(from, to)), ends);
      EXPECT_EQ(use.upwards, from < to);
    }
  });
  EXPECT_EQ(edges, 18u);
  EXPECT_EQ(uses, 36u);
  const MeshEdges map(box.triangles);
  EXPECT_EQ(map.triangles_at(0, 1), 2u);
  EXPECT_EQ(map.triangles_at(2, 1), 2u);  // a diagonal
  EXPECT_EQ(map.triangles_at(0, 3), 0u);
}

TEST(MeshEdges, OpenOnesStandInTheOrderOfTheirTriangles) {
  Mesh open = box;
  EXPECT_TRUE(open_edges(open.triangles).empty());
  open.triangles.erase(open.triangles.begin() + 3);  // {5, 7, 6}
  std::vector<std::array<std::uint32_t, 3>> found;
  for (const EdgeUse& use : open_edges(open.triangles)) found.push_back({use.low, use.high, use.triangle});
  EXPECT_EQ(found, (std::vector<std::array<std::uint32_t, 3>>{{5, 6, 2}, {6, 7, 6}, {5, 7, 10}}));
}

TEST(MeshTopology, TellsClosedComponents) {
  Mesh two = box;
  append(two, box);
  two.triangles.pop_back();
  const MeshTopology topology = topology_of(two);
  EXPECT_EQ(topology.components, 2u);
  EXPECT_EQ(topology.closed_components(), (std::vector<bool>{true, false}));
  EXPECT_FALSE(is_convex(two));
  EXPECT_TRUE(is_convex(box));
}

TEST(MeshChanges, SplitGivesEachPartTheVerticesThatItUses) {
  Mesh two = box;
  append(two, box);
  move_vertices(two, [](const Vector<3>& v) -> Vector<3> { return 2 * v; });
  const std::vector<Mesh> parts = split(two, topology_of(two).component, 2);
  ASSERT_EQ(parts.size(), 2u);
  for (const Mesh& part : parts) {
    EXPECT_EQ(part.vertices.size(), 8u);
    EXPECT_EQ(part.triangles, parts.front().triangles);
    EXPECT_EQ(signed_volume(part), 48);
    EXPECT_EQ(area_of(part), 88);
  }
  weld_equal_points(two);
  EXPECT_EQ(two.vertices.size(), 8u);
  turn_inside_out(two);
  EXPECT_EQ(signed_volume(two), -96);
}

TEST(PointNumbers, CountPlacesNotSigns) {
  PointNumbers<Vector<3>> numbers;
  EXPECT_EQ(numbers.of({0, 1, 2}), 0u);
  EXPECT_EQ(numbers.of({0, 1, std::nextafter(2, 3)}), 1u);
  EXPECT_EQ(numbers.of({-0.0, 1, 2}), 0u);
  EXPECT_EQ(numbers.points.size(), 2u);
}

TEST(MeshMeasures, BoundsAreThoseOfWhatIsAsked) {
  Mesh mesh = box;
  mesh.vertices.emplace_back(9, 9, 9);
  EXPECT_EQ(bounds_of(mesh).upper, Vector<3>(9, 9, 9));
  EXPECT_EQ(bounds_of_faces(mesh).upper, Vector<3>(1, 2, 3));
  EXPECT_EQ(bounds_of(mesh, {0, 1, 2}).upper, Vector<3>(1, 2, 0));
  EXPECT_TRUE(bounds_of(mesh, {0, 1, 2}).meets(bounds_of(mesh, {2, 3, 7})));
  EXPECT_FALSE(bounds_of(mesh, {0, 1, 2}).meets(bounds_of(mesh, {4, 5, 6})));
}

}  // namespace geometry_test
}  // namespace bernal

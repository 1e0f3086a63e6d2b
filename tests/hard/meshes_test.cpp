// Meshes that go wrong elsewhere. Each is either a container of the right volume or refused for the right
// reason.
#include <gtest/gtest.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/error.hpp"
#include "bernal/core/random.hpp"
#include "support/folder.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace meshes_test {

using namespace test;

class HardMesh : public ::testing::Test {
 protected:
  ImportedMesh imported(const Mesh& mesh) {
    return read_mesh({.file = folder.write("mesh.off", as_off(mesh))});
  }
  MeshReport diagnosed(const Mesh& mesh) { return imported(mesh).report; }

  /// Usable, with this volume to the rounding of sums over a box of this size, before and after import.
  void expect_volume(const Mesh& mesh, double volume, double rounding = 1e-13) {
    const ImportedMesh result = imported(mesh);
    EXPECT_TRUE(result.report.usable()) << (result.report.problems.empty() ? "" : result.report.problems[0]);
    EXPECT_NEAR(result.report.volume, volume, rounding * volume);
    EXPECT_NEAR(volume_of(result.mesh), volume, rounding * volume);
  }

  bernal::testing::Folder folder;
  const Mesh box = box_mesh({0, 0, 0}, {1, 1, 1});
};

TEST_F(HardMesh, MissingFaces) {
  Mesh mesh = box;
  mesh.triangles.pop_back();
  EXPECT_EQ(diagnosed(mesh).open_edges, 3U);
  EXPECT_EQ(diagnosed(mesh).problems.front(), "3 open edges");
  mesh.triangles.pop_back();  // one of the bottom as well
  EXPECT_EQ(diagnosed(mesh).open_edges, 6U);
}

TEST_F(HardMesh, TJunction) {
  Mesh mesh = box;
  const auto [i, j, k] = mesh.triangles.back();
  mesh.vertices.push_back(0.5 * (mesh.vertices[i] + mesh.vertices[j]));
  mesh.triangles.back() = {i, index(mesh.vertices.size() - 1), k};
  mesh.triangles.push_back({index(mesh.vertices.size() - 1), j, k});
  expect_volume(mesh, 1);  // the neighbour's edge is split
}

TEST_F(HardMesh, CornersThatDifferByAMillionth) {
  std::string stl = as_text_stl(box);
  stl.replace(stl.find("vertex 0 0 0"), 12, "vertex 1e-6 0 0");
  const MeshReport report = read_mesh({.file = folder.write("mesh.stl", stl)}).report;
  EXPECT_EQ(report.vertices, 8U);
  EXPECT_TRUE(report.usable());
}

TEST_F(HardMesh, InsideOut) {
  expect_volume(inverted(box), 1);
  EXPECT_EQ(diagnosed(inverted(box)).orientation, "inward");
  EXPECT_EQ(diagnosed(inverted(box)).repairs.back(), "turned 12 faces outward");
}

TEST_F(HardMesh, ABodyInAnotherIsTakenForAVoid) {
  const Mesh small = translated(scaled(box, 0.5), {0.25, 0.25, 0.25});
  for (const bool drawn_as_body : {false, true}) {
    const Mesh mesh = joined(box, drawn_as_body ? small : inverted(small));
    expect_volume(mesh, 0.875);
    const std::vector<std::string> repairs = diagnosed(mesh).repairs;
    if (drawn_as_body)
      EXPECT_EQ(repairs.back(), "turned 12 faces, and took 1 body inside others for voids");
    else
      EXPECT_TRUE(repairs.empty());
  }
}

TEST_F(HardMesh, RandomFlips) {
  Mesh mesh = icosphere_mesh(1, 2);
  const double volume = volume_of(mesh);
  Random random(1, 0);
  for (auto& t : mesh.triangles)
    if (random.uniform() < 0.3) std::swap(t[0], t[1]);
  expect_volume(mesh, volume);
  EXPECT_GT(diagnosed(mesh).misoriented_edges, 50U);
  EXPECT_EQ(diagnosed(mesh).orientation, "mixed");
}

TEST_F(HardMesh, RepeatedFaces) {
  Mesh mesh = box;
  mesh.triangles.push_back(mesh.triangles[3]);
  expect_volume(mesh, 1);
  EXPECT_EQ(diagnosed(mesh).duplicate_faces, 1U);
  expect_volume(joined(box, box), 1);  // every face twice
  EXPECT_EQ(diagnosed(joined(box, box)).duplicate_faces, 12U);
}

TEST_F(HardMesh, AFaceAndItsReverse) {
  Mesh mesh = box;
  const auto [i, j, k] = mesh.triangles[0];
  mesh.triangles.push_back({i, k, j});
  expect_volume(mesh, 1);  // one of the two goes
}

TEST_F(HardMesh, CubesThatShareAFace) {
  EXPECT_EQ(diagnosed(joined(box, translated(box, {1, 0, 0}))).non_manifold_edges, 4U);
}

TEST_F(HardMesh, CubesThatShareAnEdge) {
  EXPECT_EQ(diagnosed(joined(box, translated(box, {1, 1, 0}))).problems.front(),
            "1 edge with more than two faces");
}

// They bound a volume all the same: no sphere passes through a point.
TEST_F(HardMesh, CubesThatShareAVertex) {
  const Mesh mesh = joined(box, translated(box, {1, 1, 1}));
  expect_volume(mesh, 2);
  EXPECT_EQ(diagnosed(mesh).non_manifold_vertices, 1U);
  EXPECT_EQ(diagnosed(mesh).components, 2U);
  EXPECT_EQ(diagnosed(mesh).genus, 0);
}

TEST_F(HardMesh, CubesThatOverlap) {
  EXPECT_GT(diagnosed(joined(box, translated(box, {0.3, 0.4, 0.5}))).self_intersections, 0U);
  EXPECT_FALSE(diagnosed(joined(box, translated(box, {0.3, 0.4, 0.5}))).usable());
}

TEST_F(HardMesh, CubesThatTouchInTheMiddleOfAFace) {
  const Mesh small = translated(scaled(box, 0.25), {1, 0.3, 0.4});
  EXPECT_GT(diagnosed(joined(box, small)).self_intersections, 0U);
}

TEST_F(HardMesh, DanglingTriangleAndBaffle) {
  Mesh mesh = box;
  mesh.vertices.emplace_back(0.5, 0.5, 2);
  mesh.triangles.push_back({4, 5, 8});
  const MeshReport report = diagnosed(mesh);
  EXPECT_EQ(report.open_edges, 2U);
  EXPECT_EQ(report.non_manifold_edges, 1U);

  Mesh baffle = box;
  baffle.triangles.push_back({0, 2, 6});
  EXPECT_FALSE(diagnosed(baffle).usable());
}

TEST_F(HardMesh, CollinearTriangle) {
  // The top's diagonal is split on one side and closed by a triangle without area.
  Mesh mesh = box;
  const auto [i, j, k] = mesh.triangles.back();
  const std::uint32_t m = index(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[i] + mesh.vertices[j]));
  mesh.triangles.back() = {i, m, k};
  mesh.triangles.push_back({m, j, k});
  mesh.triangles.push_back({i, j, m});
  const MeshReport report = diagnosed(mesh);
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.degenerate_faces, 0U);
  EXPECT_EQ(report.repairs.front(), "dropped 1 face whose corners lie on a line");
}

TEST_F(HardMesh, FacesThatCollapseWhenWelded) {
  Mesh mesh = box;
  mesh.triangles.push_back({0, 0, 1});
  expect_volume(mesh, 1);
}

// A corner of the box is cut off at 1e-7: tiny faces are sound faces.
TEST_F(HardMesh, Sliver) {
  Mesh mesh = box;
  mesh.vertices.emplace_back(0.5, 1e-7, 0);
  // Split the bottom's triangle that has the edge between the corners 0 and 1, close to it.
  for (std::size_t t = 0; t < box.triangles.size(); ++t) {
    const auto [i, j, k] = box.triangles[t];
    if (i == 0 && j == 2 && k == 1) {
      mesh.triangles[t] = {0, 2, 8};
      mesh.triangles.push_back({2, 1, 8});
      mesh.triangles.push_back({1, 0, 8});
    }
  }
  ASSERT_EQ(mesh.triangles.size(), 14U);
  expect_volume(mesh, 1);
}

TEST_F(HardMesh, NeedlesToTheLastBit) {
  for (const double thin : {1e-3, 1e-7, 1e-11, 1e-15}) {
    Mesh mesh = extrude({{0, 0}, {1, 0}, {1, thin}, {0, thin}}, 1, {{0, 1, 2}, {0, 2, 3}});
    expect_volume(mesh, thin);
  }
}

TEST_F(HardMesh, FoldedOver) {
  // The top's corner is pulled through the bottom.
  Mesh mesh = box;
  mesh.vertices[6] = {0.2, 0.2, -0.5};
  EXPECT_GT(diagnosed(mesh).self_intersections, 0U);

  const Mesh spindle = torus_mesh(0.5, 1, 24, 13);
  EXPECT_GT(diagnosed(spindle).self_intersections, 0U);
  EXPECT_FALSE(diagnosed(spindle).usable());
}

TEST_F(HardMesh, NothingButTwoSidesOfATriangle) {
  const Mesh pillow{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_FALSE(diagnosed(pillow).usable());
}

// Six vertices and ten triangles: the projective plane, closed without an inside. It cannot stand in space
// without crossing itself.
TEST_F(HardMesh, OneSided) {
  Mesh mesh{{},
            {{0, 1, 2},
             {0, 2, 3},
             {0, 3, 4},
             {0, 4, 5},
             {0, 5, 1},
             {1, 2, 4},
             {2, 3, 5},
             {3, 4, 1},
             {4, 5, 2},
             {5, 1, 3}}};
  for (const double x : {0.0, 1.0, 2.1, 3.3, 4.6, 6.0}) mesh.vertices.emplace_back(x, x * x, x * x * x);
  const MeshReport report = diagnosed(mesh);
  EXPECT_TRUE(report.closed);
  EXPECT_FALSE(report.usable());
}

TEST_F(HardMesh, FarFromTheOrigin) {
  for (const double offset : {1e3, 1e5, 1e6}) {
    const Mesh mesh = translated(torus_mesh(1, 0.4, 24, 12), {offset, -offset, 2 * offset});
    for (const auto& [name, content] : {std::pair{"far.off", as_off(mesh)}, {"far.obj", as_obj(mesh)}}) {
      const MeshReport report = read_mesh({.file = folder.write(name, content)}).report;
      EXPECT_TRUE(report.usable()) << name << " at " << offset;
      // A coordinate is off by eps · 2 offset, times the area of 16.
      EXPECT_NEAR(report.volume, volume_of(torus_mesh(1, 0.4, 24, 12)), 16 * 2.3e-16 * 2 * offset + 1e-13);
    }
  }
}

TEST_F(HardMesh, TinyAndHuge) {
  for (const double size : {1e-9, 1e-4, 1e4, 1e9}) {
    const Mesh mesh = scaled(helix_mesh(), size);
    expect_volume(mesh, volume_of(mesh));
    const MeshReport report =
        read_mesh({.file = folder.write("mesh.stl", as_binary_stl(scaled(box, size)))}).report;
    EXPECT_TRUE(report.usable());
    EXPECT_NEAR(report.volume / (size * size * size), 1, 1e-6);
  }
}

TEST_F(HardMesh, MinusZeroIsZero) {
  std::string stl = as_text_stl(box);
  stl.replace(stl.find("vertex 0 0 0"), 12, "vertex -0.0 -0.0 0");
  const MeshReport report = read_mesh({.file = folder.write("mesh.stl", stl)}).report;
  EXPECT_TRUE(report.usable());
  EXPECT_EQ(report.vertices, 8U);
}

// However its wall is oriented, a cavity is none of the container, and an island in it is.
TEST_F(HardMesh, NestedCavities) {
  const Mesh outer = box_mesh({-4, -4, -4}, {8, 8, 8}), cavity = box_mesh({-2, -2, -2}, {4, 4, 4}),
             island = box_mesh({-1, -1, -1}, {2, 2, 2});
  for (const bool outer_turned : {false, true}) {
    for (const bool cavity_turned : {false, true}) {
      for (const bool island_turned : {false, true}) {
        Mesh mesh = outer_turned ? inverted(outer) : outer;
        mesh = joined(mesh, cavity_turned ? inverted(cavity) : cavity);
        mesh = joined(mesh, island_turned ? inverted(island) : island);
        expect_volume(mesh, 512 - 64 + 8);

        const auto container =
            make_mesh_container(scaled(imported(mesh).mesh, 0.125), WallArithmetic::filtered, 2.3e-16);
        EXPECT_GT(container->clearance({0, 0, 0}), 0) << "the island";
        EXPECT_LT(container->clearance({1.5 / 8, 0, 0}), 0) << "the cavity";
        EXPECT_GT(container->clearance({3.0 / 8, 0, 0}), 0) << "the wall around it";
        EXPECT_LT(container->clearance({5.0 / 8, 0, 0}), 0) << "outside";
      }
    }
  }
}

TEST_F(HardMesh, ChambersThatDoNotMeet) {
  const Mesh mesh = joined(box, inverted(translated(box, {3, 0, 0})));
  expect_volume(mesh, 2);
  EXPECT_EQ(diagnosed(mesh).components, 2U);
  EXPECT_EQ(diagnosed(mesh).orientation, "mixed");
}

// A point level with vertices, edges and faces of the mesh, above, beside and on them: the ray that decides
// its side then meets all of them, and must count each once.
TEST_F(HardMesh, SidesOfPointsInLineWithEverything) {
  Mesh mesh = l_shape_mesh(1);
  const auto container = make_mesh_container(mesh, WallArithmetic::exact, 4.5e-16);
  const auto inside = [](const Vector<3>& p) {
    const bool in_arms = p[0] >= 0 && p[1] >= 0 && ((p[0] <= 2 && p[1] <= 1) || (p[0] <= 1 && p[1] <= 2));
    return in_arms && p[2] >= 0 && p[2] <= 1;
  };
  for (int x = -1; x <= 9; ++x) {
    for (int y = -1; y <= 9; ++y) {
      for (int z = -1; z <= 5; ++z) {
        const Vector<3> p = 0.25 * Vector<3>(x, y, z);
        EXPECT_EQ(container->contains(p, 0), inside(p)) << p.transpose();
      }
    }
  }
}

// The exact distance of the tie is known: a sphere in the middle of a box, of exactly its half width.
TEST_F(HardMesh, TiesAreDecidedExactly) {
  const auto filtered = make_mesh_container(box, WallArithmetic::filtered, 2.3e-16);
  const auto exact = make_mesh_container(box, WallArithmetic::exact, 2.3e-16);
  for (const auto* container : {filtered.get(), exact.get()}) {
    EXPECT_TRUE(container->contains({0.5, 0.5, 0.5}, 0.5));
    EXPECT_FALSE(container->contains({0.5, 0.5, 0.5}, std::nextafter(0.5, 1)));
    EXPECT_TRUE(container->contains({0.25, 0.5, 0.5}, 0.25));
    EXPECT_FALSE(container->contains({std::nextafter(0.25, 0), 0.5, 0.5}, 0.25));
    EXPECT_TRUE(container->contains({0, 0.5, 0.5}, 0)) << "a point on the wall";
    EXPECT_FALSE(container->contains({std::nextafter(0.0, -1), 0.5, 0.5}, 0));
  }
}

}  // namespace meshes_test
}  // namespace bernal

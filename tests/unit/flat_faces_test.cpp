// The faces of a mesh joined to polygons: they cover it, with holes where it has them.
#include "solids/flat_faces.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "bernal/domain/domain.hpp"
#include "support/meshes.hpp"

namespace bernal {
namespace {

TEST(FlatFaces, CoverTheMesh) {
  const Mesh box = test::box_mesh({1, 2, 3}, {2, 3, 4}), prism = test::prism_mesh(7, 2, 5);
  EXPECT_EQ(flat_faces_of(box, 1e-9).size(), 6u);
  EXPECT_EQ(flat_faces_of(prism, 1e-9).size(), 9u);
  for (const Mesh& mesh : {box, prism}) {
    double volume = 0;  // by the divergence theorem, each polygon as a fan
    for (const FlatFace& face : flat_faces_of(mesh, 1e-9))
      for (const auto& loop : face.loops)
        for (std::size_t k = 1; k + 1 < loop.size(); ++k)
          volume += mesh.vertices[loop[0]].dot(mesh.vertices[loop[k]].cross(mesh.vertices[loop[k + 1]])) / 6;
    EXPECT_NEAR(volume, volume_of(mesh), 1e-12 * volume);
  }
}

/// In a plate with a square hole the top is one face of two loops.
TEST(FlatFaces, HaveHoles) {
  Mesh frame;
  for (const double z : {0., 1.})
    for (const double half : {2., 1.})
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        frame.vertices.emplace_back(half * x, half * y, z);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
      frame.triangles.push_back({a, b, c});
      frame.triangles.push_back({a, c, d});
    };
    quad(i, j, 8 + j, 8 + i);            // outside
    quad(4 + j, 4 + i, 12 + i, 12 + j);  // in the hole
    quad(8 + i, 8 + j, 12 + j, 12 + i);  // top
    quad(j, i, 4 + i, 4 + j);            // bottom
  }
  ASSERT_NEAR(volume_of(frame), 12, 1e-12);
  std::size_t with_holes = 0;
  const std::vector<FlatFace> faces = flat_faces_of(frame, 1e-9);
  for (const FlatFace& face : faces) {
    with_holes += face.loops.size() == 2;
    for (const std::uint32_t v : face.loops.front()) EXPECT_EQ(face.loops.size() == 2 && v % 8 >= 4, false);
  }
  EXPECT_EQ(faces.size(), 10u);
  EXPECT_EQ(with_holes, 2u);
}

}  // namespace
}  // namespace bernal

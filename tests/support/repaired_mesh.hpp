#pragma once
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/repaired_mesh.hpp"
#include "geometry/topology.hpp"
#include "support/meshes.hpp"

// What repairs are tried on, and what is asked of what they return.
namespace bernal::test {

/// The mesh without the triangles for which `gone(middle)` holds.
template <class Gone>
Mesh without_faces(Mesh mesh, const Gone& gone) {
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return gone(Vector<3>((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3));
  });
  return mesh;
}

inline bool says(const cad::RepairedMesh& repaired, std::string_view words) {
  return repaired.done.find(words) != std::string::npos && repaired.done.find('\n') == std::string::npos;
}

/// Closed, two-sided as it is oriented, and meeting itself nowhere.
inline void expect_sound(const cad::RepairedMesh& repaired) {
  const MeshTopology topology = topology_of(repaired.mesh);
  EXPECT_TRUE(topology.closed()) << repaired.done;
  EXPECT_EQ(topology.misoriented_edges, 0U) << repaired.done;
  EXPECT_EQ(cad::count_degenerate(repaired.mesh), 0U) << repaired.done;
  EXPECT_EQ(cad::count_self_intersections(repaired.mesh), 0U) << repaired.done;
}

}  // namespace bernal::test

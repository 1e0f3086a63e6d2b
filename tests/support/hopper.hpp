#pragma once
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/vector.hpp"
#include "bernal/domain/domain.hpp"

namespace bernal::testing {

/// A closed hopper in metres: an outlet spout, an inverted pyramid, a rectangular bin; not convex where the
/// spout ends. Volume 0.8125.
inline Mesh hopper() {
  struct Ring {
    double half_x, half_y, z;
  };
  constexpr std::array<Ring, 4> rings = {
      {{0.125, 0.125, 0}, {0.125, 0.125, 0.15}, {0.5, 0.4, 0.6}, {0.5, 0.4, 1.4}}};
  Mesh mesh;
  for (const Ring& ring : rings)  // anticlockwise, seen from above
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
      mesh.vertices.emplace_back(x * ring.half_x, y * ring.half_y, ring.z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  for (std::uint32_t lower = 0; lower < 12; lower += 4)
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint32_t j = (i + 1) % 4, upper = lower + 4;
      mesh.triangles.push_back({lower + i, lower + j, upper + j});
      mesh.triangles.push_back({lower + i, upper + j, upper + i});
    }
  mesh.triangles.push_back({12, 13, 14});
  mesh.triangles.push_back({12, 14, 15});
  return mesh;
}

/// The mesh as text STL; coordinates are the shortest text that reads back to the same doubles.
inline std::string as_stl(const Mesh& mesh, const std::string& name) {
  std::string out = fmt::format("solid {}\n", name);
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector<3>, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = mesh.vertices[triangle[k]];
    const Vector<3> a = p[1] - p[0], b = p[2] - p[0];
    const Vector<3> normal(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    const Vector<3> unit = normal / normal.norm();
    out += fmt::format("  facet normal {:.6g} {:.6g} {:.6g}\n    outer loop\n", unit[0] + 0.0, unit[1] + 0.0,
                       unit[2] + 0.0);
    for (const Vector<3>& v : p) out += fmt::format("      vertex {} {} {}\n", v[0], v[1], v[2]);
    out += "    endloop\n  endfacet\n";
  }
  return out + fmt::format("endsolid {}\n", name);
}

}  // namespace bernal::testing

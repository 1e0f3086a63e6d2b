#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshes/volume_mesh.hpp"

namespace bernal {

/// The tetrahedron on one side of a triangle.
struct TriangleSide {
  static constexpr std::uint32_t none = 0xFFFFFFFF;
  std::uint32_t tetrahedron = none;
  std::uint8_t face = 0;  ///< which of `faces_of_tetrahedron` the triangle is

  bool is_there() const { return tetrahedron != none; }
};

/// Of every triangle the tetrahedra behind it and in front of it. Throws Error{bad_mesh} unless on each side
/// that has a region there is exactly one, of that region, and on others none: the proof that a mesh keeps
/// its surface. Cost: some 100 ns a tetrahedron.
std::vector<std::array<TriangleSide, 2>> sides_of_triangles(const VolumeMesh&);

/// Where regions of tetrahedra are numbers of parts that hang together: gives each part the region that its
/// triangles say. Throws Error{bad_mesh} where that is none. Precondition: there are tetrahedra.
void take_regions_of_triangles(VolumeMesh&);

}  // namespace bernal

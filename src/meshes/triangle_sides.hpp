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

/// Of every triangle the tetrahedra behind it and in front of it, or of the stack of prisms on it, whatever
/// their regions. Throws Error{bad_mesh} where two are on one side. Cost: some 100 ns a tetrahedron.
std::vector<std::array<TriangleSide, 2>> found_sides(const VolumeMesh&);

/// The same, and the proof that a mesh keeps its surface. Throws Error{bad_mesh} unless on each side
/// that has a region there is exactly one, of that region, and on others none.
std::vector<std::array<TriangleSide, 2>> sides_of_triangles(const VolumeMesh&);

/// Where regions of tetrahedra are numbers of parts that hang together: gives each part the region that its
/// triangles say. Throws Error{bad_mesh} where that is none. Precondition: there are tetrahedra.
void take_regions_of_triangles(VolumeMesh&);

/// A face of a tetrahedron, in the order of `faces_of_tetrahedron`.
FaceCorners face_of(const VolumeMesh&, std::size_t tetrahedron, std::size_t face);

/// Of every tetrahedron the one behind each of its faces; TriangleSide::none on the hull. Cost: some 200 ns
/// and 50 bytes a tetrahedron.
std::vector<std::array<std::uint32_t, 4>> neighbours_of(const VolumeMesh&);

}  // namespace bernal

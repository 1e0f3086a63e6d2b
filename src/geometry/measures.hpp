#pragma once
#include <span>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// A normal of the triangle with twice its area as length.
inline Vector<3> doubled_area(const Mesh& mesh, const FaceCorners& t) {
  const Vector<3>& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}
inline Vector<3> middle_of(const Mesh& mesh, const FaceCorners& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}
/// Six times the signed volume of the tetrahedron of a triangle and a point; cancellation is least if that is
/// in the middle of the mesh.
double six_signed_volumes(const Mesh&, const FaceCorners&, const Vector<3>& point);

/// The volume enclosed by a closed, consistently oriented surface: positive if it is oriented outwards.
double signed_volume(const Mesh&);
/// Area of all triangles, or of some over the mesh's vertices.
double area_of(const Mesh&);
double area_of(const Mesh&, std::span<const FaceCorners>);

/// Zero if there are no points.
Bounds<3> bounds_of(std::span<const Vector<3>>);
Bounds<3> bounds_of(const Mesh&, const FaceCorners&);
/// Bounds of all vertices, used or not.
Bounds<3> bounds_of(const Mesh&);
/// Bounds of the vertices that triangles use; `Bounds::of_nothing` if there are none.
Bounds<3> bounds_of_faces(const Mesh&);

}  // namespace bernal

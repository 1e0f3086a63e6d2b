#pragma once
#include <span>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Twice the area of a triangle, along its normal.
inline Vector<3> doubled_area(const Mesh& mesh, const FaceCorners& t) {
  const Vector<3>& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}
inline Vector<3> middle_of(const Mesh& mesh, const FaceCorners& t) {
  return (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
}
/// Of the signed tetrahedron between a triangle and a point; least cancels where that is the middle of all.
double six_signed_volumes(const Mesh&, const FaceCorners&, const Vector<3>& point);

/// What a closed, consistently oriented surface encloses: above 0 where it is turned outward.
double signed_volume(const Mesh&);
/// Of all triangles, or of some over its vertices.
double area_of(const Mesh&);
double area_of(const Mesh&, std::span<const FaceCorners>);

/// Zero where there are no points.
Bounds<3> bounds_of(std::span<const Vector<3>>);
Bounds<3> bounds_of(const Mesh&, const FaceCorners&);
/// Of all vertices, used or not.
Bounds<3> bounds_of(const Mesh&);
/// Of those that triangles use; `Bounds::of_nothing` where there are none.
Bounds<3> bounds_of_faces(const Mesh&);

}  // namespace bernal

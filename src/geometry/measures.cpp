#include "geometry/measures.hpp"

namespace bernal {

double six_signed_volumes(const Mesh& mesh, const FaceCorners& t, const Vector<3>& point) {
  const Vector<3> a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point,
                  c = mesh.vertices[t[2]] - point;
  return a.dot(b.cross(c));
}

double signed_volume(const Mesh& mesh) {
  const Vector<3> center = bounds_of(mesh).center();
  double six_volumes = 0;
  for (const FaceCorners& t : mesh.triangles) six_volumes += six_signed_volumes(mesh, t, center);
  return six_volumes / 6;
}

double area_of(const Mesh& mesh) { return area_of(mesh, mesh.triangles); }

double area_of(const Mesh& mesh, std::span<const FaceCorners> triangles) {
  double doubled = 0;
  for (const FaceCorners& t : triangles) doubled += doubled_area(mesh, t).norm();
  return doubled / 2;
}

Bounds<3> bounds_of(std::span<const Vector<3>> points) {
  if (points.empty()) return {};
  auto bounds = Bounds<3>::of_nothing();
  for (const Vector<3>& p : points) bounds.add(p);
  return bounds;
}

Bounds<3> bounds_of(const Mesh& mesh, const FaceCorners& t) {
  auto bounds = Bounds<3>::of_nothing();
  for (const std::uint32_t v : t) bounds.add(mesh.vertices[v]);
  return bounds;
}

Bounds<3> bounds_of(const Mesh& mesh) { return bounds_of(std::span(mesh.vertices)); }

Bounds<3> bounds_of_faces(const Mesh& mesh) {
  auto bounds = Bounds<3>::of_nothing();
  for (const FaceCorners& t : mesh.triangles)
    for (const std::uint32_t v : t) bounds.add(mesh.vertices[v]);
  return bounds;
}

}  // namespace bernal

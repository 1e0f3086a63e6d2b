#include "cad/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace bernal::cad {
namespace {

using Polygon = std::vector<std::uint32_t>;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Plane = CGAL::Projection_traits_3<Kernel>;
using PolygonVertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Plane>;
using PolygonFace = CGAL::Constrained_triangulation_face_base_2<Plane>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Plane, CGAL::Triangulation_data_structure_2<PolygonVertex, PolygonFace>,
    CGAL::No_constraint_intersection_tag>;

/// Across the polygon, of the length of twice its area.
Vector<3> normal_of(const std::vector<Vector<3>>& points, const Polygon& polygon) {
  Vector<3> normal = Vector<3>::Zero();
  const Vector<3>& apex = points[polygon[0]];
  for (std::size_t k = 2; k < polygon.size(); ++k)
    normal += (points[polygon[k - 1]] - apex).cross(points[polygon[k]] - apex);
  return normal;
}

Triangles fan(const Polygon& polygon) {
  Triangles triangles;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  return triangles;
}

/// Across that diagonal for which the product of the two triangles' normals is larger.
Triangles halves(const std::vector<Vector<3>>& points, const Polygon& q) {
  const auto across = [&](int a, int b, int c) -> Vector<3> {
    return (points[q[b]] - points[q[a]]).cross(points[q[c]] - points[q[b]]);
  };
  if (across(1, 2, 3).dot(across(3, 0, 1)) >= across(0, 1, 2).dot(across(2, 3, 0)))
    return {{q[3], q[0], q[1]}, {q[1], q[2], q[3]}};
  return {{q[2], q[3], q[0]}, {q[0], q[1], q[2]}};
}

/// None if the polygon folds or touches itself in projection.
Triangles delaunay(const std::vector<Vector<3>>& points, const Polygon& polygon, const Vector<3>& normal) {
  Delaunay plane{Plane({normal[0], normal[1], normal[2]})};
  std::vector<Delaunay::Vertex_handle> corners;
  for (const std::uint32_t corner : polygon) {
    const Vector<3>& p = points[corner];
    corners.push_back(plane.insert({p[0], p[1], p[2]}));
    corners.back()->info() = corner;
  }
  try {
    for (std::size_t k = 0; k < corners.size(); ++k)
      plane.insert_constraint(corners[k], corners[(k + 1) % corners.size()]);
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return {};
  }
  if (plane.dimension() != 2 || plane.number_of_vertices() != polygon.size()) return {};

  // Outside is what can be reached from infinity without crossing an edge of the polygon.
  CGAL::Unique_hash_map<Delaunay::Face_handle, bool> outside(false);
  std::vector<Delaunay::Face_handle> reached = {plane.infinite_face()};
  while (!reached.empty()) {
    const auto face = reached.back();
    reached.pop_back();
    if (outside[face]) continue;
    outside[face] = true;
    for (int k = 0; k < 3; ++k)
      if (!plane.is_constrained({face, k})) reached.push_back(face->neighbor(k));
  }
  Triangles triangles;
  for (const auto face : plane.finite_face_handles())
    if (!outside[face])
      triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return triangles;
}

}  // namespace

Triangles triangulate(const std::vector<Vector<3>>& points, const Polygon& polygon) {
  const Vector<3> normal = normal_of(points, polygon);
  if (normal == Vector<3>::Zero()) return fan(polygon);
  if (polygon.size() == 4) return halves(points, polygon);
  const Triangles triangles = delaunay(points, polygon, normal);
  return triangles.empty() ? fan(polygon) : triangles;
}

}  // namespace bernal::cad

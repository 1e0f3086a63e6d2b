#include "cad/read/triangulate.hpp"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <memory>
#include <unordered_map>

#include "bernal/geometry/mesh.hpp"

namespace bernal::cad {
namespace {

using Polygon = std::vector<std::uint32_t>;
using Faces = std::vector<FaceCorners>;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Plane = CGAL::Projection_traits_3<Kernel>;
using PolygonVertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Plane>;
using PolygonFace = CGAL::Constrained_triangulation_face_base_2<Plane>;
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
    Plane, CGAL::Triangulation_data_structure_2<PolygonVertex, PolygonFace>,
    CGAL::No_constraint_intersection_tag>;

/// Normal to the polygon, with the length of twice its area.
Vector<3> normal_of(const std::vector<Vector<3>>& points, const Polygon& polygon) {
  Vector<3> normal = Vector<3>::Zero();
  const Vector<3>& apex = points[polygon[0]];
  for (std::size_t k = 2; k < polygon.size(); ++k)
    normal += (points[polygon[k - 1]] - apex).cross(points[polygon[k]] - apex);
  return normal;
}

Faces fan(const Polygon& polygon) {
  Faces triangles;
  for (std::size_t k = 2; k < polygon.size(); ++k)
    triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
  return triangles;
}

/// Splits at the diagonal for which the product of the two triangles' normals is larger.
Faces halves(const std::vector<Vector<3>>& points, const Polygon& q) {
  const auto across = [&](int a, int b, int c) -> Vector<3> {
    return (points[q[b]] - points[q[a]]).cross(points[q[c]] - points[q[b]]);
  };
  if (across(1, 2, 3).dot(across(3, 0, 1)) >= across(0, 1, 2).dot(across(2, 3, 0)))
    return {{q[3], q[0], q[1]}, {q[1], q[2], q[3]}};
  return {{q[2], q[3], q[0]}, {q[0], q[1], q[2]}};
}

/// The least number of constrained edges on a path from infinity to each face. Absent if the parity depends
/// on the path: then the edges form no closed lines.
std::optional<std::map<Delaunay::Face_handle, int>> depths_in(const Delaunay& plane) {
  std::map<Delaunay::Face_handle, int> depth;
  std::vector<Delaunay::Face_handle> here = {plane.infinite_face()}, next;
  for (int level = 0; !here.empty(); ++level, here.swap(next), next.clear()) {
    for (std::size_t i = 0; i < here.size(); ++i) {
      const auto face = here[i];
      if (!depth.try_emplace(face, level).second) continue;
      for (int k = 0; k < 3; ++k)
        (plane.is_constrained({face, k}) ? next : here).push_back(face->neighbor(k));
    }
  }
  for (const auto& [face, level] : depth)
    for (int k = 0; k < 3; ++k)
      if (plane.is_constrained({face, k}) && (depth.at(face->neighbor(k)) - level) % 2 == 0)
        return std::nullopt;
  return depth;
}

/// The Delaunay triangulation with these edges in the plane normal to `normal`; null if they cross or two
/// corners coincide in projection.
template <class Edges>
std::unique_ptr<Delaunay> constrained(const std::vector<Vector<3>>& points, const Edges& edges,
                                      const std::vector<std::uint32_t>& corners, const Vector<3>& normal) {
  auto plane = std::make_unique<Delaunay>(Plane({normal[0], normal[1], normal[2]}));
  std::unordered_map<std::uint32_t, Delaunay::Vertex_handle> vertices;
  for (const std::uint32_t corner : corners) {
    const Vector<3>& p = points[corner];
    const auto vertex = plane->insert({p[0], p[1], p[2]});
    vertex->info() = corner;
    vertices[corner] = vertex;
  }
  if (plane->dimension() != 2 || plane->number_of_vertices() != corners.size()) return nullptr;
  try {
    for (const auto& [a, b] : edges) plane->insert_constraint(vertices.at(a), vertices.at(b));
  } catch (const Delaunay::Intersection_of_constraints_exception&) {
    return nullptr;
  }
  return plane;
}

FaceCorners corners_of(Delaunay::Face_handle face) {
  return {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()};
}

/// Empty if the polygon folds or touches itself in projection.
Faces delaunay(const std::vector<Vector<3>>& points, const Polygon& polygon, const Vector<3>& normal) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t k = 0; k < polygon.size(); ++k)
    edges.emplace_back(polygon[k], polygon[(k + 1) % polygon.size()]);
  const auto plane = constrained(points, edges, polygon, normal);
  if (!plane) return {};
  const auto depths = depths_in(*plane);
  if (!depths) return {};
  Faces triangles;
  for (const auto face : plane->finite_face_handles())
    if (depths->at(face) > 0) triangles.push_back(corners_of(face));
  return triangles;
}

}  // namespace

Faces triangulate(const std::vector<Vector<3>>& points, const Polygon& polygon) {
  const Vector<3> normal = normal_of(points, polygon);
  if (normal == Vector<3>::Zero()) return fan(polygon);
  if (polygon.size() == 4) return halves(points, polygon);
  const Faces triangles = delaunay(points, polygon, normal);
  return triangles.empty() ? fan(polygon) : triangles;
}

std::optional<Faces> triangulate_regions(const std::vector<Vector<3>>& points,
                                         const std::vector<std::pair<std::uint32_t, std::uint32_t>>& edges,
                                         const Vector<3>& normal) {
  std::vector<std::uint32_t> corners;
  for (const auto& [a, b] : edges) corners.insert(corners.end(), {a, b});
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto plane = constrained(points, edges, corners, normal);
  if (!plane) return std::nullopt;
  const auto depths = depths_in(*plane);
  if (!depths) return std::nullopt;
  Faces triangles;
  for (const auto face : plane->finite_face_handles())
    if (depths->at(face) % 2 == 1) triangles.push_back(corners_of(face));
  return triangles;
}

}  // namespace bernal::cad

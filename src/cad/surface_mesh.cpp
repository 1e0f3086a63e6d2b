#include "cad/surface_mesh.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include "cad/mesh_topology.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = SurfaceMesh::Vertex_index;

Vertex add_vertex(SurfaceMesh& surface, const Vector<3>& p) { return surface.add_vertex({p[0], p[1], p[2]}); }

/// The corners of a face, by their numbers.
std::vector<std::uint32_t> corners_of(SurfaceMesh::Face_index face, const SurfaceMesh& surface,
                                      const std::vector<std::uint32_t>& number) {
  std::vector<std::uint32_t> corners;
  for (const auto v : CGAL::vertices_around_face(surface.halfedge(face), surface))
    corners.push_back(number[v]);
  return corners;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate(
    const std::vector<Vector<3>>& points, const std::vector<std::vector<std::uint32_t>>& polygons) {
  // All polygons as separate faces of one mesh, because CGAL triangulates the faces of a mesh.
  SurfaceMesh surface;
  std::vector<std::uint32_t> point_of_vertex;
  for (const auto& polygon : polygons) {
    std::vector<Vertex> corners;
    for (const std::uint32_t p : polygon) corners.push_back(add_vertex(surface, points[p]));
    point_of_vertex.insert(point_of_vertex.end(), polygon.begin(), polygon.end());
    surface.add_face(corners);
  }
  CGAL::Polygon_mesh_processing::triangulate_faces(surface);

  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto face : surface.faces()) {
    const auto corners = corners_of(face, surface, point_of_vertex);
    // A polygon that CGAL cannot project without folding is fanned; the self-intersections then tell.
    for (std::size_t k = 2; k < corners.size(); ++k)
      triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
  return triangles;
}

void orient_components(Mesh& mesh) {
  const MeshTopology topology = topology_of(mesh);
  SurfaceMesh surface;
  surface.reserve(static_cast<unsigned>(topology.fans), static_cast<unsigned>(topology.edges),
                  static_cast<unsigned>(mesh.triangles.size()));
  std::vector<std::uint32_t> vertex_of_fan(topology.fans);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) vertex_of_fan[topology.fan[t][k]] = mesh.triangles[t][k];
  for (const std::uint32_t v : vertex_of_fan) add_vertex(surface, mesh.vertices[v]);
  for (const auto& fan : topology.fan) surface.add_face(Vertex(fan[0]), Vertex(fan[1]), Vertex(fan[2]));

  CGAL::Polygon_mesh_processing::orient_to_bound_a_volume(surface);

  for (const auto face : surface.faces()) {
    const auto corners = corners_of(face, surface, vertex_of_fan);
    mesh.triangles[face] = {corners[0], corners[1], corners[2]};
  }
}

}  // namespace bernal::cad

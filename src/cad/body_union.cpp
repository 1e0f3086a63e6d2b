#include "cad/body_union.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include "cad/mesh_topology.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// A corner for each fan, so that pinched corners are manifold. False if the faces do not fit together.
bool fill_surface(const Mesh& mesh, Surface& surface) {
  const MeshTopology topology = topology_of(mesh);
  std::vector<Surface::Vertex_index> corners(topology.fans);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      auto& corner = corners[topology.fan[t][k]];
      if (corner != Surface::Vertex_index()) continue;
      const Vector<3>& p = mesh.vertices[mesh.triangles[t][k]];
      corner = surface.add_vertex({p[0], p[1], p[2]});
    }
  for (const auto& fan : topology.fan)
    if (surface.add_face(corners[fan[0]], corners[fan[1]], corners[fan[2]]) == Surface::null_face())
      return false;
  return true;
}

Mesh mesh_of(const Surface& surface) {
  Mesh mesh;
  std::vector<std::uint32_t> number(surface.num_vertices(), none);  // removed ones included
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle;
    int k = 0;
    for (const auto corner : surface.vertices_around_face(surface.halfedge(face))) {
      if (number[corner] == none) {
        number[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto& p = surface.point(corner);
        mesh.vertices.emplace_back(p.x(), p.y(), p.z());
      }
      triangle[k++] = number[corner];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

std::optional<Mesh> combine(const Mesh& one, const Mesh& other, Combine how) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  Surface a, b, result;
  if (!fill_surface(one, a) || !fill_surface(other, b)) return std::nullopt;
  const auto careful = CGAL::parameters::throw_on_self_intersection(true);
  try {
    const bool good = how == Combine::unite
                          ? pmp::corefine_and_compute_union(a, b, result, careful, careful)
                          : pmp::corefine_and_compute_difference(a, b, result, careful, careful);
    if (!good) return std::nullopt;
  } catch (const std::exception&) {  // the surfaces meet themselves, or a precondition of CGAL's
    return std::nullopt;
  }
  return mesh_of(result);
}

}  // namespace bernal::cad

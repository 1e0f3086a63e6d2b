#include "cad/body_union.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include "cad/mesh_topology.hpp"
#include "cad/triangle_tree.hpp"

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

/// Whether a patch of a surface has nothing outside, and inside what the surface winds around: asked at its
/// largest face, `face`. Winding numbers on its two sides differ by one.
bool is_outer_wall(const Mesh& mesh, const TriangleTree& tree, std::uint32_t face) {
  const auto& [i, j, k] = mesh.triangles[face];
  const Vector<3>&a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
  const Vector<3> normal = (b - a).cross(c - a);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const std::optional<int> beyond =
      tree.winding((a + b + c) / 3, axis, [&](std::uint32_t other) { return other == face; });
  return beyond && *beyond == (normal[axis] > 0 ? 0 : 1);
}

}  // namespace

std::optional<Mesh> unite_with_itself(const Mesh& mesh) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  Surface surface;
  if (!fill_surface(mesh, surface)) return std::nullopt;
  const auto crossing = surface.add_property_map<Surface::Edge_index, bool>("e:crossing", false).first;
  const auto patch_of = surface.add_property_map<Surface::Face_index, std::uint32_t>("f:patch", 0).first;
  const auto along = CGAL::parameters::edge_is_constrained_map(crossing);
  try {
    pmp::experimental::autorefine(surface, along);
  } catch (const std::exception&) {  // three faces meet in a point, for instance
    return std::nullopt;
  }
  const std::size_t patches = pmp::connected_components(surface, patch_of, along);
  const Mesh cut = mesh_of(surface);
  std::vector<std::uint32_t> patch, largest(patches, none);
  for (const auto face : surface.faces()) patch.push_back(patch_of[face]);
  std::vector<double> area(patches, 0);
  for (std::uint32_t t = 0; t < cut.triangles.size(); ++t) {
    const auto& [i, j, k] = cut.triangles[t];
    const double own = (cut.vertices[j] - cut.vertices[i]).cross(cut.vertices[k] - cut.vertices[i]).norm();
    if (!(own > area[patch[t]])) continue;
    area[patch[t]] = own;
    largest[patch[t]] = t;
  }
  const TriangleTree tree(cut);
  std::vector<bool> stays(patches, false), kept;
  for (std::size_t p = 0; p < patches; ++p)
    stays[p] = largest[p] != none && is_outer_wall(cut, tree, largest[p]);
  for (const std::uint32_t p : patch) kept.push_back(stays[p]);
  Mesh walls = cut;
  keep_only(walls, kept);
  weld_equal_points(walls);
  if (walls.triangles.empty() || !topology_of(walls).closed()) return std::nullopt;
  return walls;
}

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

#include "cad/repair/cgal_surfaces.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/convex_hull_3.h>

#include "cad/triangle_tree.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

Point to_point(const Vector<3>& p) { return {p[0], p[1], p[2]}; }

/// One corner for each fan, so that pinched corners are manifold. False if the faces do not fit together.
bool fill_surface(const Mesh& mesh, Surface& surface) {
  const MeshTopology topology = topology_of(mesh);
  std::vector<Surface::Vertex_index> corners(topology.fans);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      auto& corner = corners[topology.fan[t][k]];
      if (corner != Surface::Vertex_index()) continue;
      corner = surface.add_vertex(to_point(mesh.vertices[mesh.triangles[t][k]]));
    }
  for (const auto& fan : topology.fan)
    if (surface.add_face(corners[fan[0]], corners[fan[1]], corners[fan[2]]) == Surface::null_face())
      return false;
  return true;
}

Mesh mesh_of(const Surface& surface) {
  Mesh mesh;
  std::vector<std::uint32_t> number(surface.num_vertices(), no_index);  // removed ones included
  for (const auto face : surface.faces()) {
    std::array<std::uint32_t, 3> triangle;
    int k = 0;
    for (const auto corner : surface.vertices_around_face(surface.halfedge(face))) {
      if (number[corner] == no_index) {
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

/// Whether a patch of a surface has nothing outside, and inside it what the surface winds around; tested at
/// its largest face, `face`. The winding numbers on its two sides differ by one.
bool is_outer_wall(const Mesh& mesh, const TriangleTree& tree, std::uint32_t face) {
  const Vector<3> normal = doubled_area(mesh, mesh.triangles[face]);
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const std::optional<int> beyond = tree.winding(middle_of(mesh, mesh.triangles[face]), axis,
                                                 [&](std::uint32_t other) { return other == face; });
  return beyond && *beyond == (normal[axis] > 0 ? 0 : 1);
}

/// CGAL's visitor, used to interrupt the work. A wrap from inside that reaches beyond `bounds` has got out
/// and would wrap the whole part; it shows early, because the largest gates come first, and among them those
/// to the corners of CGAL's initial box.
struct Watch {
  const Monitor& monitor;
  std::size_t most_points;
  std::optional<Bounds<3>> bounds = {};
  std::size_t points = 0;

  template <class Wrapper>
  void on_alpha_wrapping_begin(const Wrapper&) {}
  template <class Wrapper>
  void on_flood_fill_begin(const Wrapper&) {}
  template <class Wrapper, class Gate>
  void before_facet_treatment(const Wrapper&, const Gate& gate) {
    if (!bounds) return;
    const auto reached = gate.facet().first;  // the cell in front of the gate
    for (int corner = 0; corner < 4; ++corner) {
      const Point& p = reached->vertex(corner)->point();
      for (int k = 0; k < 3; ++k)
        if (p[k] < bounds->lower[k] || p[k] > bounds->upper[k]) throw StoppedWrap::outside;
    }
  }
  template <class Wrapper, class Place>
  void before_Steiner_point_insertion(const Wrapper&, const Place&) {}
  template <class Wrapper, class Vertex>
  void after_Steiner_point_insertion(const Wrapper&, Vertex) {
    if (++points > most_points) throw StoppedWrap::too_many;
    if (points % 256 == 0 && monitor.stop()) throw StoppedWrap::by_monitor;
  }
  template <class Wrapper>
  bool go_further(const Wrapper&) {  // CGAL 6 asks
    return true;
  }
  template <class Wrapper>
  void on_flood_fill_end(const Wrapper&) {}
  template <class Wrapper>
  void on_alpha_wrapping_end(const Wrapper&) {}
};

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
  std::vector<std::uint32_t> patch, largest(patches, no_index);
  for (const auto face : surface.faces()) patch.push_back(patch_of[face]);
  std::vector<double> area(patches, 0);
  for (std::uint32_t t = 0; t < cut.triangles.size(); ++t) {
    const double own = doubled_area(cut, cut.triangles[t]).norm();
    if (!(own > area[patch[t]])) continue;
    area[patch[t]] = own;
    largest[patch[t]] = t;
  }
  const TriangleTree tree(cut);
  std::vector<bool> stays(patches, false), kept;
  for (std::size_t p = 0; p < patches; ++p)
    stays[p] = largest[p] != no_index && is_outer_wall(cut, tree, largest[p]);
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

std::optional<Mesh> convex_hull_of(std::span<const Vector<3>> points) {
  std::vector<Point> corners;
  for (const Vector<3>& p : points) corners.push_back(to_point(p));
  Surface surface;
  CGAL::convex_hull_3(corners.begin(), corners.end(), surface);
  if (!CGAL::is_triangle_mesh(surface) || surface.number_of_faces() < 4) return std::nullopt;
  return mesh_of(surface);
}

Mesh alpha_wrap(const Mesh& mesh, double alpha, double offset, std::span<const Vector<3>> seeds,
                std::size_t most_points, const Monitor& monitor) {
  std::vector<Point> points, from;
  for (const Vector<3>& v : mesh.vertices) points.push_back(to_point(v));
  for (const Vector<3>& seed : seeds) from.push_back(to_point(seed));
  Watch watch{monitor, most_points};
  if (!seeds.empty()) {  // corners are no farther than the offset from the surface
    constexpr double more = 2;
    watch.bounds = bounds_of_faces(mesh);
    watch.bounds->lower.array() -= more * offset;
    watch.bounds->upper.array() += more * offset;
  }
  Surface surface;
  // CGAL 5 looks for both among the last parameters, CGAL 6 for the one among the first.
  const auto seeds_and_watch = CGAL::parameters::seed_points(std::ref(from)).visitor(std::ref(watch));
  CGAL::alpha_wrap_3(points, mesh.triangles, alpha, offset, surface, seeds_and_watch, seeds_and_watch);
  Mesh made = mesh_of(surface);
  if (signed_volume(made) < 0) turn_inside_out(made);
  return made;
}

}  // namespace bernal::cad

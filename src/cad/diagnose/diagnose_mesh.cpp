#include "cad/diagnose/diagnose_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cad/diagnose/self_intersections.hpp"
#include "cad/triangle_tree.hpp"
#include "core/parallel.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal::cad {

namespace {

/// For each component, whether it lies inside an odd number of others. A corner on another component does not
/// decide; if all are, the middle of a triangle does, which touches none.
std::vector<Crossing> nesting(const Mesh& mesh, const MeshTopology& topology) {
  std::vector<Crossing> nested(topology.components, Crossing::starts_on_wall);
  if (nested.size() == 1) return {Crossing::even};
  const TriangleTree tree(mesh);
  const Bounds<3> bounds = bounds_of(mesh);
  const auto look_from = [&](const Vector<3>& p, std::uint32_t own) {
    if (nested[own] != Crossing::starts_on_wall) return;
    throw_if_interrupted();
    // The shortest ray out: for solids in a row it meets none, while the ray along the row meets all.
    int down = 0, up = 0;
    const double below = (p - bounds.lower).minCoeff(&down), above = (bounds.upper - p).minCoeff(&up);
    constexpr double far = std::numeric_limits<double>::infinity();
    nested[own] = tree.crossing(p, below < above ? down : up, below < above ? -far : far,
                                [&](std::uint32_t t) { return topology.component[t] == own; });
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t corner : mesh.triangles[t])
      look_from(mesh.vertices[corner], topology.component[t]);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    look_from(middle_of(mesh, mesh.triangles[t]), topology.component[t]);
  return nested;
}

/// Flips whole components so that the mesh bounds a volume: the outermost outwards, those inside them
/// inwards, and so on. Returns how many nested ones were oriented outwards. Precondition: closed,
/// consistently oriented, no self-intersections.
std::uint64_t orient_components(Mesh& mesh, const MeshTopology& topology, const Vector<3>& center) {
  std::vector<double> six_volumes(topology.components, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six_volumes[topology.component[t]] += six_signed_volumes(mesh, mesh.triangles[t], center);
  const std::vector<Crossing> nested = nesting(mesh, topology);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t own = topology.component[t];
    if ((six_volumes[own] < 0) != (nested[own] == Crossing::odd))
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  std::uint64_t made_voids = 0;
  for (std::size_t c = 0; c < nested.size(); ++c)
    made_voids += nested[c] == Crossing::odd && six_volumes[c] > 0;
  return made_voids;
}

bool same_orientation(std::array<std::uint32_t, 3> s, const std::array<std::uint32_t, 3>& t) {
  for (int turns = 0; turns < 3; ++turns) {
    if (s == t) return true;
    std::rotate(s.begin(), s.begin() + 1, s.end());
  }
  return false;
}

/// The number of triangles with opposite orientation to `reference`, which is equal otherwise.
std::size_t count_turned(const Mesh& mesh, const Mesh& reference) {
  std::size_t turned = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    turned += !same_orientation(mesh.triangles[t], reference.triangles[t]);
  return turned;
}

/// Orients the mesh outwards; fills `volume`, `orientation` and related members. Precondition: closed, no
/// degenerate triangles, no self-intersections.
void orient(Mesh& mesh, const MeshTopology& topology, MeshReport& report) {
  const Mesh original = mesh;
  if (orient_consistently(mesh, topology) == no_index) {
    report.orientation = "mixed";
    report.problems.emplace_back("one-sided surface: inside and outside are the same");
    return;
  }
  const std::uint64_t made_voids = orient_components(mesh, topology, report.bounds.center());
  report.volume = signed_volume(mesh);
  if (!(report.volume > 0) || !std::isfinite(report.volume)) {
    report.volume = 0;
    report.problems.emplace_back("it encloses no volume that double precision can hold");
    return;
  }
  const std::size_t turned = count_turned(mesh, original);
  report.orientation = turned == 0 ? "outward" : turned == report.faces ? "inward" : "mixed";
  if (turned > 0)
    report.repairs.push_back(made_voids == 0
                                 ? fmt::format("turned {} outward", counted(turned, "face", "faces"))
                                 : fmt::format("turned {}, and took {} inside others for voids",
                                               counted(turned, "face", "faces"),
                                               counted(made_voids, "body", "bodies")));
}

}  // namespace

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

MeshReport diagnose_mesh(Triangles& triangles) {
  Mesh& mesh = triangles.mesh;
  MeshReport report;
  const auto repaired = [&](std::uint64_t n, std::string_view verb, std::string_view one,
                            std::string_view many) {
    if (n > 0) report.repairs.push_back(fmt::format("{} {}", verb, counted(n, one, many)));
  };
  repaired(triangles.welded, "welded", "equal point", "equal points");
  repaired(triangles.triangulated, "triangulated", "polygon", "polygons");
  repaired(triangles.collapsed, "dropped", "face without area", "faces without area");
  repaired(triangles.repeated, "dropped", "repeated face", "repeated faces");
  repaired(triangles.back_sides, "dropped the back of", "face", "faces");
  report.duplicate_faces = triangles.repeated;

  report.faces = mesh.triangles.size();
  report.vertices = mesh.vertices.size();
  if (mesh.triangles.empty()) {
    report.orientation = "mixed";
    report.problems.emplace_back("no faces with an area");
    return report;
  }
  report.bounds = bounds_of(mesh);
  report.area = area_of(mesh);

  const MeshTopology topology = topology_of(mesh);
  report.open_edges = topology.open_edges;
  report.non_manifold_edges = topology.non_manifold_edges;
  report.non_manifold_vertices = topology.non_manifold_vertices;
  report.misoriented_edges = topology.misoriented_edges;
  report.components = topology.components;
  report.closed = topology.closed();
  report.degenerate_faces = count_degenerate(mesh);
  report.self_intersections = count_self_intersections(mesh);

  const auto refuse = [&](std::uint64_t n, std::string_view one, std::string_view many) {
    if (n > 0) report.problems.push_back(counted(n, one, many));
  };
  refuse(report.open_edges, "open edge", "open edges");
  refuse(report.non_manifold_edges, "edge with more than two faces", "edges with more than two faces");
  refuse(report.degenerate_faces, "degenerate face (its corners lie on a line)",
         "degenerate faces (their corners lie on a line)");
  const bool past_counting = report.self_intersections >= most_self_intersections(mesh);
  refuse(report.self_intersections, "self-intersecting face pair",
         past_counting ? "self-intersecting face pairs or more" : "self-intersecting face pairs");
  if (report.problems.empty()) orient(mesh, topology, report);
  if (report.orientation.empty()) report.orientation = report.misoriented_edges == 0 ? "consistent" : "mixed";
  if (report.usable()) {
    const auto chi = static_cast<std::int64_t>(topology.fans) - static_cast<std::int64_t>(topology.edges) +
                     static_cast<std::int64_t>(report.faces);
    report.genus = static_cast<std::int64_t>(report.components) - chi / 2;
  }
  return report;
}

}  // namespace bernal::cad

#include "cad/defects.hpp"

#include <algorithm>
#include <boost/functional/hash.hpp>
#include <boost/unordered/unordered_map.hpp>

#include "cad/mesh_topology.hpp"
#include "cad/self_intersections.hpp"

namespace bernal::cad {
namespace {

using EdgeEnds = std::array<std::uint32_t, 2>;

/// Every edge, with the number of faces at it.
boost::unordered_map<EdgeEnds, std::uint32_t> faces_at_edges(const Mesh& mesh) {
  boost::unordered_map<EdgeEnds, std::uint32_t> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      ++edges[{a, b}];
    }
  return edges;
}

void stretch(Bounds<3>& bounds, const Vector<3>& p) {
  bounds.lower = bounds.lower.cwiseMin(p);
  bounds.upper = bounds.upper.cwiseMax(p);
}

Bounds<3> bounds_of_edge(const Mesh& mesh, const EdgeEnds& edge) {
  Bounds<3> bounds{mesh.vertices[edge[0]], mesh.vertices[edge[0]]};
  stretch(bounds, mesh.vertices[edge[1]]);
  return bounds;
}

/// The widest first; those of one width in the order of their places.
void keep_widest(std::vector<Defect>& defects) {
  constexpr std::size_t most = 5;
  std::ranges::sort(defects, [](const Defect& a, const Defect& b) {
    return std::tuple(-a.across, a.at[0], a.at[1], a.at[2]) <
           std::tuple(-b.across, b.at[0], b.at[1], b.at[2]);
  });
  if (defects.size() > most) defects.resize(most);
}

}  // namespace

std::vector<OpenRim> open_rims(const Mesh& mesh) {
  std::vector<EdgeEnds> open;
  for (const auto& [edge, faces] : faces_at_edges(mesh))
    if (faces == 1) open.push_back(edge);
  std::ranges::sort(open);

  boost::unordered_map<std::uint32_t, std::uint32_t> parent;
  const auto root = [&](std::uint32_t v) {
    while (parent.try_emplace(v, v).first->second != v) v = parent[v];
    return v;
  };
  for (const EdgeEnds& edge : open) {
    const auto [low, high] = std::minmax({root(edge[0]), root(edge[1])});
    parent[high] = low;
  }
  std::vector<OpenRim> rims;
  boost::unordered_map<std::uint32_t, std::size_t> rim_of;
  for (const EdgeEnds& edge : open) {
    const auto [entry, is_new] = rim_of.try_emplace(root(edge[0]), rims.size());
    if (is_new) rims.push_back({bounds_of_edge(mesh, edge), {}});
    OpenRim& rim = rims[entry->second];
    for (const std::uint32_t v : edge) {
      stretch(rim.bounds, mesh.vertices[v]);
      rim.ends.push_back(mesh.vertices[v]);
    }
  }
  std::ranges::stable_sort(
      rims, [](const OpenRim& a, const OpenRim& b) { return a.bounds.diagonal() > b.bounds.diagonal(); });
  return rims;
}

std::vector<Defect> defects_of(const Mesh& mesh) {
  std::vector<Defect> holes, branches, crossings;
  for (const OpenRim& rim : open_rims(mesh))
    holes.push_back({"hole", rim.bounds.center(), rim.bounds.diagonal()});
  for (const auto& [edge, faces] : faces_at_edges(mesh)) {
    const Bounds<3> bounds = bounds_of_edge(mesh, edge);
    if (faces > 2) branches.push_back({"edge with more than two faces", bounds.center(), bounds.diagonal()});
  }
  const auto bounds_of_triangle = [&](std::uint32_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    Bounds<3> bounds = bounds_of_edge(mesh, {a, b});
    stretch(bounds, mesh.vertices[c]);
    return bounds;
  };
  for (const auto& [s, t] : self_intersecting_pairs(mesh)) {
    const Bounds<3> one = bounds_of_triangle(s), other = bounds_of_triangle(t);
    const Bounds<3> both{one.lower.cwiseMax(other.lower), one.upper.cwiseMin(other.upper)};
    crossings.push_back({"crossing", both.center(), both.diagonal()});
  }
  std::vector<Defect> all;
  for (std::vector<Defect>* kind : {&holes, &branches, &crossings}) {
    keep_widest(*kind);
    all.insert(all.end(), kind->begin(), kind->end());
  }
  return all;
}

DefectiveFaces defective_faces(const Mesh& mesh) {
  DefectiveFaces faces;
  const auto edges = faces_at_edges(mesh);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    bool open = false, branching = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      const std::uint32_t count = edges.at({a, b});
      open = open || count == 1;
      branching = branching || count > 2;
    }
    if (open) faces.at_open_edges.push_back(t);
    if (branching) faces.at_branching_edges.push_back(t);
  }
  for (const auto& pair : self_intersecting_pairs(mesh))
    faces.crossing.insert(faces.crossing.end(), pair.begin(), pair.end());
  std::ranges::sort(faces.crossing);
  faces.crossing.erase(std::unique(faces.crossing.begin(), faces.crossing.end()), faces.crossing.end());
  return faces;
}

}  // namespace bernal::cad

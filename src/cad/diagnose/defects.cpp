#include "cad/diagnose/defects.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "cad/diagnose/self_intersections.hpp"
#include "core/disjoint_sets.hpp"
#include "geometry/edges.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {
namespace {

/// The widest first, ties by position.
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
  std::vector<EdgeUse> open = open_edges(mesh.triangles);
  std::ranges::sort(open, {}, [](const EdgeUse& edge) { return std::pair(edge.low, edge.high); });
  DisjointSets parts(mesh.vertices.size());
  for (const EdgeUse& edge : open) parts.unite(edge.low, edge.high);
  std::vector<OpenRim> rims;
  std::vector<std::uint32_t> rim_of(mesh.vertices.size(), no_index);
  for (const EdgeUse& edge : open) {
    std::uint32_t& number = rim_of[parts.find(edge.low)];
    if (number == no_index) {
      number = static_cast<std::uint32_t>(rims.size());
      rims.push_back({Bounds<3>::of_nothing(), {}});
    }
    for (const std::uint32_t v : {edge.low, edge.high}) {
      rims[number].bounds.add(mesh.vertices[v]);
      rims[number].ends.push_back(mesh.vertices[v]);
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
  MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() <= 2) return;
    const Vector<3> ends[] = {mesh.vertices[uses.front().low], mesh.vertices[uses.front().high]};
    const Bounds<3> bounds = bounds_of(ends);
    branches.push_back({"edge with more than two faces", bounds.center(), bounds.diagonal()});
  });
  for (const auto& [s, t] : self_intersecting_pairs(mesh)) {
    const Bounds<3> one = bounds_of(mesh, mesh.triangles[s]), other = bounds_of(mesh, mesh.triangles[t]);
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
  MeshEdges(mesh.triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 2) return;
    std::vector<std::uint32_t>& kind = uses.size() == 1 ? faces.at_open_edges : faces.at_branching_edges;
    for (const EdgeUse& use : uses) kind.push_back(use.triangle);
  });
  for (const auto& pair : self_intersecting_pairs(mesh))
    faces.crossing.insert(faces.crossing.end(), pair.begin(), pair.end());
  for (auto* kind : {&faces.at_open_edges, &faces.at_branching_edges, &faces.crossing}) {
    std::ranges::sort(*kind);
    kind->erase(std::unique(kind->begin(), kind->end()), kind->end());
  }
  return faces;
}

}  // namespace bernal::cad

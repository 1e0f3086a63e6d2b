#include "cad/repair/repair_holes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cad/diagnose/counted.hpp"
#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/patch.hpp"
#include "core/disjoint_sets.hpp"

namespace bernal::cad {
namespace {

/// For each component the extent of its part: the diagonal of the bounds of all components connected by
/// corners.
std::vector<double> extents_of(const Mesh& mesh, const MeshTopology& topology) {
  DisjointSets parts(mesh.vertices.size());
  for (const FaceCorners& t : mesh.triangles)
    for (const std::uint32_t v : t) parts.unite(t[0], v);
  std::vector<Bounds<3>> bounds(mesh.vertices.size(), Bounds<3>::of_nothing());
  for (const FaceCorners& t : mesh.triangles)
    for (const std::uint32_t v : t) bounds[parts.find(v)].add(mesh.vertices[v]);
  std::vector<double> extents(topology.components);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    extents[topology.component[t]] = bounds[parts.find(mesh.triangles[t][0])].diagonal();
  return extents;
}

struct Patch {
  std::size_t hole, first, last;  ///< which hole, and its faces
  bool crosses_itself = false;    ///< crosses another face of its component
  bool crosses_another = false;
};

void find_crossings(const Mesh& mesh, const std::vector<HoleLoop>& holes, const MeshTopology& topology,
                    std::vector<Patch>& patches) {
  const auto patch_of = [&](std::uint32_t t) -> Patch* {
    if (patches.empty() || t < patches.front().first) return nullptr;
    return &*std::partition_point(patches.begin(), patches.end(),
                                  [&](const Patch& p) { return p.last <= t; });
  };
  const auto component = [&](std::uint32_t t, const Patch* patch) {
    return patch ? holes[patch->hole].component : topology.component[t];
  };
  for (const auto& [s, t] : self_intersecting_pairs(mesh)) {
    Patch *of_s = patch_of(s), *of_t = patch_of(t);
    const bool same = component(s, of_s) == component(t, of_t);
    for (Patch* patch : {of_s, of_t})
      if (patch) (same ? patch->crosses_itself : patch->crosses_another) = true;
  }
}

}  // namespace

RepairedMesh close_holes(Mesh mesh, double widest) {
  const MeshTopology before = topology_of(mesh);
  if (before.open_edges == 0) return {std::move(mesh), std::string(no_holes)};
  if (orient_consistently(mesh, before) == no_index)
    return {std::move(mesh), "holes stay open: the surface is one-sided and has no inside"};
  const MeshTopology topology = topology_of(mesh);
  const std::vector<HoleLoop> holes = hole_loops(mesh, topology);
  const std::vector<double> extents = extents_of(mesh, topology);

  std::size_t tops = 0, wide = 0, branched = 0, unfilled = 0, crossing = 0, dented = 0;
  double widest_left = 0, widest_closed = 0, extent = 0;
  std::vector<Patch> patches;
  Patcher patcher(mesh);
  for (std::size_t h = 0; h < holes.size(); ++h) {
    const HoleLoop& hole = holes[h];
    const bool is_top = std::isinf(widest) && hole.width > extents[hole.component] / 2;
    if (is_top || hole.width > widest) {
      ++(is_top ? tops : wide);
      if (hole.width > widest_left) widest_left = hole.width, extent = extents[hole.component];
    } else if (hole.branched) {
      ++branched;
    } else {
      const std::size_t first = mesh.triangles.size();
      if (patcher.fill(hole)) {
        patches.push_back({h, first, mesh.triangles.size()});
      } else {
        ++unfilled;
      }
    }
  }

  if (!patches.empty()) {
    find_crossings(mesh, holes, topology, patches);
    std::vector<FaceCorners> kept(
        mesh.triangles.begin(), mesh.triangles.begin() + static_cast<std::ptrdiff_t>(patches.front().first));
    for (const Patch& patch : patches) {
      if (patch.crosses_itself) {
        ++crossing;
        continue;
      }
      dented += patch.crosses_another;
      widest_closed = std::max(widest_closed, holes[patch.hole].width);
      for (std::size_t t = patch.first; t < patch.last; ++t) kept.push_back(mesh.triangles[t]);
    }
    mesh.triangles = std::move(kept);
  }

  std::vector<std::string> phrases;
  if (const std::size_t closed = patches.size() - crossing; closed > 0)
    phrases.push_back(fmt::format("closed {}, {}{:.4g} across", counted(closed, "hole", "holes"),
                                  closed > 1 ? "the widest " : "", widest_closed));
  if (dented > 0)
    phrases.push_back(fmt::format("{} of the patches cross{} another part of the surface", dented,
                                  dented == 1 ? "es" : ""));
  const auto left = [&](std::size_t count, const std::string& why) {
    if (count > 0) phrases.push_back(fmt::format("left {} open: {}", counted(count, "hole", "holes"), why));
  };
  left(tops,
       fmt::format("{:.4g} across is more than half of the part's {:.4g}, an open top rather than a hole",
                   widest_left, extent));
  left(wide, fmt::format("wider than {:.4g} (up to {:.4g} across)", widest, widest_left));
  left(branched, "three or more faces meet at the rim");
  left(crossing, "a patch would cross the surface around it");
  left(unfilled, "no faces fill it");
  return {std::move(mesh), fmt::format("{}", fmt::join(phrases, "; "))};
}

}  // namespace bernal::cad

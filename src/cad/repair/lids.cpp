#include "cad/repair/lids.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "cad/diagnose/self_intersections.hpp"
#include "cad/read/triangulate.hpp"
#include "cad/repair/patch.hpp"

namespace bernal::cad {

namespace {

/// A loop around an opening, and its approximate plane.
struct Opening {
  const HoleLoop* loop;
  Vector<3> middle, normal;
  bool is_flat;
};

/// The tolerance is a share of the opening's width.
bool lies_in_plane_of(const Mesh& mesh, const HoleLoop& loop, const Opening& opening, double share) {
  return std::ranges::all_of(loop.corners, [&](std::uint32_t v) {
    return std::abs(opening.normal.dot(mesh.vertices[v] - opening.middle)) <= share * opening.loop->width;
  });
}

Opening opening_of(const Mesh& mesh, const HoleLoop& loop) {
  Opening opening{&loop, Vector<3>::Zero(), Vector<3>::Zero(), false};
  for (const std::uint32_t v : loop.corners)
    opening.middle += mesh.vertices[v] / static_cast<double>(loop.corners.size());
  for (std::size_t k = 0; k < loop.corners.size(); ++k) {
    const std::uint32_t a = loop.corners[k], b = loop.corners[(k + 1) % loop.corners.size()];
    opening.normal += (mesh.vertices[a] - opening.middle).cross(mesh.vertices[b] - opening.middle);
  }
  opening.normal = opening.normal.stableNormalized();
  constexpr double flat_enough = 0.01;
  opening.is_flat = lies_in_plane_of(mesh, loop, opening, flat_enough);
  return opening;
}

/// Whether one lid can close both: those of a ring, or of two ends side by side.
bool share_a_plane(const Opening& wide, const Opening& other) {
  constexpr double parallel = 0.99, near = 0.1;
  return wide.is_flat && other.is_flat && std::abs(wide.normal.dot(other.normal)) > parallel &&
         std::abs(wide.normal.dot(other.middle - wide.middle)) <= near * other.loop->width;
}

/// Puts one lid on all of these in the plane of the first; false, with nothing added, if that fails.
bool lay_flat_lid(Mesh& walls, const std::vector<Opening>& openings,
                  const std::vector<std::size_t>& together) {
  const Opening& widest = openings[together.front()];
  if (!widest.is_flat || widest.normal.isZero(0)) return false;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::size_t j : together) {
    const std::vector<std::uint32_t>& corners = openings[j].loop->corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
      edges.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
  }
  const auto lid = triangulate_regions(walls.vertices, edges, widest.normal);
  if (!lid || std::ranges::any_of(*lid, [&](const FaceCorners& t) { return is_degenerate(walls, t); }))
    return false;
  walls.triangles.insert(walls.triangles.end(), lid->begin(), lid->end());
  return true;
}

}  // namespace

std::vector<Lid> put_lids(Mesh& walls) {
  std::vector<HoleLoop> loops = hole_loops(walls, topology_of(walls));
  std::ranges::stable_sort(loops, std::greater<>(), &HoleLoop::width);
  std::vector<Opening> openings;
  for (const HoleLoop& loop : loops) {
    if (loop.branched || loop.corners.size() < 3) return {};
    openings.push_back(opening_of(walls, loop));
  }
  std::vector<Lid> lids;
  Patcher patcher(walls);
  std::vector<bool> is_closed(openings.size(), false);
  for (std::size_t i = 0; i < openings.size(); ++i) {
    if (is_closed[i]) continue;
    std::vector<std::size_t> together;
    for (std::size_t j = i; j < openings.size(); ++j)
      if (!is_closed[j] && (j == i || share_a_plane(openings[i], openings[j]))) together.push_back(j);
    Lid lid{Bounds<3>::of_nothing(), openings[i].middle, true, walls.triangles.size(), 0};
    if (!lay_flat_lid(walls, openings, together)) {
      together = {i};
      if (!patcher.fill(*openings[i].loop)) return {};
    }
    constexpr double in_one_plane = 1e-3;
    for (const std::size_t j : together)
      lid.is_flat = lid.is_flat && lies_in_plane_of(walls, *openings[j].loop, openings[i], in_one_plane);
    lid.last = walls.triangles.size();
    for (std::size_t t = lid.first; t < lid.last; ++t)
      for (const std::uint32_t v : walls.triangles[t]) lid.bounds.add(walls.vertices[v]);
    for (const std::size_t j : together) is_closed[j] = true;
    lids.push_back(lid);
  }
  return lids;
}

}  // namespace bernal::cad

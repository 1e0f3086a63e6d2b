#include "solids/flat_faces.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/order.hpp"
#include "geometry/measures.hpp"
#include "geometry/topology.hpp"

namespace bernal {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Chains directed edges to loops; empty if a loop passes a corner twice.
std::vector<std::vector<std::uint32_t>> loops_of(const std::vector<Edge>& edges) {
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [from, to] : edges)
    if (!next.emplace(from, to).second) return {};
  std::vector<std::vector<std::uint32_t>> loops;
  while (!next.empty()) {
    std::vector<std::uint32_t>& loop = loops.emplace_back();
    for (auto step = next.begin(); step != next.end();) {
      loop.push_back(step->first);
      const std::uint32_t to = step->second;
      next.erase(step);
      step = next.find(to);
    }
  }
  return loops;
}

/// Twice the area inside a loop, negative if it runs against the normal's sense.
double area_around(const Mesh& mesh, const std::vector<std::uint32_t>& loop, const Vector<3>& normal) {
  Vector<3> sum = Vector<3>::Zero();
  const Vector<3>& first = mesh.vertices[loop.front()];
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    sum += (mesh.vertices[loop[k]] - first).cross(mesh.vertices[loop[k + 1]] - first);
  return sum.dot(normal);
}

}  // namespace

FlatGroups flat_groups_of(const Mesh& mesh, const MeshTopology& topology, double tolerance) {
  std::vector<double> area;
  for (const auto& triangle : mesh.triangles) area.push_back(doubled_area(mesh, triangle).norm());
  FlatGroups groups{std::vector<std::uint32_t>(mesh.triangles.size(), no_index), {}};
  for (const std::uint32_t seed : largest_first(area)) {
    if (groups.of_triangle[seed] != no_index) continue;
    const Vector<3> normal = doubled_area(mesh, mesh.triangles[seed]).normalized();
    const Vector<3> origin = mesh.vertices[mesh.triangles[seed][0]];
    const auto own = static_cast<std::uint32_t>(groups.members.size());
    std::vector<std::uint32_t>& members = groups.members.emplace_back(1, seed);
    groups.of_triangle[seed] = own;
    for (std::size_t m = 0; m < members.size(); ++m)
      for (const std::uint32_t beside : topology.neighbor[members[m]]) {
        if (beside == no_index || groups.of_triangle[beside] != no_index) continue;
        const FaceCorners& others = mesh.triangles[beside];
        const bool in_plane = std::ranges::all_of(others, [&](std::uint32_t v) {
          return std::abs((mesh.vertices[v] - origin).dot(normal)) <= tolerance;
        });
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
          longest = std::max(longest, (mesh.vertices[others[(k + 1) % 3]] - mesh.vertices[others[k]]).norm());
        const bool has_no_height = area[beside] <= tolerance * longest;
        if (!in_plane || (!has_no_height && doubled_area(mesh, others).dot(normal) <= 0)) continue;
        groups.of_triangle[beside] = own;
        members.push_back(beside);
      }
  }
  return groups;
}

std::vector<FlatFace> flat_faces_of(const Mesh& mesh, double tolerance) {
  const MeshTopology topology = topology_of(mesh);
  const FlatGroups groups = flat_groups_of(mesh, topology, tolerance);
  std::vector<FlatFace> faces;
  for (std::uint32_t own = 0; own < groups.members.size(); ++own) {
    const std::vector<std::uint32_t>& members = groups.members[own];
    const Vector<3> normal = doubled_area(mesh, mesh.triangles[members.front()]).normalized();
    std::vector<Edge> rim;
    for (const std::uint32_t t : members)
      for (std::size_t k = 0; k < 3; ++k)
        if (const std::uint32_t beside = topology.neighbor[t][k];
            beside == no_index || groups.of_triangle[beside] != own)
          rim.emplace_back(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
    FlatFace face{loops_of(rim)};
    const auto outline = std::ranges::max_element(
        face.loops, {}, [&](const auto& loop) { return area_around(mesh, loop, normal); });
    if (outline == face.loops.end()) {
      for (const std::uint32_t t : members)
        faces.push_back(
            FlatFace{{std::vector<std::uint32_t>(mesh.triangles[t].begin(), mesh.triangles[t].end())}});
      continue;
    }
    std::iter_swap(face.loops.begin(), outline);
    faces.push_back(std::move(face));
  }
  return faces;
}

}  // namespace bernal

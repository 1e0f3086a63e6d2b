#include "solids/flat_faces.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace bernal {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

Vector<3> doubled_area(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

/// The triangles on the left of every edge as a triangle runs along it.
std::map<Edge, std::uint32_t> triangles_by_edge(const Mesh& mesh) {
  std::map<Edge, std::uint32_t> made;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) made[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
  return made;
}

/// Chains edges, each given by where it begins and ends, to loops; empty if one passes a corner twice.
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

/// Twice the area that a loop goes around, against the normal's sense if negative.
double area_around(const Mesh& mesh, const std::vector<std::uint32_t>& loop, const Vector<3>& normal) {
  Vector<3> sum = Vector<3>::Zero();
  const Vector<3>& first = mesh.vertices[loop.front()];
  for (std::size_t k = 1; k + 1 < loop.size(); ++k)
    sum += (mesh.vertices[loop[k]] - first).cross(mesh.vertices[loop[k + 1]] - first);
  return sum.dot(normal);
}

}  // namespace

std::vector<FlatFace> flat_faces_of(const Mesh& mesh, double tolerance) {
  const auto by_edge = triangles_by_edge(mesh);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<double> area;
  for (std::size_t t = 0; t < order.size(); ++t) area.push_back(doubled_area(mesh, t).norm());
  std::ranges::stable_sort(order, [&](auto a, auto b) { return area[a] > area[b]; });

  constexpr std::uint32_t none = ~std::uint32_t{0};
  std::vector<std::uint32_t> group(mesh.triangles.size(), none);
  std::vector<FlatFace> faces;
  std::uint32_t groups = 0;
  for (const std::uint32_t seed : order) {
    if (group[seed] != none) continue;
    const Vector<3> normal = doubled_area(mesh, seed).normalized();
    const Vector<3> origin = mesh.vertices[mesh.triangles[seed][0]];
    const std::uint32_t own = groups++;
    std::vector<std::uint32_t> members = {seed};
    group[seed] = own;
    for (std::size_t m = 0; m < members.size(); ++m)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& corners = mesh.triangles[members[m]];
        const auto beside = by_edge.find({corners[(k + 1) % 3], corners[k]});
        if (beside == by_edge.end() || group[beside->second] != none) continue;
        const auto& others = mesh.triangles[beside->second];
        const bool in_plane = std::ranges::all_of(others, [&](std::uint32_t v) {
          return std::abs((mesh.vertices[v] - origin).dot(normal)) <= tolerance;
        });
        if (!in_plane || doubled_area(mesh, beside->second).dot(normal) <= 0) continue;
        group[beside->second] = own;
        members.push_back(beside->second);
      }
    std::vector<Edge> rim;
    for (const std::uint32_t t : members)
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]};
        const auto beside = by_edge.find({edge.second, edge.first});
        if (beside == by_edge.end() || group[beside->second] != own) rim.push_back(edge);
      }
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

#include "geometry/simplified.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/measures.hpp"

namespace bernal {
namespace {

/// The mesh with the corners in each cell of a grid merged into their mean.
Mesh gathered(const Mesh& mesh, const Bounds<3>& bounds, double cell) {
  using Cell = std::array<std::int64_t, 3>;
  std::vector<std::pair<Cell, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector<3> at = (mesh.vertices[i] - bounds.lower) / cell;
    order.push_back({{static_cast<std::int64_t>(at[0]), static_cast<std::int64_t>(at[1]),
                      static_cast<std::int64_t>(at[2])},
                     i});
  }
  std::ranges::sort(order);
  Mesh coarse;
  std::vector<std::uint32_t> becomes(mesh.vertices.size());
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    Vector<3> sum = Vector<3>::Zero();
    for (j = i; j < order.size() && order[j].first == order[i].first; ++j) {
      sum += mesh.vertices[order[j].second] - bounds.lower;
      becomes[order[j].second] = static_cast<std::uint32_t>(coarse.vertices.size());
    }
    coarse.vertices.push_back(bounds.lower + sum / static_cast<double>(j - i));
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    std::array<std::uint32_t, 3> t = {becomes[a], becomes[b], becomes[c]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    std::ranges::rotate(t, std::ranges::min_element(t));  // canonical order of the corners
    coarse.triangles.push_back(t);
  }
  std::ranges::sort(coarse.triangles);
  const auto twice = std::ranges::unique(coarse.triangles);
  coarse.triangles.erase(twice.begin(), twice.end());
  return coarse;
}

}  // namespace

Mesh simplified(const Mesh& mesh, std::size_t most) {
  if (mesh.triangles.size() <= most) return mesh;
  const Bounds<3> bounds = bounds_of(mesh);
  // A surface crosses about 4 n² cells of an n x n x n grid over it, with two triangles in each.
  double cells = std::max(2.0, std::sqrt(static_cast<double>(most) / 4));
  constexpr double coarser = 0.8;
  for (;; cells *= coarser) {
    Mesh coarse = gathered(mesh, bounds, bounds.size().maxCoeff() / cells);
    if (coarse.triangles.size() <= most || cells < 2) return coarse;
  }
}

}  // namespace bernal

#include "io/viewer_walls.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <tuple>

namespace bernal {
namespace {

constexpr double sharp = 30 * std::numbers::pi / 180;

/// The mesh whose corners are one where they lie in one cell of a grid: the mean of them.
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
    std::ranges::rotate(t, std::ranges::min_element(t));  // the same corners, the same triangle
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
  // A surface crosses about 4 n² of the cells of an n x n x n grid over it, with two triangles in each.
  double cells = std::max(2.0, std::sqrt(static_cast<double>(most) / 4));
  constexpr double coarser = 0.8;
  for (;; cells *= coarser) {
    Mesh coarse = gathered(mesh, bounds, bounds.size().maxCoeff() / cells);
    if (coarse.triangles.size() <= most || cells < 2) return coarse;
  }
}

std::vector<std::array<Vector<3>, 2>> sharp_edges(const Mesh& mesh, std::size_t most) {
  struct Side {
    std::uint32_t from, to, triangle;  // from < to
  };
  const auto normal_of = [&](std::uint32_t triangle) {
    const auto& [a, b, c] = mesh.triangles[triangle];
    return Vector<3>((mesh.vertices[b] - mesh.vertices[a])
                         .stableNormalized()
                         .cross((mesh.vertices[c] - mesh.vertices[a]).stableNormalized())
                         .stableNormalized());
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.from, s.to, s.triangle); });
  std::vector<std::array<Vector<3>, 2>> edges;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    for (j = i; j < sides.size() && sides[j].from == sides[i].from && sides[j].to == sides[i].to; ++j) {
    }
    const Vector<3> n = normal_of(sides[i].triangle), m = normal_of(sides[j - 1].triangle);
    const bool smooth = j - i == 2 && (n.isZero() || m.isZero() || n.dot(m) >= std::cos(sharp));
    if (mesh.vertices[sides[i].from] == mesh.vertices[sides[i].to]) continue;
    if (!smooth) edges.push_back({mesh.vertices[sides[i].from], mesh.vertices[sides[i].to]});
  }
  if (edges.size() > most) {
    const auto shorter = [](const std::array<Vector<3>, 2>& edge) {
      return -(edge[1] - edge[0]).squaredNorm();
    };
    std::ranges::nth_element(edges, edges.begin() + static_cast<std::ptrdiff_t>(most), {}, shorter);
    edges.resize(most);
  }
  return edges;
}

}  // namespace bernal

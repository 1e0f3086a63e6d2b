#include "measure/weighted_cells.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace bernal {
namespace {

/// A face with another sphere, before all centres are known.
struct Face {
  CellNeighbour behind;
  double area;
};

Vector<3> shift_of(const CellNeighbour& neighbour, const Boundary<3>& boundary) {
  Vector<3> shift = Vector<3>::Zero();
  for (int k = 0; k < 3; ++k) shift[k] = neighbour.image[static_cast<std::size_t>(k)] * boundary.edges[k];
  return shift;
}

}  // namespace

WeightedCells weighted_cells(const Spheres<3>& spheres, const CellBox& box, std::span<const double> weights) {
  const std::size_t n = spheres.size();
  Spheres<3> of_weights = spheres;
  const double least = *std::ranges::min_element(weights), smallest = *std::ranges::min_element(spheres.r);
  for (std::size_t i = 0; i < n; ++i) of_weights.r[i] = std::sqrt(weights[i] - least + smallest * smallest);

  WeightedCells cells;
  cells.volumes.assign(n, 0);
  cells.surfaces.assign(n, 0);
  cells.slopes.resize(n);
  std::vector<Vector<3>> centers(n, Vector<3>::Zero());
  std::vector<std::vector<Face>> faces(n);
  for_each_power_cell(
      of_weights, box, n, [&](std::uint32_t i, const Vector<3>& center, const ConvexCell& cell) {
        centers[i] = center;
        if (cell.empty()) return;
        cells.volumes[i] = cell.volume();
        const auto corners = cell.corners();
        cell.for_each_face([&](ConvexCell::Label label, std::span<const std::uint32_t> loop) {
          Vector<3> twice = Vector<3>::Zero();
          for (std::size_t k = 2; k < loop.size(); ++k)
            twice += (corners[loop[k - 1]] - corners[loop[0]]).cross(corners[loop[k]] - corners[loop[0]]);
          const double area = 0.5 * twice.norm();
          cells.surfaces[i] += area;
          if (label < 0 || area == 0) return;
          const CellNeighbour behind = neighbour_of(label);
          if (behind.sphere != i) faces[i].push_back({behind, area});
        });
      });
  parallel_for(n, [&](std::size_t i) {
    for (const auto& [behind, area] : faces[i]) {
      const double distance = (centers[behind.sphere] + shift_of(behind, box.boundary) - centers[i]).norm();
      cells.slopes[i].push_back({behind.sphere, area / (2 * distance)});
    }
  });
  return cells;
}

}  // namespace bernal

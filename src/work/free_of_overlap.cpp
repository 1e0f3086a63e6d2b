#include "work/free_of_overlap.hpp"

#include <algorithm>
#include <numeric>

#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "neighbors/cell_grid.hpp"

namespace bernal {
namespace {

/// The same as `contact_factor` for walls at 0 and at the edge: the largest r / distance of a sphere.
template <int D>
double wall_contact_factor(const Spheres<D>& spheres, const Vector<D>& edges,
                           const std::vector<bool>& walls) {
  double factor = 0;
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (std::size_t i = 0; i < spheres.size() && walls[k]; ++i) {
      const double x = spheres.x[k][i];
      factor = std::max(factor, spheres.r[i] / std::min(x, edges[static_cast<int>(k)] - x));
    }
  return factor;
}

}  // namespace

template <int D>
double contact_factor(const Spheres<D>& spheres, const Vector<D>& edges) {
  const Boundary<D> boundary{edges};
  const auto [smallest, largest] = std::ranges::minmax(spheres.r);
  std::vector<std::uint32_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, [&](auto i, auto j) { return spheres.r[i] > spheres.r[j]; });

  CellGrid<D> grid(boundary, smallest, largest, spheres.size());
  double factor = 2 * largest / edges.minCoeff();
  for (const std::uint32_t i : order) {
    const Vector<D> c = spheres.center(i);
    const double r = spheres.r[i];
    // d < (r + rj) / factor, less rj, for the rj up to the largest that makes it the most.
    const double reach = r / factor + largest * std::max(0.0, 1 / factor - 1);
    grid.for_each_near(c, reach, [&](std::uint32_t j) {
      const double d = boundary.minimum_image(c - spheres.center(j)).norm();
      factor = std::max(factor, (r + spheres.r[j]) / d);
    });
    grid.insert(i, c, r);
  }
  return factor;
}

template <int D>
Vector<D> edges_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, double allowed,
                                const std::vector<bool>& walls) {
  const double touching = contact_factor(spheres, edges_around_walls(edges, walls));
  const double factor = std::max(std::clamp(1.0, touching * (1 - allowed), touching),
                                 wall_contact_factor(spheres, edges, walls));
  const double smallest = *std::ranges::min_element(spheres.r);
  return edges * (factor * (1 + tolerance::growth(factor * edges.maxCoeff() / smallest)));
}

#define BERNAL_INSTANTIATE(D)                                                           \
  template double contact_factor(const Spheres<D>&, const Vector<D>&);                  \
  template Vector<D> edges_free_of_overlap(const Spheres<D>&, const Vector<D>&, double, \
                                           const std::vector<bool>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal

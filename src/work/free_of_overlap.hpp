#pragma once
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"
#include "neighbors/cell_grid.hpp"

namespace bernal {

/// The smallest factor, to rounding, by which a periodic box and its centres have to grow so that no two
/// spheres overlap, nor a sphere its own image: the largest (ri + rj) / d over all pairs of images. Below 1
/// where there is room to shrink. Infinite where two centres coincide.
///
/// Only pairs that could raise the factor found so far are looked at; spheres come in the order of falling
/// radii, so that none has to look far for a larger one. Precondition: there are spheres.
/// Cost: O(N) where the spheres are about in contact, O(N log N) where they are thinly spread.
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

/// The edges of a periodic box around one that ends at walls along some axes, so large that no sphere between
/// these meets an image of another, and is nearer to the walls than to images.
template <int D>
Vector<D> edges_around_walls(Vector<D> edges, const std::vector<bool>& walls) {
  for (int k = 0; k < D; ++k)
    if (!walls.empty() && walls[static_cast<std::size_t>(k)]) edges[k] *= 2.5;
  return edges;
}

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

/// The edges, in the proportions of these, of about the smallest box in which the spheres certainly do not
/// overlap, whatever the rounding, after `resize_box`; with `allowed` > 0, in which no overlap ratio is
/// larger than that, but no smaller than the box at hand unless it has room to spare. Infinite or NaN where
/// two centres coincide. `walls` says along which axes the box ends at walls, which no sphere may cross;
/// empty: none. Cost: as `contact_factor`.
template <int D>
Vector<D> edges_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, double allowed = 0,
                                const std::vector<bool>& walls = {}) {
  const double touching = contact_factor(spheres, edges_around_walls(edges, walls));
  const double factor = std::max(std::clamp(1.0, touching * (1 - allowed), touching),
                                 wall_contact_factor(spheres, edges, walls));
  const double smallest = *std::ranges::min_element(spheres.r);
  return edges * (factor * (1 + tolerance::growth(factor * edges.maxCoeff() / smallest)));
}

}  // namespace bernal

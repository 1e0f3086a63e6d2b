#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"
#include "neighbors/cell_grid.hpp"

namespace bernal {

/// The pairs of spheres in a periodic box that overlap by more than the ratio `allowed`, or are so near to it
/// that rounding leaves it open: d < (1 - allowed) (ri + rj), of the nearest images. Pairs that are not here
/// certainly do not. Precondition: centres are in [0, edge), and there are spheres.
/// Cost: O(N) where they do not overlap much.
template <int D>
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const Spheres<D>& spheres,
                                                                 const Vector<D>& edges, double allowed) {
  const Boundary<D> boundary{edges};
  const auto [least, most] = std::ranges::minmax(spheres.r);
  const double share = (1 - allowed) * (1 + tolerance::growth(edges.maxCoeff() / least));
  // The largest first, so that none has to look far for a larger one.
  std::vector<std::uint32_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::greater<>(), [&](auto i) { return spheres.r[i]; });
  CellGrid<D> grid(boundary, least, most, spheres.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const std::uint32_t i : order) {
    const Vector<D> c = spheres.center(i);
    const double r = spheres.r[i];
    grid.for_each_near(c, r + 1e-6 * least, [&](std::uint32_t j) {
      const double reach = share * (r + spheres.r[j]);
      if (boundary.minimum_image(c - spheres.center(j)).squaredNorm() < reach * reach)
        pairs.emplace_back(i, j);
    });
    grid.insert(i, c, r);
  }
  return pairs;
}

}  // namespace bernal

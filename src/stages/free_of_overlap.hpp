#pragma once
#include <algorithm>

#include "bernal/core/spheres.hpp"
#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"

namespace bernal {

/// The smallest factor, to rounding on the safe side, by which a periodic box and its centres have to grow so
/// that no two spheres overlap, nor a sphere its own image: the largest (ri + rj) / d over all pairs. Below 1
/// where there is room to shrink. Infinite where two centres coincide.
template <int D>
double factor_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges) {
  const Boundary<D> boundary{edges};
  double factor = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    factor = std::max(factor, 2 * spheres.r[i] / edges.minCoeff());
    for (std::size_t j = i + 1; j < spheres.size(); ++j) {
      const double d = boundary.minimum_image(spheres.center(i) - spheres.center(j)).norm();
      factor = std::max(factor, (spheres.r[i] + spheres.r[j]) / d);
    }
  }
  const double smallest = *std::ranges::min_element(spheres.r);
  return factor * (1 + tolerance::growth(edges.maxCoeff() / smallest));
}

}  // namespace bernal

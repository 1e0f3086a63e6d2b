#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "core/order.hpp"

namespace bernal {

/// Spheres in the order of cells that hold about one each, so that what touches lies close in memory.
template <int D>
std::vector<std::uint32_t> spatial_order(const Spheres<D>& spheres, const Vector<D>& edges) {
  const double cells = std::max(1.0, std::floor(std::pow(static_cast<double>(spheres.size()), 1.0 / D)));
  const Boundary<D> box{edges};
  std::vector<double> cell(spheres.size(), 0);  // a whole number
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Vector<D> c = box.wrap(spheres.center(i));
    for (int k = 0; k < D; ++k) cell[i] = cell[i] * cells + std::floor(c[k] / edges[k] * cells);
  }
  return smallest_first(cell);
}

}  // namespace bernal

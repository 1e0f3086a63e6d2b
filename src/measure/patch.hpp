#pragma once
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "core/parallel.hpp"

namespace bernal {

/// A connected sample of spheres in the middle of a packing with its surroundings, for measurements that need
/// too much memory for all spheres.
template <int D>
struct Patch {
  Spheres<D> spheres;              ///< the sample first
  std::vector<std::uint32_t> ids;  ///< indices in the packing
  std::size_t asked = 0;
  Boundary<D> boundary;  ///< periodic where the patch spans the period
};

/// The `most` spheres nearest to the one nearest to `middle`, by the largest coordinate difference, and
/// around them all that are at most `margin` farther; all spheres if there are no more. Cost: O(N), 8 bytes a
/// sphere temporarily.
template <int D>
Patch<D> patch_of(const Spheres<dynamic>& spheres, const Boundary<D>& boundary, const Vector<D>& middle,
                  std::size_t most, double margin) {
  const std::size_t n = spheres.size();
  Patch<D> patch{{}, std::vector<std::uint32_t>(), n, boundary};
  if (n <= most) {
    patch.spheres = spheres.in<D>();
    patch.ids.resize(n);
    std::iota(patch.ids.begin(), patch.ids.end(), 0u);
    return patch;
  }
  const auto center = [&](std::size_t i) {
    Vector<D> c;
    for (std::size_t k = 0; k < D; ++k) c[static_cast<int>(k)] = spheres.x[k][i];
    return c;
  };
  std::vector<double> away(n);
  const auto measure_from = [&](const Vector<D>& from) {
    parallel_ranges(n, 1 << 16, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        away[i] = boundary.minimum_image(center(i) - from).cwiseAbs().maxCoeff();
    });
  };
  measure_from(middle);
  const Vector<D> from = center(static_cast<std::size_t>(std::ranges::min_element(away) - away.begin()));
  measure_from(from);
  std::ranges::nth_element(away, away.begin() + static_cast<std::ptrdiff_t>(most));
  const double reach = away[most];
  for (int k = 0; k < D; ++k)
    if (2 * (reach + margin) < boundary.edges[k]) patch.boundary.edges[k] = 0;
  measure_from(from);
  for (const bool around : {false, true}) {
    for (std::size_t i = 0; i < n; ++i) {
      if (around ? away[i] < reach || away[i] > reach + margin : !(away[i] < reach)) continue;
      patch.ids.push_back(static_cast<std::uint32_t>(i));
      patch.spheres.push_back(from + boundary.minimum_image(center(i) - from), spheres.r[i]);
    }
    if (!around) patch.asked = patch.ids.size();
  }
  return patch;
}

}  // namespace bernal

#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/spheres.hpp"
#include "near/point_grid.hpp"

namespace bernal {

/// Spheres whose radii differ by at most a factor of two, so that one grid serves them all.
template <int D>
struct SizeLevel {
  double largest = 0;
  std::vector<std::uint32_t> members;  ///< until they are in the grid
  std::unique_ptr<PointGrid<D>> grid;
};

/// By size, largest first; levels without spheres are left out. The grids are for pairs up to a gap ratio of
/// `widest_gap`. Precondition: there are spheres.
template <int D>
std::vector<SizeLevel<D>> levels_of(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary,
                                    double widest_gap);

}  // namespace bernal

#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// Random places in a container: uniform over cells that the container may reach into, so that a thin part in
/// a large bounding box costs few misses.
///
/// The cells are those of a coarse background grid. Where that is much more than the container, or would have
/// cells without number, the bounds are halved again and again across their longest edge instead, the largest
/// cell first, until the cells are hardly more than the container. A cell is left out when the clearance of
/// its centre is below minus half its diagonal: the clearance is 1-Lipschitz, so no point of the cell is
/// inside. Cost: one clearance a cell, about 30,000 of them, and at most 150,000.
class Places {
 public:
  explicit Places(const Container& container);

  /// Uniform in the union of the cells: inside the container, or not far from it.
  Vector<3> draw(Random& random) const;

  /// Volume of the union of the cells, at least the container's.
  double volume() const { return volume_; }

 private:
  bool take_grid(const Container& container);
  void halve(const Container& container);

  std::vector<Bounds<3>> cells_;
  std::vector<double> volume_up_to_;  // and with each cell; empty: all cells are equal
  double volume_ = 0;
};

/// Whether random points of the container's bounds are inside so often that nobody needs `Places` for that.
bool fills_its_bounds(const Container& container);

/// `count` points inside: of the points in_bounds(0), in_bounds(1), … of its bounds those that are, where the
/// container fills them; else those of its `Places`, by the seed. Fewer, or none, where less than one in a
/// thousand of these is inside: of a container of aspect 1e7 that is not in line with the axes.
std::vector<Vector<3>> points_inside(const Container& container, std::size_t count, std::uint64_t seed,
                                     const std::function<Vector<3>(std::size_t)>& in_bounds);

}  // namespace bernal

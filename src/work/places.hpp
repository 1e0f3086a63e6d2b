#pragma once
#include <cstdint>
#include <vector>

#include "bernal/core/random.hpp"
#include "bernal/domain/container.hpp"

namespace bernal {

/// Random places in a container: uniform over those cells of a coarse background grid that the container may
/// reach into, so that a thin part in a large bounding box costs few misses.
///
/// A cell is left out when the clearance of its centre is below minus half its diagonal: the clearance is
/// 1-Lipschitz, so no point of the cell is inside. Cost: one clearance a cell, about 30,000 of them.
class Places {
 public:
  explicit Places(const Container& container);

  /// Uniform in the union of the cells: inside the container, or not far from it.
  Vector<3> draw(Random& random) const;

  /// Volume of the union of the cells, at least the container's.
  double volume() const { return static_cast<double>(cells_.size()) * cell_size_.prod(); }

 private:
  Vector<3> cell_size_;
  std::vector<Vector<3>> cells_;  // lower corners
};

}  // namespace bernal

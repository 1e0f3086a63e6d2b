#pragma once
#include <cstddef>
#include <vector>

#include "bernal/domain/container.hpp"

namespace bernal {

/// How much of a container is how deep: the share of its volume farther than z from the wall. Exact to
/// rounding for a box, a cylinder and a sphere, whose points deeper than z are a box, a cylinder and a sphere
/// again, as long as before along axes that repeat themselves; for a mesh from points in the cells of a grid.
class Depths {
 public:
  /// Looks at about `points` points inside a mesh, and no deeper than `reach`. Cost: up to 16 times as many
  /// questions to the container where it fills little of its bounds.
  Depths(const Domain&, const Container&, double reach, std::size_t points);

  /// 1 for z <= 0, and falling.
  double deeper(double z) const;
  /// Standard error of a share: that of independent points, which is more than that of one a cell.
  double error_of(double share) const;
  /// Radius of the largest ball inside; for a mesh that of the deepest point seen, infinite beyond `reach`.
  double deepest() const { return deepest_; }

 private:
  Domain shape_;                 // a mesh is left out
  std::vector<double> sampled_;  // of the points in a mesh, ascending
  double deepest_ = 0;
};

}  // namespace bernal

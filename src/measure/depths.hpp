#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// The distribution of depth in a container, or in its part below a level or between two: the share of the
/// volume farther than z from the wall. Exact to rounding for a box, a cylinder and a sphere, whose points
/// deeper than z form a smaller shape of the same kind (as long as before along periodic axes); for a mesh or
/// a solid of revolution from points in the cells of a grid.
class Depths {
 public:
  /// Samples about `points` points inside a mesh, to a depth of `reach`. Cost: up to 16 times as many
  /// container queries if it fills little of its bounds.
  Depths(const Domain&, const Container&, double reach, std::size_t points,
         const std::optional<LowerPart>& below = {});

  /// Volume of the container, or of its part.
  double volume() const { return volume_; }

  /// 1 for z <= 0, decreasing.
  double deeper(double z) const;
  /// Standard error of a share, as of independent points: an upper bound for one point a cell.
  double error_of(double share) const;
  /// The greatest depth; for a mesh the greatest found, infinite beyond `reach`.
  double deepest() const { return deepest_; }

 private:
  double inner_share(double z) const;
  double deepest_below() const;

  Domain shape_;  // unless it is a mesh
  std::optional<LowerPart> below_;
  double volume_;
  std::vector<double> sampled_;  // of the points in a mesh, ascending
  double deepest_ = 0;
};

}  // namespace bernal

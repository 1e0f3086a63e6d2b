#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "bernal/domain/container.hpp"
#include "bernal/measure/lower_part.hpp"

namespace bernal {

/// How much of a container is how deep: the share of its volume farther than z from the wall. Exact to
/// rounding for a box, a cylinder and a sphere, whose points deeper than z are a box, a cylinder and a sphere
/// again, as long as before along axes that repeat themselves; for a mesh from points in the cells of a grid.
/// Or how much of what of it is below a level.
class Depths {
 public:
  /// Looks at about `points` points inside a mesh, and no deeper than `reach`. Cost: up to 16 times as many
  /// questions to the container where it fills little of its bounds.
  Depths(const Domain&, const Container&, double reach, std::size_t points,
         const std::optional<LowerPart>& below = {});

  /// Of the container, or of its part.
  double volume() const { return volume_; }

  /// 1 for z <= 0, and falling.
  double deeper(double z) const;
  /// Standard error of a share: that of independent points, which is more than that of one a cell.
  double error_of(double share) const;
  /// The depth of the deepest point; of a mesh that of the deepest seen, infinite beyond `reach`.
  double deepest() const { return deepest_; }

 private:
  double inner_share(double z) const;
  double deepest_below() const;

  Domain shape_;  // a mesh is left out
  std::optional<LowerPart> below_;
  double volume_;
  std::vector<double> sampled_;  // of the points in a mesh, ascending
  double deepest_ = 0;
};

}  // namespace bernal

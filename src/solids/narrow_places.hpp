#pragma once
#include <vector>

#include "solids/solids.hpp"

namespace bernal {

/// Where a mesh has to be finer: about the narrowest point between two surfaces. In a flat box about it, of
/// half edges (reach, reach, reach / 2), the last along `normal`, sizes rise from `size` in the middle to
/// `size_beside` at the sides.
struct NarrowPlace {
  Vector<3> point;
  Vector<3> normal;  ///< from one surface to the other
  double reach;
  double size, size_beside;
  /// Of two boxes that overlap the numbers differ, up to `most_layers`; beyond that the last is shared.
  int layer = 0;
  static constexpr int most_layers = 12;
};

/// Between spheres, at walls and at the ends of periods, with all images that reach into the domain. Beside
/// a gap of width g between surfaces of radius r the width is g + d²/r at the distance d; elements are
/// `per_gap` times as long as it is wide, and `per_radius` times the smaller radius where that is less; none
/// is below a thirtieth of this.
std::vector<NarrowPlace> narrow_places_of(const Solids&, double per_radius, double per_gap);

}  // namespace bernal

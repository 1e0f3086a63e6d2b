#pragma once
#include <vector>

#include "solids/solids.hpp"

namespace bernal {

/// A place where a mesh must be finer: around the narrowest point between two surfaces. In a flat box around
/// it, with half edges (reach, reach, reach / 2), the last along `normal`, sizes rise from `size` in the
/// middle to `size_beside` at the sides.
struct NarrowPlace {
  Vector<3> point;
  Vector<3> normal;  ///< from one surface to the other
  double reach;
  double size, size_beside;
  /// Overlapping boxes have different layers, up to `most_layers`; beyond that the last is shared.
  int layer = 0;
  static constexpr int most_layers = 12;
};

/// Narrow places between spheres, at walls and at the ends of periods, with all images that reach into the
/// domain. Precondition: neither bridges nor caps. At a distance d from a gap of width g between surfaces of radius r the width is g + d²/r; elements
/// are `per_gap` times the width, at most `per_radius` times the smaller radius and at least a thirtieth of
/// that.
std::vector<NarrowPlace> narrow_places_of(const Solids&, double per_radius, double per_gap);

}  // namespace bernal

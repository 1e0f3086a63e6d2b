#pragma once
#include <algorithm>
#include <cmath>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// The part of a domain up to a level: the points p with -direction·p <= height.
struct LowerPart {
  Vector<3> direction;  ///< of gravity, a unit vector
  double height;

  double height_of(const Vector<3>& p) const { return -direction.dot(p); }
  bool contains(const Vector<3>& p) const { return height_of(p) <= height; }

  LowerPart to_local(const Frame& frame) const {
    return {direction, (height - height_of(frame.origin)) / frame.scale};
  }

  /// Bounds of the lower part of something with these bounds; cut only if gravity is along an axis.
  Bounds<3> cut(Bounds<3> bounds) const {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(direction[k]) < 1) continue;
      double& end = direction[k] < 0 ? bounds.upper[k] : bounds.lower[k];
      end = std::clamp(-direction[k] * height, bounds.lower[k], bounds.upper[k]);
    }
    return bounds;
  }
};

}  // namespace bernal

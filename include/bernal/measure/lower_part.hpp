#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/domain/domain.hpp"

namespace bernal {

/// The part of a domain up to a level, or between two levels: the points p with
/// from <= -direction·p <= height.
struct LowerPart {
  Vector<3> direction;  ///< of gravity, a unit vector
  double height;
  double from = -std::numeric_limits<double>::infinity();

  double height_of(const Vector<3>& p) const { return -direction.dot(p); }
  bool contains(const Vector<3>& p) const { return height_of(p) >= from && height_of(p) <= height; }

  LowerPart to_local(const Frame& frame) const {
    const double origin = height_of(frame.origin);
    return {direction, (height - origin) / frame.scale, (from - origin) / frame.scale};
  }

  /// Bounds of this part of something with these bounds; cut only if gravity is along an axis.
  Bounds<3> cut(Bounds<3> bounds) const {
    for (int k = 0; k < 3; ++k) {
      if (std::abs(direction[k]) < 1) continue;
      const Bounds<3> whole = bounds;
      const auto at = [&](double level) {
        return std::clamp(-direction[k] * level, whole.lower[k], whole.upper[k]);
      };
      (direction[k] < 0 ? bounds.upper[k] : bounds.lower[k]) = at(height);
      (direction[k] < 0 ? bounds.lower[k] : bounds.upper[k]) = at(from);
    }
    return bounds;
  }
};

}  // namespace bernal

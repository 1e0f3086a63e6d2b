#pragma once
#include <algorithm>
#include <cmath>

#include "verify/box_tree.hpp"

namespace bernal::verify {

/// Of a point from the segment between `a` and `b`; in double, to a few roundoffs of the lengths.
template <int D>
double distance_from_segment(const Vector<D>& p, const Vector<D>& a, const Vector<D>& b) {
  const Vector<D> along = b - a, to_p = p - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(to_p.dot(along) / squared, 0.0, 1.0) : 0.0;
  const Vector<D> rest = to_p - t * along;
  if constexpr (D == 2)
    return std::hypot(rest[0], rest[1]);
  else
    return std::hypot(rest[0], rest[1], rest[2]);
}

/// A segment in a plane, as a tree of boxes holds it: an edge of a polygon, or of a profile.
struct PlaneEdge {
  Vector<2> a, b;

  Box<2> box() const {
    Box<2> box;
    for (int k = 0; k < 2; ++k) {
      box.lower[k] = std::min(a[k], b[k]);
      box.upper[k] = std::max(a[k], b[k]);
    }
    return box;
  }
  double center(int axis) const { return 0.5 * a[axis] + 0.5 * b[axis]; }
};

}  // namespace bernal::verify

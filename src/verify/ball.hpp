#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "bernal/core/vector.hpp"
#include "verify/box_tree.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// A sphere of the packing with its index there.
template <int D>
struct Ball {
  Vector<D> c;
  double r;
  std::uint64_t index;

  Box<D> box() const { return box_of_ball<D>(c, r); }
  double center(int axis) const { return c[axis]; }
};

/// The required distance of a centre from a wall: a radius and the gap beyond it. All lengths are multiplied
/// by `scale`.
struct Reach {
  double r, gap = 0, scale = 1;

  template <class Number>
  Number as() const {
    const Number length = gap == 0 ? Number(r) : Number(r) + Number(gap);
    return scale == 1 ? length : length * Number(scale);
  }
};

template <int D>
using BallTree = BoxTree<Ball<D>, D>;

/// Position of a ball relative to the walls: whether it is inside with the required gaps, the smallest excess
/// over its reach relative to the reach, and the distance from the nearest wall. Infinite if no wall is near.
struct WallState {
  bool inside = true;
  double gap = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();

  /// Adds a piece of wall, at a signed distance from the centre in double.
  void add(double clearance, const Reach& reach, bool holds) {
    const double least = reach.r + reach.gap;
    inside = inside && holds;
    gap = std::min(gap, with_sign((clearance - least) / least, holds));
    distance = std::min(distance, on_side_of(reach.gap, clearance - reach.r, holds));
  }
};

}  // namespace bernal::verify

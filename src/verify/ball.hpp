#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include "bernal/core/vector.hpp"
#include "verify/box_tree.hpp"
#include "verify/tally.hpp"

namespace bernal::verify {

/// A sphere of the packing and its place there.
template <int D>
struct Ball {
  Vector<D> c;
  double r;
  std::uint64_t index;

  Box<D> box() const { return box_of_ball<D>(c, r); }
  double center(int axis) const { return c[axis]; }
};

/// How far from a wall a centre has to stay: a radius, and the gap that is to be beyond it; so many times
/// that where all lengths are taken so many times.
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

/// Whether a ball lies inside, as far from the walls as is asked for; by how much more, at the least from a
/// near wall, over its reach; and how far it is from that. Infinite if none is near.
struct Stand {
  bool inside = true;
  double gap = std::numeric_limits<double>::infinity();
  double distance = std::numeric_limits<double>::infinity();

  /// One more piece of wall, at that signed distance from the centre, in double.
  void add(double clearance, const Reach& reach, bool holds) {
    const double least = reach.r + reach.gap;
    inside = inside && holds;
    gap = std::min(gap, with_sign((clearance - least) / least, holds));
    distance = std::min(distance, on_side_of(reach.gap, clearance - reach.r, holds));
  }
};

}  // namespace bernal::verify

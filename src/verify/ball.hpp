#pragma once
#include <cstdint>
#include <limits>

#include "bernal/core/vector.hpp"
#include "verify/box_tree.hpp"

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

template <int D>
using BallTree = BoxTree<Ball<D>, D>;

/// Whether a ball lies inside, and its least gap from a near wall over its radius; infinite if none is near.
struct Stand {
  bool inside = true;
  double gap = std::numeric_limits<double>::infinity();
};

}  // namespace bernal::verify

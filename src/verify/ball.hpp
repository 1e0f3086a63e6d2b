#pragma once
#include <cstdint>

#include "bernal/core/vector.hpp"
#include "verify/box_tree.hpp"

namespace bernal::verify {

/// A sphere of the packing and its place there.
struct Ball {
  Vector<3> c;
  double r;
  std::uint64_t index;

  Box box() const { return box_of_ball(c, r); }
  double center(int axis) const { return c[axis]; }
};

using BallTree = BoxTree<Ball>;

}  // namespace bernal::verify

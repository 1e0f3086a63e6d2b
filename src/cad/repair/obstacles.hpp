#pragma once
#include "bernal/domain/domain.hpp"

namespace bernal::cad {

enum class TakenOut {
  done,
  outside,   ///< disjoint from the container
  whole,     ///< nothing of the container remains
  entangled  ///< the remainder would be joined in edges only, or cannot be computed
};

/// Subtracts an obstacle from a container; `container` changes only on `done`. Precondition: both closed,
/// oriented outwards, without self-intersections. Cost: one search for crossings, and 50 µs a face if there
/// are any.
TakenOut take_out(Mesh& container, const Mesh& obstacle);

}  // namespace bernal::cad

#pragma once
#include <cstdint>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// A triangle of the wall with its corners at hand; `id` is its index in the mesh.
struct WallTriangle {
  Vector<3> a, b, c;
  std::uint32_t id = 0;
};

}  // namespace bernal::cad

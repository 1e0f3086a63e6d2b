#pragma once
#include <cmath>
#include <cstdint>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The position of a point on a Z-order curve through the box: points close in space are mostly close on the
/// curve. Precondition: in [0, edge).
template <int D>
std::uint64_t place_on_curve(const Vector<D>& point, const Vector<D>& edges) {
  constexpr int bits = 63 / D;
  std::uint64_t place = 0;
  for (int k = 0; k < D; ++k) {
    const auto at = static_cast<std::uint64_t>(std::ldexp(point[k] / edges[k], bits));
    for (int bit = 0; bit < bits; ++bit) place |= (at >> bit & 1) << (bit * D + k);
  }
  return place;
}

}  // namespace bernal

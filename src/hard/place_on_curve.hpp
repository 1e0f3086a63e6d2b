#pragma once
#include <cmath>
#include <cstdint>

#include "bernal/core/vector.hpp"

namespace bernal {

/// Where a point lies on a Z-order curve through the box: points that are near each other in space come to
/// lie near each other on it. Precondition: in [0, edge).
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

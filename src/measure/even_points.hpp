#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The k-th point of a sequence that fills the unit cube [0, 1)³ evenly: component j is frac((k + 1) / g^j),
/// with g the root of g⁴ = g + 1. The same bits on every machine. Source: M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences" (2018).
inline Vector<3> even_point(std::uint64_t k) {
  constexpr std::uint64_t steps[3] = {0xD1B54A32D192ED03, 0xABC98388FB8FAC03,
                                      0x8CB92BA72F3D8DD7};  // 2^64 / g^j
  Vector<3> u;
  for (int j = 0; j < 3; ++j) u[j] = static_cast<double>(((k + 1) * steps[j]) >> 11) * 0x1p-53;
  return u;
}

/// The same in the unit ball about zero, with the cube first shifted periodically by `shift`. With a random
/// shift for each of many balls (Cranley & Patterson, SIAM J. Numer. Anal. 13 (1976) 904) their errors are
/// independent.
inline Vector<3> even_point_in_ball(std::uint64_t k, const Vector<3>& shift) {
  Vector<3> u = even_point(k) + shift;
  for (double& x : u) x -= std::floor(x);
  const double z = 2 * u[0] - 1, turn = 2 * std::numbers::pi * u[1];
  const double across = std::sqrt(std::max(0.0, 1 - z * z));
  return std::cbrt(u[2]) * Vector<3>(across * std::cos(turn), across * std::sin(turn), z);
}

}  // namespace bernal

#pragma once
#include <Eigen/Core>
#include <cmath>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The 13 real spherical harmonics of degree 6, normalised so that h(a)·h(b) = P6(a·b), Legendre's polynomial
/// of the angle between two directions. Even: h(-a) = h(a).
using Harmonics6 = Eigen::Matrix<double, 13, 1>;

/// Precondition: `u` of unit length. Error: some roundoffs.
inline Harmonics6 harmonics6(const Vector<3>& u) {
  // sqrt(2 (6 - m)! / (6 + m)!) times the constant factor of the associated Legendre function.
  static const double c1 = std::sqrt(21.0) / 8, c2 = std::sqrt(210.0) / 32, c3 = std::sqrt(210.0) / 16,
                      c4 = std::sqrt(63.0) / 16, c5 = std::sqrt(1386.0) / 16, c6 = std::sqrt(462.0) / 32;
  const double x = u[0], y = u[1], z = u[2], z2 = z * z, z4 = z2 * z2;
  Harmonics6 h;
  double cosine = x, sine = y;  // of m times the azimuth, times sin^m of the polar angle
  const auto turn = [&] {
    const double turned = cosine * x - sine * y;
    sine = cosine * y + sine * x;
    cosine = turned;
  };
  h[0] = (231 * z4 * z2 - 315 * z4 + 105 * z2 - 5) / 16;
  int k = 1;
  for (const double factor : {c1 * z * (33 * z4 - 30 * z2 + 5), c2 * (33 * z4 - 18 * z2 + 1),
                              c3 * z * (11 * z2 - 3), c4 * (11 * z2 - 1), c5 * z, c6}) {
    h[k++] = factor * cosine;
    h[k++] = factor * sine;
    turn();
  }
  return h;
}

}  // namespace bernal

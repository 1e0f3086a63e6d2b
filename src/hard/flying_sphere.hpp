#pragma once
#include "bernal/core/vector.hpp"

/// For explicit instantiations in all dimensions that spheres fly in.
#define BERNAL_IN_FLYING_DIMENSIONS(F) F(2) F(3) F(4) F(5) F(6)

namespace bernal {

/// A sphere in free flight: at its own `time` it is at x; later, at t, at x + v (t - time). In three
/// dimensions one line of the cache. `r` is its radius at size 1; it grows with the size of all, see
/// `HardSpheres`.
template <int D>
struct alignas(D == 3 ? 64 : 16) FlyingSphere {
  double x[D];
  double v[D];
  double time = 0;
  double r = 0;

  void fly_to(double t) {
    const double flight = t - time;
    for (int k = 0; k < D; ++k) x[k] += v[k] * flight;
    time = t;
  }
  Vector<D> position() const { return Eigen::Map<const Vector<D>>(x); }
  Vector<D> velocity() const { return Eigen::Map<const Vector<D>>(v); }
};

}  // namespace bernal

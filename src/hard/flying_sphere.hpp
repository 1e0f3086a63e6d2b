#pragma once
#include <limits>

#include "bernal/core/vector.hpp"

/// For explicit instantiations in all dimensions of flying spheres.
#define BERNAL_IN_FLYING_DIMENSIONS(F) F(2) F(3) F(4) F(5) F(6)

namespace bernal {

/// A sphere in free flight until its next event: at time t it is at x0 + v t, so x0 is its extrapolated
/// position at time 0. In three dimensions all of it fits one cache line. `r` is its radius at size 1; it
/// grows with the common size, see `HardSpheres`.
///
/// Error: rounding of x0 and of v t, 2.2e-16 of each.
template <int D>
struct alignas(D == 3 ? 64 : 16) FlyingSphere {
  using ArchivedAsBytes = void;
  double x0[D];
  double v[D];
  double r = 0;
  double event = std::numeric_limits<double>::infinity();  ///< time of its next event

  Vector<D> position(double t) const { return Eigen::Map<const Vector<D>>(x0) + velocity() * t; }
  Vector<D> velocity() const { return Eigen::Map<const Vector<D>>(v); }
  /// Sets the motion: at p at time t, with `velocity` from then on.
  void set_course(double t, const Vector<D>& p, const Vector<D>& velocity) {
    for (int k = 0; k < D; ++k) {
      v[k] = velocity[k];
      x0[k] = p[k] - velocity[k] * t;
    }
  }
};

}  // namespace bernal

#pragma once
#include <limits>

#include "bernal/core/vector.hpp"

/// For explicit instantiations in all dimensions that spheres fly in.
#define BERNAL_IN_FLYING_DIMENSIONS(F) F(2) F(3) F(4) F(5) F(6)

namespace bernal {

/// A sphere in free flight, on a course that it keeps until its next event: at time t it is at x0 + v t. So
/// x0 is where it would have been at time 0 on that course. All that others ask of it stands in one line of
/// the cache, in three dimensions. `r` is its radius at size 1; it grows with the size of all, see
/// `HardSpheres`.
///
/// Error: rounding of x0 and of v t, 2.2e-16 of each.
template <int D>
struct alignas(D == 3 ? 64 : 16) FlyingSphere {
  using ArchivedAsBytes = void;
  double x0[D];
  double v[D];
  double r = 0;
  double event = std::numeric_limits<double>::infinity();  ///< when its next event comes

  Vector<D> position(double t) const { return Eigen::Map<const Vector<D>>(x0) + velocity() * t; }
  Vector<D> velocity() const { return Eigen::Map<const Vector<D>>(v); }
  /// At time t it is at p and flies with `velocity` from then on.
  void set_course(double t, const Vector<D>& p, const Vector<D>& velocity) {
    for (int k = 0; k < D; ++k) {
      v[k] = velocity[k];
      x0[k] = p[k] - velocity[k] * t;
    }
  }
};

}  // namespace bernal

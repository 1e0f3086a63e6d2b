#pragma once
#include <cmath>

#include "bernal/core/dimension.hpp"
#include "bernal/core/spheres.hpp"
#include "hard/grow.hpp"

namespace bernal {

/// How fast spheres grow, in terms of the mean diameter over the thermal speed: see `grow`.
template <int D>
class GrowthSchedule {
 public:
  /// Of spheres as they are at the start, in a box or container of this volume.
  GrowthSchedule(const Spheres<D>& spheres, double volume, const GrowOptions& options)
      : as_published_(options.delta.has_value()) {
    double number = 0, volumes = 0, by_number = 0, by_volume = 0;
    for (const double r : spheres.r) {
      const double v = ball_volume(D, r);
      number += 1;
      volumes += v;
      by_number += 2 * r;
      by_volume += v * 2 * r;
    }
    by_number /= number;
    by_volume /= volumes;
    rate_ = as_published_ ? *options.delta * by_number / std::pow(volume, 1.0 / D)
                          : options.rate * by_number / by_volume;
  }

  double at(double compressibility) const {
    const bool fluid = compressibility < fluid_compressibility * D;
    return !as_published_ && fluid ? haste_of_fluid * rate_ : rate_;
  }

 private:
  /// Spheres below this compressibility, a dimension, are a fluid that forgets how fast it was compressed.
  static constexpr double fluid_compressibility = 4;
  static constexpr double haste_of_fluid = 10;

  bool as_published_;
  double rate_;
};

}  // namespace bernal

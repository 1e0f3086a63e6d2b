#pragma once
#include <optional>

namespace bernal {

/// Masses of the spheres.
enum class Masses {
  equal,
  by_volume,  ///< one material
};

/// Hard spheres fly, collide and grow until they jam or reach their radii (Lubachevsky & Stillinger 1990;
/// Kansal, Torquato & Stillinger 2002).
struct Grow {
  /// Growth rate of the radii, r = r0 (1 + delta t), with t in units of the time in which a sphere of thermal
  /// speed crosses the box. If absent, growth follows the default schedule.
  std::optional<double> delta = {};
  /// Packing fraction of the start, made by random sequential insertion if spheres have no positions. If
  /// absent, 0.2 or a value that suits the dimension.
  std::optional<double> phi_init = {};
  /// In the default schedule, while the packing forms: growth rate of the volume-weighted mean diameter over
  /// the thermal speed. Weighted by volume because the large spheres must not grow too fast for the others.
  double rate = 0.01;
  /// Compressibility factor P V / N k T at which spheres count as jammed, once slower growth adds nothing.
  double pressure = 1e6;
  /// With masses by volume large spheres are heavy; wide size distributions then pack denser.
  Masses masses = Masses::equal;
  /// Gap and overlap ratio to which the contacts of the final packing are closed; 0: not at all. In a
  /// container all sizes grow by one factor until the spheres jam.
  double polish = 0;
};

}  // namespace bernal

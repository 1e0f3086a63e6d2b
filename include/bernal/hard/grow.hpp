#pragma once
#include <optional>

namespace bernal {

/// What spheres weigh.
enum class Masses {
  equal,
  by_volume,  ///< one material
};

/// Hard spheres fly, collide and grow until they jam or have their radii (Lubachevsky & Stillinger 1990;
/// Kansal, Torquato & Stillinger 2002).
struct Grow {
  /// Growth of the radii in units of their first values and of the time that a sphere of thermal speed takes
  /// for the length of the box: r = r0 (1 + delta t). Without it, growth follows the default schedule.
  std::optional<double> delta = {};
  /// Where spheres that have no places start: random sequential insertion up to this packing fraction.
  /// Without it 0.2, or what suits the dimension.
  std::optional<double> phi_init = {};
  /// Of the default schedule, where the packing forms: growth of the mean diameter by volume over the thermal
  /// speed. By volume, because it is the large spheres that must not grow too fast for the others.
  double rate = 0.01;
  /// Compressibility factor P V / N k T at which spheres count as jammed.
  double pressure = 1e6;
  /// Of one material large spheres are heavy and pack denser where sizes differ much.
  Masses masses = Masses::equal;
  /// Gap and overlap ratio to which the contacts of the packing are closed in the end; 0: not at all. In a
  /// container all sizes grow by one factor until the spheres jam.
  double polish = 0;
};

}  // namespace bernal

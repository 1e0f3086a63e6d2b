#pragma once
#include <optional>

#include "stages/periodic_work.hpp"

namespace bernal {

struct GrowOptions {
  /// Growth of the radii in units of their first values and of the time that a sphere of thermal speed takes
  /// for the length of the box: r = r0 (1 + delta t). Without it, growth follows the default schedule.
  std::optional<double> delta = {};
  /// Where spheres that have no places start: random sequential insertion up to this packing fraction.
  double phi_init = 0.2;
  /// Of the default schedule, where the packing forms: growth of the mean diameter by volume over the thermal
  /// speed. By volume, because it is the large spheres that must not grow too fast for the others.
  double rate = 0.01;
  /// Compressibility factor P V / N k T at which spheres count as jammed.
  double pressure = 1e6;
  /// Overlap ratio to which `polish` closes the contacts of the jammed packing; 0: not at all.
  double polish = 0;
};

/// Growth in a periodic box, which may end at walls along some axes: hard spheres fly, collide and grow in
/// proportion to their radii until they jam or fill the box as asked (Lubachevsky & Stillinger, J. Stat.
/// Phys. 60, 561 (1990); for any sizes Kansal, Torquato & Stillinger, J. Chem. Phys. 117, 8212 (2002)). The
/// radii of the result are the given ones: it is the box that is scaled. Spheres that have places already
/// start from them, so growth compresses what another stage left.
///
/// Schedule: ten times faster than `rate` while the spheres are a fluid (compressibility below 4 D), which
/// costs no packing fraction (10,000 equal spheres: 0.6447 with it, 0.6443 at `rate` throughout); then
/// `rate`, which decides how dense the packing becomes. At compressibility Z gaps are about D / Z of a
/// diameter.
///
/// Ends `converged` jammed or where the target is reached; `hit_limit` where the box has become too narrow
/// for the minimum image: 2.5 of the largest diameters, but along axes with walls. Throws Error{bad_scene} if
/// it is that from the start, or if phi_init is denser than random insertion reaches. Precondition: 2 to 6
/// dimensions. Cost: some 2,000 collisions a sphere at 0.5 to 0.8 µs. One thread.
StageEnd grow(PeriodicWork& work, const GrowOptions& options);

}  // namespace bernal

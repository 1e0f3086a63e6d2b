#pragma once
#include "bernal/hard/grow.hpp"
#include "hard/hard_spheres.hpp"
#include "work/work.hpp"

namespace bernal {

using GrowOptions = Grow;

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
/// Masses: where sizes differ several times those of one material, `Masses::by_volume`, make denser packings
/// if the rate is low; with equal masses slower growth gains little. Diameters 5:1, 10,000 spheres, by the
/// share of the volume that is small: what the rod model predicts, and what comes of it up to pressure 1e4.
///
/// | small                   | 0.05   | 0.10   | 0.15   | 0.21   | 0.30   | 0.50   | 0.75   |
/// |-------------------------|--------|--------|--------|--------|--------|--------|--------|
/// | rod model               | 0.6774 | 0.7150 | 0.7570 | 0.7878 | 0.7737 | 0.7338 | 0.6863 |
/// | equal, rate 0.01        | -0.012 | -0.018 | -0.022 | -0.015 | -0.005 |  0.000 | +0.003 |
/// | by volume, rate 0.01    |        | -0.015 | -0.021 | -0.014 |        |        |        |
/// | by volume, rate 0.0025  |        | -0.012 | -0.015 | -0.009 |        |        |        |
///
/// One packing each, at 0.10 and 0.21 with patience the mean of four and two; below a third small the seed
/// decides 0.002 to 0.003. At 0.15 a rate of 0.0006 gives -0.014. Up to there the model's value is what large
/// spheres alone at random close packing would leave, 0.6435 over their share: no small sphere may then keep
/// two large ones apart.
///
/// Ends `converged` jammed or where the target is reached; `hit_limit` where the box has become too narrow
/// for the minimum image: 2.5 of the largest diameters, but along axes with walls. Throws Error{bad_scene} if
/// it is that from the start, or if phi_init is denser than random insertion reaches. Precondition: 2 to 6
/// dimensions. Cost: some 2,000 collisions a sphere at 0.5 to 0.8 µs. One thread.
StageEnd grow(Work& work, const GrowOptions& options);

}  // namespace bernal

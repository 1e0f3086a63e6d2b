#pragma once
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Whether so few of `count` spheres carry the volume that with random draws the density of the packing would
/// depend on the seed. The equivalent number of equal spheres, whose total volume scatters as much over
/// seeds, is N <r^D>² / <r^2D>: few if below 1,000, where the volume scatters by 3 %, and below a tenth of
/// the actual number. Lognormal sizes reach this at sigma = 0.51, two sizes 1 : 2 never.
bool few_carry_volume(const SizeDistribution& radii, double count, int dimension);

/// The default way of drawing this many radii.
inline Draw usual_draw(const SizeDistribution& radii, double count, int dimension) {
  return few_carry_volume(radii, count, dimension) ? Draw::quantiles : Draw::random;
}

/// The largest of many spheres, as far as they determine how the others pack.
struct VolumeCarriers {
  /// Share of the number: the largest spheres that hold half of the volume, and others of their size.
  double share = 1;
  double radius = 0;  ///< larger spheres together hold less than a tenth of the volume
};

/// The largest radius such that spheres of at least that radius hold this share of the volume, to 1e-6 of it:
/// of two sizes with half of it each, the larger holds half. `share` in (0, 1). Cost: about 60 moments.
double radius_holding(const SizeDistribution& radii, double share, int dimension);

/// Cost: about 120 moments. Precondition: a finite moment(dimension).
VolumeCarriers volume_carriers(const SizeDistribution& radii, int dimension);

}  // namespace bernal

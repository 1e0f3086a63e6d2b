#pragma once
#include "bernal/sizes/radius_sequence.hpp"
#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Whether of `count` spheres so few carry the volume that random draws would leave it to the seed how dense
/// they pack. N equal spheres whose volumes add up, and scatter over seeds, as theirs do are
/// N <r^D>² / <r^2D>: few if that is below 1,000, where the volume scatters by 3 %, and below a tenth of
/// their number. Of lognormal sizes that begins at sigma = 0.51, of two sizes 1 : 2 never.
bool few_carry_volume(const SizeDistribution& radii, double count, int dimension);

/// How that many radii are drawn where nobody says it.
inline Draw usual_draw(const SizeDistribution& radii, double count, int dimension) {
  return few_carry_volume(radii, count, dimension) ? Draw::quantiles : Draw::random;
}

/// The largest of many spheres, as far as they decide how the others pack.
struct VolumeCarriers {
  double share = 1;   ///< of the number: the largest that hold half of the volume, and others of their size
  double radius = 0;  ///< of all that are larger, together, less than a tenth of the volume is
};

/// The largest radius such that spheres of it and larger ones together hold this share of the volume, to
/// 1e-6 of it: of two sizes with half of it each, the larger holds half. `share` in (0, 1). Cost: some 60
/// moments.
double radius_holding(const SizeDistribution& radii, double share, int dimension);

/// Cost: some 120 moments. Precondition: a finite moment(dimension).
VolumeCarriers volume_carriers(const SizeDistribution& radii, int dimension);

}  // namespace bernal

#pragma once
#include <memory>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// The share of the basis, between 0 and 1, that lies below a size: D10 = 2 is {0.1, 2}.
struct Percentile {
  double share = 0, size = 0;
};

/// The law that percentiles are taken to follow. `through`: none; the curve goes exactly through them,
/// straight in between over the logarithm of the size, as that of a sieve analysis.
enum class PercentileLaw { lognormal, rosin_rammler, normal, through };

/// A law with two parameters is a straight line over its own axis of shares, place + spread·score(share):
///   lognormal      ln d = ln(median) + sigma z(p), z the quantile of the standard normal distribution
///   rosin_rammler  ln d = ln(d63) + (1/n) ln(-ln(1 - p))
///   normal         d = mean + sd z(p)
struct FittedLaw {
  double place = 0;   ///< median, d63 or mean: a size
  double spread = 0;  ///< sigma, n or sd

  /// The size that this share lies below, before any cut.
  double size_at(PercentileLaw law, double share) const;
};

/// The line of least squares, of ln d for `lognormal` and `rosin_rammler`, of d for `normal`: through two
/// percentiles exactly. Preconditions: two or more, sizes that ascend with their shares, a law that is not
/// `through`.
FittedLaw fit_law(const std::vector<Percentile>& percentiles, PercentileLaw law);

/// The curve of `through`, as sizes with the share below each: beyond the outermost percentiles it goes on
/// straight to 0 and 1, or to `min` and `max` where these are not 0 and infinity.
std::vector<Percentile> curve_through(std::vector<Percentile> percentiles, double min, double max);

/// The distribution with these percentiles, as nearly as the law can have them; cut to [min, max], 0 and
/// infinity for none, of which `through` makes its ends instead. Radii as sizes. Throws Error{bad_argument}
/// as the makers of these laws do: `rosin_rammler` needs a `min`.
std::unique_ptr<SizeDistribution> make_from_percentiles(const std::vector<Percentile>& percentiles,
                                                        PercentileLaw law, Basis, double min, double max);

/// The radius below which this share of the basis lies, in (0, 1): D50 by volume is twice that of 0.5. By
/// volume to 1e-6 of the volume, at the cost of about 60 moments.
double radius_below(const SizeDistribution& radii, double share, Basis);

}  // namespace bernal

#pragma once
#include <algorithm>
#include <memory>
#include <string_view>
#include <vector>

#include "bernal/core/random.hpp"

namespace bernal {

/// The number distribution of sphere radii: what fraction of the *number* of spheres has which radius.
/// Distributions that users state by volume are converted once, when they are made. Immutable; all members
/// may be called from several threads.
class SizeDistribution {
 public:
  virtual ~SizeDistribution() = default;

  virtual std::string_view name() const = 0;
  /// The radius below which the fraction `p` of the number lies, p in [0, 1]; quantile(0) = min().
  virtual double quantile(double p) const = 0;
  /// The fraction of the number at or below `radius`.
  virtual double cumulative(double radius) const = 0;
  /// Mean of radius^k, any integer k.
  virtual double moment(int k) const = 0;
  /// What radii above `radius` >= 0 contribute to moment(k): the integral of r^k over them. Precise in the upper
  /// tail, where 1 - cumulative is not.
  virtual double moment_above(int k, double radius) const = 0;
  virtual double min() const = 0;
  /// Infinity where the distribution has an unbounded tail.
  virtual double max() const = 0;

  /// One radius, always positive and finite, by inversion of the cumulative distribution: the k-th draw is a
  /// function of the k-th number. An unbounded lower tail is cut at its quantile 2^-54, below the smallest
  /// number that can be drawn but 0.
  double sample(Random& random) const { return quantile(std::max(random.uniform(), 0x1p-54)); }
};

/// What the shares or the density of a distribution count.
enum class Basis { number, volume };

/// All of these throw Error{bad_argument} on absurd values (not finite, not positive, empty, min > max).
std::unique_ptr<SizeDistribution> make_constant(double radius);
/// `shares` are positive, in any scale, one for each of `radii`, which are distinct and in any order.
std::unique_ptr<SizeDistribution> make_classes(std::vector<double> radii, std::vector<double> shares, Basis);
/// The density of the stated basis is constant on [min, max]; a constant distribution where they are equal.
std::unique_ptr<SizeDistribution> make_uniform(double min, double max, Basis);
/// ln r is normal with standard deviation `sigma` about ln `median`, both of the stated basis; truncated to
/// [min, max] (0 and infinity for none).
std::unique_ptr<SizeDistribution> make_lognormal(double median, double sigma, Basis, double min, double max);
/// The lognormal distribution whose volume-weighted mean <r⁴>/<r³> is `r43` and whose surface-weighted mean
/// <r³>/<r²> is `r32`, before it is truncated: sigma² = ln(r43 / r32), median by volume √(r43·r32).
std::unique_ptr<SizeDistribution> make_lognormal_of_means(double r43, double r32, double min, double max);

}  // namespace bernal

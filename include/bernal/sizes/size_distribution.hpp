#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "bernal/core/random.hpp"

namespace bernal {

/// The number distribution of sphere radii: what fraction of the *number* of spheres has which radius.
/// Distributions that users state by volume are converted once, when they are made. Immutable; all members
/// may be called from several threads.
class SizeDistribution {
 public:
  virtual ~SizeDistribution() = default;

  /// The radius below which the fraction `p` of the number lies, p in [0, 1]; quantile(0) = min().
  virtual double quantile(double p) const = 0;
  /// The fraction of the number at or below `radius`.
  virtual double cumulative(double radius) const = 0;
  /// Mean of radius^k, any integer k.
  virtual double moment(int k) const { return moment_above(k, 0); }
  /// What radii above `radius` >= 0 contribute to moment(k): the integral of r^k over them. Precise in the
  /// upper tail, where 1 - cumulative is not.
  virtual double moment_above(int k, double radius) const = 0;
  double min() const { return min_; }
  /// Infinity where the distribution has an unbounded tail.
  double max() const { return max_; }
  /// The radii that a share of the number has exactly, ascending: the size classes. `cumulative` jumps there.
  virtual std::vector<double> atoms() const { return {}; }

  /// The radius that stands for `u` in (0, 1): where u is uniform, the radius follows this distribution, and
  /// the radii up to any limit come from a few intervals of u. quantile(u), except where something quicker
  /// does.
  virtual double radius_at(double u) const { return quantile(u); }

  /// One radius, always positive and finite: the k-th draw is a function of the k-th number. An unbounded
  /// lower tail is cut at its quantile 2^-54, below the smallest number that can be drawn but 0.
  double sample(Random& random) const { return radius_at(std::max(random.uniform(), 0x1p-54)); }

 protected:
  explicit SizeDistribution(double min = 0, double max = 0) : min_(min), max_(max) {}
  void set_limits(double min, double max) { min_ = min, max_ = max; }

 private:
  double min_, max_;
};

/// What the shares or the density of a distribution count: every sphere alike, or its volume, r³ in any
/// dimension, as a balance does where all have one density. A law q(r) by volume is the law q(r) / r³ by
/// number.
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
/// r is normal with that mean and standard deviation, both of the stated basis and before the cut to
/// [min, max]. 0 and infinity cut six standard deviations from the mean, where nothing is; the lower cut must
/// be above zero.
std::unique_ptr<SizeDistribution> make_normal(double mean, double deviation, Basis, double min, double max);
/// The density of the stated basis, in any scale, is the natural cubic spline through the points, and zero
/// where that is negative. `radii` ascend, densities are not negative, at least two points. Source: Zhao, Li
/// & Liu (2007), section 1; they draw by rejection, here one number gives one radius.
std::unique_ptr<SizeDistribution> make_table(std::vector<double> radii, std::vector<double> densities, Basis);
/// A sieve analysis: `passing`, in any scale, is the volume (or mass) of the spheres that pass each opening.
/// It begins at 0 and does not fall; `radii` are half the openings, ascending. Between two sieves the volume
/// is spread evenly over ln r, so that curves drawn over a logarithmic axis are straight there.
std::unique_ptr<SizeDistribution> make_sieve(std::vector<double> radii, std::vector<double> passing);
/// Rosin and Rammler (Weibull): of the volume, the share 1 - exp(-(r / r63)^n) lies below r; then cut to
/// [min, max], the rest counting as the whole. By number the fines without a lower cut would be infinitely
/// many for n <= 3, so `min` is positive; infinity cuts where 0.1 % of the volume lies above.
std::unique_ptr<SizeDistribution> make_rosin_rammler(double r63, double n, double min, double max);
/// Fuller, with the lower limit of Funk and Dinger: of the volume, the share
/// (r^exponent - min^exponent) / (max^exponent - min^exponent) lies below r.
std::unique_ptr<SizeDistribution> make_fuller(double max, double exponent, double min);
/// Several distributions at once; `shares` are positive, in any scale, of the number or the volume of all.
std::unique_ptr<SizeDistribution> make_mixture(std::vector<std::unique_ptr<SizeDistribution>> of,
                                               std::vector<double> shares, Basis);

}  // namespace bernal

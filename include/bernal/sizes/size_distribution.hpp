#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "bernal/core/random.hpp"

namespace bernal {

/// The number distribution of sphere radii: the share of the *number* of spheres below each radius.
/// Distributions by volume are converted once, on construction. Immutable; all members may be called from
/// several threads.
class SizeDistribution {
 public:
  virtual ~SizeDistribution() = default;

  /// The radius below which the fraction `p` of the number lies, p in [0, 1]; quantile(0) = min().
  virtual double quantile(double p) const = 0;
  /// The fraction of the number at or below `radius`.
  virtual double cumulative(double radius) const = 0;
  /// Mean of radius^k, any integer k.
  virtual double moment(int k) const { return moment_above(k, 0); }
  /// The contribution of radii above `radius` >= 0 to moment(k): the integral of r^k over them. Precise in
  /// the upper tail, where 1 - cumulative is not.
  virtual double moment_above(int k, double radius) const = 0;
  double min() const { return min_; }
  /// Infinity for an unbounded tail.
  double max() const { return max_; }
  /// The radii with a positive share each, ascending: the size classes, where `cumulative` jumps.
  virtual std::vector<double> atoms() const { return {}; }

  /// A radius for `u` in (0, 1): for uniform u the radius follows this distribution, and the radii up to any
  /// limit come from a few intervals of u. The quantile, unless something faster has this property.
  virtual double radius_at(double u) const { return quantile(u); }

  /// One radius, always positive and finite: the k-th draw is a function of the k-th random number. An
  /// unbounded lower tail is cut at its quantile 2^-54, below the smallest number that can be drawn except 0.
  double sample(Random& random) const { return radius_at(std::max(random.uniform(), 0x1p-54)); }

 protected:
  explicit SizeDistribution(double min = 0, double max = 0) : min_(min), max_(max) {}
  void set_limits(double min, double max) { min_ = min, max_ = max; }

 private:
  double min_, max_;
};

/// What the shares or the density of a distribution count: spheres, or their volume, r³ in any dimension, or
/// their mass, which for one material is the same; shares of several are divided by their densities first. A
/// density q(r) by volume is q(r) / r³ by number.
enum class Basis { number, volume, mass };

/// All of these throw Error{bad_argument} for invalid values (not finite, not positive, empty, min > max).
std::unique_ptr<SizeDistribution> make_constant(double radius);
/// `shares` are positive, in any scale, one for each of `radii`, which are distinct and in any order.
std::unique_ptr<SizeDistribution> make_classes(std::vector<double> radii, std::vector<double> shares, Basis);
/// The density of the given basis is constant on [min, max]; a constant distribution if they are equal.
std::unique_ptr<SizeDistribution> make_uniform(double min, double max, Basis);
/// ln r is normal with standard deviation `sigma` about ln `median`, both of the given basis; truncated to
/// [min, max] (0 and infinity for none).
std::unique_ptr<SizeDistribution> make_lognormal(double median, double sigma, Basis, double min, double max);
/// The lognormal distribution with volume-weighted mean <r⁴>/<r³> = `r43` and surface-weighted mean <r³>/<r²>
/// = `r32` before truncation: sigma² = ln(r43 / r32), median by volume √(r43·r32).
std::unique_ptr<SizeDistribution> make_lognormal_of_means(double r43, double r32, double min, double max);
/// The lognormal distribution whose radius has this mean and standard deviation, both of the given basis and
/// before truncation: sigma² = ln(1 + (deviation / mean)²), median = mean / √(1 + (deviation / mean)²).
std::unique_ptr<SizeDistribution> make_lognormal_of_mean(double mean, double deviation, Basis, double min,
                                                         double max);
/// r is normal with this mean and standard deviation, both of the given basis and before truncation to [min,
/// max]. 0 and infinity stand for six standard deviations from the mean, beyond which the share is
/// negligible; the lower limit must be positive.
std::unique_ptr<SizeDistribution> make_normal(double mean, double deviation, Basis, double min, double max);
/// The density of the given basis, in any scale, is the natural cubic spline through the points, and zero
/// where the spline is negative. `radii` ascend, densities are not negative, at least two points. Source:
/// Zhao, Li & Liu (2007), section 1, who draw by rejection; here one number gives one radius.
std::unique_ptr<SizeDistribution> make_table(std::vector<double> radii, std::vector<double> densities, Basis);
/// A sieve analysis: `passing`, in any scale, is what of the basis passes each opening: the volume (or mass),
/// or the number of the spheres. It begins at 0 and does not fall; `radii` are half the openings, ascending.
/// Between two sieves the basis is uniform in ln r, so that curves are straight over a logarithmic axis.
std::unique_ptr<SizeDistribution> make_sieve(std::vector<double> radii, std::vector<double> passing,
                                             Basis = Basis::volume);
/// `amounts`, in any scale, is what of the basis is in each bin, one fewer than the ascending `edges`, which
/// are positive where a bin holds anything. Within a bin the density of the basis is constant.
std::unique_ptr<SizeDistribution> make_histogram(std::vector<double> edges, std::vector<double> amounts,
                                                 Basis);
/// Rosin and Rammler (Weibull): the share 1 - exp(-(r / r63)^n) of the basis lies below r; truncated to
/// [min, max] and normalised. `min` is positive, because for n <= 3 the number of fines has no bound without
/// it; an infinite `max` stands for the radius with 0.1 % of the basis above.
std::unique_ptr<SizeDistribution> make_rosin_rammler(double r63, double n, double min, double max,
                                                     Basis = Basis::volume);
/// Fuller, with the lower limit of Funk and Dinger: the share (r^exponent - min^exponent) / (max^exponent -
/// min^exponent) of the volume lies below r.
std::unique_ptr<SizeDistribution> make_fuller(double max, double exponent, double min);
/// Several distributions mixed; `shares` are positive, in any scale, of the number or the volume of all.
std::unique_ptr<SizeDistribution> make_mixture(std::vector<std::unique_ptr<SizeDistribution>> of,
                                               std::vector<double> shares, Basis);

}  // namespace bernal

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"
#include "sizes/standard_normal.hpp"

namespace bernal {
namespace {

/// Probability of [a, b], without cancellation in either tail.
double normal_between(double a, double b) {
  return a > 0 ? normal_below(-a) - normal_below(-b) : normal_below(b) - normal_below(a);
}

/// ln r normal about `mu` by number, truncated to z in [alpha, beta] for z = (ln r - mu) / sigma.
///   <r^k> = e^(k mu + k² sigma²/2) P(alpha - k sigma, beta - k sigma) / P(alpha, beta)
class Lognormal final : public SizeDistribution {
 public:
  Lognormal(double mu, double sigma, double min, double max)
      : SizeDistribution(min, max),
        mu_(mu),
        sigma_(sigma),
        alpha_(min > 0 ? (std::log(min) - mu) / sigma : -std::numeric_limits<double>::infinity()),
        beta_(max < std::numeric_limits<double>::infinity() ? (std::log(max) - mu) / sigma
                                                            : std::numeric_limits<double>::infinity()),
        mass_(normal_between(alpha_, beta_)) {}

  /// The fraction of the untruncated distribution that is kept.
  double mass() const { return mass_; }

  double quantile(double p) const override {
    if (p <= 0) return min();
    if (p >= 1) return max();
    // From the nearer tail, where probabilities are small and so precise.
    const double below = normal_below(alpha_) + p * mass_;
    const double above = normal_below(-beta_) + (1 - p) * mass_;
    const double z = below < above ? normal_quantile(below) : -normal_quantile(above);
    return std::clamp(std::exp(mu_ + sigma_ * z), min(), max());
  }

  double cumulative(double radius) const override {
    if (radius <= min()) return 0;
    if (radius >= max()) return 1;
    return normal_between(alpha_, (std::log(radius) - mu_) / sigma_) / mass_;
  }

  double moment_above(int k, double radius) const override {
    if (radius >= max()) return 0;
    const double from = radius > min() ? (std::log(radius) - mu_) / sigma_ : alpha_;
    const double shift = k * sigma_;
    return std::exp(k * mu_ + 0.5 * shift * shift) * normal_between(from - shift, beta_ - shift) / mass_;
  }

 private:
  double mu_, sigma_, alpha_, beta_, mass_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_lognormal(double median, double sigma, Basis basis, double min,
                                                 double max) {
  require_positive("the median radius", median);
  require_positive("sigma", sigma);
  if (!(min >= 0 && min < max))
    throw Error(ErrorCode::bad_argument,
                fmt::format("the radii are cut to [{}, {}], which is no interval", min, max));
  // A distribution by volume is the number density times r³, with the same sigma and another median.
  const double mu = std::log(median) - (counts_volume(basis) ? 3 * sigma * sigma : 0);
  auto lognormal = std::make_unique<Lognormal>(mu, sigma, min, max);
  if (!(lognormal->mass() > 0))
    throw Error(ErrorCode::bad_argument,
                fmt::format("no radius of this lognormal distribution lies in [{}, {}]", min, max));
  return lognormal;
}

std::unique_ptr<SizeDistribution> make_lognormal_of_means(double r43, double r32, double min, double max) {
  require_positive("the volume-weighted mean radius", r43);
  require_positive("the surface-weighted mean radius", r32);
  if (r43 <= r32)
    throw Error(
        ErrorCode::bad_argument,
        fmt::format("the volume-weighted mean {} must exceed the surface-weighted mean {}", r43, r32));
  return make_lognormal(std::sqrt(r43 * r32), std::sqrt(std::log(r43 / r32)), Basis::volume, min, max);
}

std::unique_ptr<SizeDistribution> make_lognormal_of_mean(double mean, double deviation, Basis basis,
                                                         double min, double max) {
  require_positive("the mean radius", mean);
  require_positive("the standard deviation", deviation);
  const double square = std::pow(deviation / mean, 2);
  return make_lognormal(mean / std::sqrt(1 + square), std::sqrt(std::log1p(square)), basis, min, max);
}

}  // namespace bernal

#include <algorithm>
#include <cmath>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"

namespace bernal {
namespace {

/// The number density is proportional to r^(n-1) on [a, b]. n = 1 is uniform by number; if the share of the
/// volume below r grows as r^q, n is q - 3, because a sphere's volume grows as r³; the limit q = 0 is ln r.
/// Preconditions: 0 < a < b, finite. With l = ln(b / a) and g(n) = (e^(n l) - 1) / n,
///   F(r) = (e^(n ln(r/a)) - 1) / (e^(n l) - 1),   <r^k> = a^k g(n + k) / g(n);
/// the same with r for a, times (r/a)^n, is the contribution of radii above r.
class PowerLaw final : public SizeDistribution {
 public:
  PowerLaw(double a, double b, double n)
      : SizeDistribution(a, b), a_(a), b_(b), n_(n), l_(std::log1p((b - a) / a)) {}

  double quantile(double p) const override {
    double r;
    if (n_ == 1) {
      r = a_ + p * (b_ - a_);
    } else if (n_ == 0) {
      r = a_ * std::exp(p * l_);
    } else {
      r = a_ * std::exp(std::log1p(p * std::expm1(n_ * l_)) / n_);
    }
    return p >= 1 ? b_ : std::clamp(r, a_, b_);
  }

  double cumulative(double radius) const override {
    const double r = std::clamp(radius, a_, b_);
    if (n_ == 1) return (r - a_) / (b_ - a_);
    return integral(n_, std::log1p((r - a_) / a_)) / integral(n_, l_);
  }

  double moment_above(int k, double radius) const override {
    const double r = std::clamp(radius, a_, b_);
    return std::pow(r, k) * std::pow(r / a_, n_) * integral(n_ + k, std::log1p((b_ - r) / r)) /
           integral(n_, l_);
  }

 private:
  static double integral(double n, double l) { return n == 0 ? l : std::expm1(n * l) / n; }

  double a_, b_, n_, l_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_uniform(double min, double max, Basis basis) {
  require_positive("the smallest radius", min);
  require_positive("the largest radius", max);
  if (min > max)
    throw Error(ErrorCode::bad_argument,
                fmt::format("the smallest radius {} is larger than the largest {}", min, max));
  if (min == max) return make_constant(min);
  return std::make_unique<PowerLaw>(min, max, counts_volume(basis) ? -2 : 1);
}

std::unique_ptr<SizeDistribution> make_fuller(double max, double exponent, double min) {
  require_positive("the largest radius", max);
  require_positive("the exponent", exponent);
  require_interval(min, max);
  return std::make_unique<PowerLaw>(min, max, exponent - 3);
}

std::unique_ptr<SizeDistribution> make_sieve(std::vector<double> radii, std::vector<double> passing,
                                             Basis basis) {
  if (radii.size() < 2 || radii.size() != passing.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("a sieve analysis needs two sieves or more and what passes each of them; got {} "
                            "and {}",
                            radii.size(), passing.size()));
  require_ascending("the sieves", radii);
  if (passing.front() != 0)
    throw Error(ErrorCode::bad_argument,
                fmt::format("nothing may pass the finest sieve, but {} does", passing.front()));
  const double even_over_the_logarithm = counts_volume(basis) ? -3 : 0;
  std::vector<std::unique_ptr<SizeDistribution>> fractions;
  std::vector<double> amounts;
  for (std::size_t i = 1; i < radii.size(); ++i) {
    if (!(passing[i] >= passing[i - 1] && std::isfinite(passing[i])))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("less passes the sieve {} than a finer one", radii[i]));
    if (passing[i] == passing[i - 1]) continue;
    fractions.push_back(std::make_unique<PowerLaw>(radii[i - 1], radii[i], even_over_the_logarithm));
    amounts.push_back(passing[i] - passing[i - 1]);
  }
  return make_mixture(std::move(fractions), std::move(amounts), basis);
}

std::unique_ptr<SizeDistribution> make_histogram(std::vector<double> edges, std::vector<double> amounts,
                                                 Basis basis) {
  if (edges.size() != amounts.size() + 1 || amounts.empty())
    throw Error(ErrorCode::bad_argument,
                fmt::format("a histogram needs one edge more than amounts, at least two; got {} and {}",
                            edges.size(), amounts.size()));
  std::vector<std::unique_ptr<SizeDistribution>> bins;
  std::vector<double> filled;
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    if (!(edges[i] < edges[i + 1]))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("the edges must ascend, but {} stands before {}", edges[i], edges[i + 1]));
    if (!(amounts[i] >= 0 && std::isfinite(amounts[i])))
      throw Error(ErrorCode::bad_argument,
                  fmt::format("what is in a bin must be finite and at least 0, not {}", amounts[i]));
    if (amounts[i] == 0) continue;
    bins.push_back(make_uniform(edges[i], edges[i + 1], basis));
    filled.push_back(amounts[i]);
  }
  return make_mixture(std::move(bins), std::move(filled), basis);
}

}  // namespace bernal

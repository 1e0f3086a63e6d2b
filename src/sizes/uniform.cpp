#include <algorithm>
#include <cmath>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"

namespace bernal {
namespace {

/// Number density proportional to r^(n-1) on [a, b]: n = 1 is uniform by number, n = -2 is uniform by volume,
/// because a sphere's volume grows as r³. With l = ln(b / a) and g(n) = (e^(n l) - 1) / n,
///   F(r) = (e^(n ln(r/a)) - 1) / (e^(n l) - 1),   <r^k> = a^k g(n + k) / g(n);
/// the same with r for a, times (r/a)^n, is what radii above r contribute.
class Uniform final : public SizeDistribution {
 public:
  Uniform(double a, double b, Basis basis)
      : a_(a), b_(b), n_(basis == Basis::number ? 1 : -2), l_(std::log1p((b - a) / a)) {}

  std::string_view name() const override { return "uniform"; }

  double quantile(double p) const override {
    const double r = n_ == 1 ? a_ + p * (b_ - a_) : a_ / std::sqrt(1 - p * -std::expm1(-2 * l_));
    return std::clamp(r, a_, b_);
  }

  double cumulative(double radius) const override {
    const double r = std::clamp(radius, a_, b_);
    if (n_ == 1) return (r - a_) / (b_ - a_);
    return std::expm1(n_ * std::log1p((r - a_) / a_)) / std::expm1(n_ * l_);
  }

  double moment(int k) const override { return moment_above(k, a_); }

  double moment_above(int k, double radius) const override {
    const double r = std::clamp(radius, a_, b_);
    return std::pow(r, k) * std::pow(r / a_, n_) * integral(n_ + k, std::log1p((b_ - r) / r)) /
           integral(n_, l_);
  }

  double min() const override { return a_; }
  double max() const override { return b_; }

 private:
  static double integral(int n, double l) { return n == 0 ? l : std::expm1(n * l) / n; }

  double a_;
  double b_;
  int n_;
  double l_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_uniform(double min, double max, Basis basis) {
  require_positive("the smallest radius", min);
  require_positive("the largest radius", max);
  if (min > max)
    throw Error(ErrorCode::bad_argument,
                fmt::format("the smallest radius {} is larger than the largest {}", min, max));
  if (min == max) return make_constant(min);
  return std::make_unique<Uniform>(min, max, basis);
}

}  // namespace bernal

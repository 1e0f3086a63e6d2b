#include "sizes/power_law.hpp"

#include <algorithm>
#include <cmath>

namespace bernal {
namespace {

/// With l = ln(b / a) and g(n) = (e^(n l) - 1) / n,
///   F(r) = (e^(n ln(r/a)) - 1) / (e^(n l) - 1),   <r^k> = a^k g(n + k) / g(n);
/// the same with r for a, times (r/a)^n, is what radii above r contribute.
class PowerLaw final : public SizeDistribution {
 public:
  PowerLaw(std::string_view name, double a, double b, double n)
      : name_(name), a_(a), b_(b), n_(n), l_(std::log1p((b - a) / a)) {}

  std::string_view name() const override { return name_; }

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

  double moment(int k) const override { return moment_above(k, a_); }

  double moment_above(int k, double radius) const override {
    const double r = std::clamp(radius, a_, b_);
    return std::pow(r, k) * std::pow(r / a_, n_) * integral(n_ + k, std::log1p((b_ - r) / r)) /
           integral(n_, l_);
  }

  double min() const override { return a_; }
  double max() const override { return b_; }

 private:
  static double integral(double n, double l) { return n == 0 ? l : std::expm1(n * l) / n; }

  std::string_view name_;
  double a_;
  double b_;
  double n_;
  double l_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_power_law(std::string_view name, double a, double b, double n) {
  return std::make_unique<PowerLaw>(name, a, b, n);
}

}  // namespace bernal

#pragma once
#include <algorithm>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"
#include "core/rounding.hpp"

namespace bernal {

/// Another distribution with all radii larger by the same length: R = r + by, by >= 0, rounded up. The other
/// must outlive it. Moments by the binomial theorem, <R^k> = Σ_j C(k, j) by^(k-j) <r^j>; k >= 0.
class Enlarged final : public SizeDistribution {
 public:
  Enlarged(const SizeDistribution& of, double by)
      : SizeDistribution(sum_rounded_up(of.min(), by), sum_rounded_up(of.max(), by)), of_(of), by_(by) {}

  double quantile(double p) const override { return larger(of_.quantile(p)); }
  double radius_at(double u) const override { return larger(of_.radius_at(u)); }
  double cumulative(double radius) const override {
    return radius < by_ ? 0 : of_.cumulative(sum_rounded_up(radius, -by_));
  }
  double moment_above(int k, double radius) const override {
    const double from = std::max(0.0, radius - by_);
    double sum = 0, factor = 1;  // C(k, j) by^(k-j), from j = k on
    for (int j = k; j >= 0; --j) {
      sum += factor * of_.moment_above(j, from);
      factor *= by_ * j / (k - j + 1);
    }
    return sum;
  }
  std::vector<double> atoms() const override {
    std::vector<double> all = of_.atoms();
    for (double& radius : all) radius = larger(radius);
    return all;
  }

 private:
  double larger(double radius) const { return sum_rounded_up(radius, by_); }

  const SizeDistribution& of_;
  double by_;
};

}  // namespace bernal

#pragma once
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// Another distribution with all radii times the same factor above 0: R = factor · r. Moments by
/// <R^k> = factor^k <r^k>.
class Scaled final : public SizeDistribution {
 public:
  Scaled(std::unique_ptr<SizeDistribution> of, double factor)
      : SizeDistribution(factor * of->min(), factor * of->max()), of_(std::move(of)), factor_(factor) {}

  double quantile(double p) const override { return factor_ * of_->quantile(p); }
  double radius_at(double u) const override { return factor_ * of_->radius_at(u); }
  double cumulative(double radius) const override { return of_->cumulative(radius / factor_); }
  double moment(int k) const override { return std::pow(factor_, k) * of_->moment(k); }
  double moment_above(int k, double radius) const override {
    return std::pow(factor_, k) * of_->moment_above(k, radius / factor_);
  }
  std::vector<double> atoms() const override {
    std::vector<double> all = of_->atoms();
    for (double& radius : all) radius *= factor_;
    return all;
  }

 private:
  std::unique_ptr<SizeDistribution> of_;
  double factor_;
};

}  // namespace bernal

#pragma once
#include <algorithm>

#include "bernal/sizes/size_distribution.hpp"

namespace bernal {

/// A distribution truncated above `max`, as if larger radii were drawn again. The other must outlive it.
/// Precondition: `max` is below its own, and a share of its number is at or below that.
class CutAbove final : public SizeDistribution {
 public:
  CutAbove(const SizeDistribution& of, double max)
      : SizeDistribution(of.min(), max), of_(of), share_(of.cumulative(max)) {}

  double quantile(double p) const override { return std::min(max(), of_.quantile(p * share_)); }
  double cumulative(double radius) const override {
    return radius >= max() ? 1 : of_.cumulative(radius) / share_;
  }
  double moment_above(int k, double radius) const override {
    if (radius >= max()) return 0;
    return std::max(0.0, of_.moment_above(k, radius) - of_.moment_above(k, max())) / share_;
  }
  std::vector<double> atoms() const override {
    std::vector<double> kept = of_.atoms();
    std::erase_if(kept, [this](double radius) { return radius > max(); });
    return kept;
  }

 private:
  const SizeDistribution& of_;
  double share_;
};

}  // namespace bernal

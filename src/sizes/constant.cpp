#include <cmath>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"

namespace bernal {
namespace {

class Constant final : public SizeDistribution {
 public:
  explicit Constant(double radius) : radius_(radius) {}

  std::string_view name() const override { return "constant"; }
  double quantile(double) const override { return radius_; }
  double cumulative(double radius) const override { return radius < radius_ ? 0 : 1; }
  double moment(int k) const override { return std::pow(radius_, k); }
  double moment_above(int k, double radius) const override { return radius < radius_ ? moment(k) : 0; }
  double min() const override { return radius_; }
  double max() const override { return radius_; }
  std::vector<double> atoms() const override { return {radius_}; }

 private:
  double radius_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_constant(double radius) {
  require_positive("the radius", radius);
  return std::make_unique<Constant>(radius);
}

}  // namespace bernal

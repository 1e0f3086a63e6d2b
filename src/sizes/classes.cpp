#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <ranges>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"

namespace bernal {
namespace {

struct Class {
  double radius;
  double share;  ///< of the number; all shares sum to 1
  double up_to;  ///< share of this class and all smaller ones
  /// Σ share r^k over this class and all larger ones, k = 0 … 3.
  std::array<double, 4> from = {};
};

class Classes final : public SizeDistribution {
 public:
  /// Precondition: ascending radii, shares that sum to 1.
  explicit Classes(std::vector<Class> classes)
      : SizeDistribution(classes.front().radius, classes.back().radius), classes_(std::move(classes)) {
    std::array<double, 4> from = {};
    for (Class& c : classes_ | std::views::reverse) {
      double part = c.share;
      for (double& sum : from) {
        sum += part;
        part *= c.radius;
      }
      c.from = from;
    }
  }

  double quantile(double p) const override {
    const auto reaches = [](const Class& c, double value) { return c.up_to < value; };
    const auto found = std::lower_bound(classes_.begin(), classes_.end(), p, reaches);
    return found == classes_.end() ? max() : found->radius;
  }

  double cumulative(double radius) const override {
    const auto found = first_above(radius);
    return found == classes_.begin() ? 0 : std::prev(found)->up_to;
  }

  double moment(int k) const override {
    double sum = 0;
    for (const Class& c : classes_) sum += c.share * std::pow(c.radius, k);
    return sum;
  }

  double moment_above(int k, double radius) const override {
    const auto first = first_above(radius);
    if (first == classes_.end()) return 0;
    if (k >= 0 && k <= 3) return first->from[static_cast<std::size_t>(k)];
    double sum = 0;
    for (auto c = first; c != classes_.end(); ++c) sum += c->share * std::pow(c->radius, k);
    return sum;
  }

  std::vector<double> atoms() const override {
    std::vector<double> radii;
    for (const Class& c : classes_) radii.push_back(c.radius);
    return radii;
  }

 private:
  std::vector<Class>::const_iterator first_above(double radius) const {
    return std::ranges::upper_bound(classes_, radius, {}, &Class::radius);
  }

  std::vector<Class> classes_;
};

class Constant final : public SizeDistribution {
 public:
  explicit Constant(double radius) : SizeDistribution(radius, radius) {}

  double quantile(double) const override { return min(); }
  double cumulative(double radius) const override { return radius < min() ? 0 : 1; }
  double moment(int k) const override { return std::pow(min(), k); }
  double moment_above(int k, double radius) const override { return radius < min() ? moment(k) : 0; }
  std::vector<double> atoms() const override { return {min()}; }
};

}  // namespace

std::unique_ptr<SizeDistribution> make_constant(double radius) {
  require_positive("the radius", radius);
  return std::make_unique<Constant>(radius);
}

std::unique_ptr<SizeDistribution> make_classes(std::vector<double> radii, std::vector<double> shares,
                                               Basis basis) {
  if (radii.empty() || radii.size() != shares.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("size classes need as many shares as radii, at least one; got {} and {}",
                            shares.size(), radii.size()));
  std::vector<Class> classes;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    require_positive("the radius of a size class", radii[i]);
    require_positive("the share of a size class", shares[i]);
    classes.push_back({.radius = radii[i], .share = shares[i], .up_to = 0});
  }
  std::ranges::sort(classes, {}, &Class::radius);
  const auto same = std::ranges::adjacent_find(classes, {}, &Class::radius);
  if (same != classes.end())
    throw Error(ErrorCode::bad_argument, fmt::format("two size classes have the radius {}", same->radius));

  // Numbers are volumes over sphere volumes; relative to the smallest sphere, so that nothing overflows.
  if (counts_volume(basis))
    for (Class& c : classes) c.share *= std::pow(classes.front().radius / c.radius, 3);
  const double total = std::transform_reduce(classes.begin(), classes.end(), 0.0, std::plus{},
                                             [](const Class& c) { return c.share; });
  double up_to = 0;
  for (Class& c : classes) {
    c.share /= total;
    c.up_to = up_to += c.share;
  }
  classes.back().up_to = 1;
  return std::make_unique<Classes>(std::move(classes));
}

}  // namespace bernal

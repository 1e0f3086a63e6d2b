#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

#include <boost/math/tools/toms748_solve.hpp>

#include "bernal/sizes/size_distribution.hpp"
#include "sizes/check.hpp"

namespace bernal {
namespace {

/// The smallest double r with f(r) >= p, for a nondecreasing f with jumps and plateaus, f(low) < p <=
/// f(high).
template <class F>
double first_reaching(F f, double p, double low, double high) {
  // On a plateau at p any point would be a root, so none may look like one.
  const auto excess = [&](double r) {
    const double above = f(r) - p;
    return above == 0 ? std::numeric_limits<double>::min() : above;
  };
  std::uintmax_t most_steps = 100;
  std::tie(low, high) = boost::math::tools::toms748_solve(
      excess, low, high, excess(low), excess(high), boost::math::tools::eps_tolerance<double>(), most_steps);
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) return high;
    (excess(middle) < 0 ? low : high) = middle;
  }
}

struct Part {
  std::unique_ptr<SizeDistribution> sizes;
  double share;  ///< of the number; all shares sum to 1
  double up_to;  ///< sum of the shares up to this part
};

/// F = Σ share F_part; the same for moments.
class Mixture final : public SizeDistribution {
 public:
  explicit Mixture(std::vector<Part> parts) : parts_(std::move(parts)) {
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const Part& part : parts_) {
      least = std::min(least, part.sizes->min());
      most = std::max(most, part.sizes->max());
    }
    set_limits(least, most);
  }

  double quantile(double p) const override {
    if (p <= 0) return min();
    if (p >= 1) return max();
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const Part& part : parts_) {
      const double r = part.sizes->quantile(p);
      low = std::min(low, r);
      high = std::max(high, r);
    }
    if (cumulative(low) >= p) return low;
    if (cumulative(high) <= p) return high;  // by rounding
    return first_reaching([&](double r) { return cumulative(r); }, p, low, high);
  }

  double cumulative(double radius) const override {
    if (radius >= max()) return 1;
    return sum([&](const SizeDistribution& part) { return part.cumulative(radius); });
  }

  double moment(int k) const override {
    return sum([&](const SizeDistribution& part) { return part.moment(k); });
  }

  double moment_above(int k, double radius) const override {
    return sum([&](const SizeDistribution& part) { return part.moment_above(k, radius); });
  }

  std::vector<double> atoms() const override {
    std::vector<double> radii;
    for (const Part& part : parts_) std::ranges::copy(part.sizes->atoms(), std::back_inserter(radii));
    std::ranges::sort(radii);
    radii.erase(std::ranges::unique(radii).begin(), radii.end());
    return radii;
  }

  /// The part that contains u, and its radius at the rest of u. No root finding.
  double radius_at(double u) const override {
    const auto before = [](const Part& part, double value) { return part.up_to <= value; };
    auto part = std::lower_bound(parts_.begin(), parts_.end(), u, before);
    if (part == parts_.end()) --part;
    const double within = (u - (part->up_to - part->share)) / part->share;
    return part->sizes->radius_at(std::clamp(within, 0x1p-54, 1 - 0x1p-53));
  }

 private:
  template <class F>
  double sum(F of_part) const {
    double total = 0;
    for (const Part& part : parts_) total += part.share * of_part(*part.sizes);
    return total;
  }

  std::vector<Part> parts_;
};

}  // namespace

std::unique_ptr<SizeDistribution> make_mixture(std::vector<std::unique_ptr<SizeDistribution>> of,
                                               std::vector<double> shares, Basis basis) {
  if (of.empty() || of.size() != shares.size())
    throw Error(ErrorCode::bad_argument,
                fmt::format("a mixture needs as many shares as distributions, at least one; got {} and {}",
                            shares.size(), of.size()));
  double total = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    require_positive("the share of a part of a mixture", shares[i]);
    // Numbers are volumes over mean sphere volumes; relative to the first, so that nothing overflows.
    if (counts_volume(basis)) shares[i] *= of.front()->moment(3) / of[i]->moment(3);
    total += shares[i];
  }
  std::vector<Part> parts;
  double up_to = 0;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const double share = shares[i] / total;
    parts.push_back({std::move(of[i]), share, up_to += share});
  }
  return std::make_unique<Mixture>(std::move(parts));
}

}  // namespace bernal

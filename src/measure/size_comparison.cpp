#include "bernal/measure/size_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <boost/math/special_functions/gamma.hpp>

#include "sizes/volume_carriers.hpp"

namespace bernal {
namespace {

/// Radii that differ by less, relatively, are one size; distributions are compared just below and just above.
constexpr double same = 1e-12;
/// Least share of a single size that is an atom of the distribution: far more than the narrowest continuous
/// distribution has within `same`.
constexpr double atom = 1e-6;
constexpr double fewest_expected = 5;
constexpr std::size_t most_classes = 1000;
/// The most sizes whose shares are listed one by one; for more, tenths of the volume are. Limits closer than
/// this are merged.
constexpr std::size_t most_sizes_listed = 20;
constexpr int tenths = 10;
constexpr double same_limit = 1e-6;
/// The largest deviation from 1 of a common factor of all radii.
constexpr double most_scaled = 0.05;

double below(const SizeDistribution& asked, double radius) { return asked.cumulative(radius * (1 - same)); }
double up_to(const SizeDistribution& asked, double radius) { return asked.cumulative(radius * (1 + same)); }

/// 1 - K(lambda) for Kolmogorov's distribution K, by the faster converging of its two series.
double kolmogorov_above(double lambda) {
  if (lambda <= 0) return 1;
  if (lambda < 1.18) {
    const double y = std::exp(-std::numbers::pi * std::numbers::pi / (8 * lambda * lambda));
    const double scale = std::sqrt(2 * std::numbers::pi) / lambda;
    return 1 - scale * (y + std::pow(y, 9) + std::pow(y, 25) + std::pow(y, 49));
  }
  const double x = std::exp(-2 * lambda * lambda);
  return 2 * (x - std::pow(x, 4) + std::pow(x, 9));
}

void compare_cumulative(const std::vector<double>& sorted, const SizeDistribution& asked,
                        SizeComparison& result) {
  const auto n = static_cast<double>(sorted.size());
  bool continuous = true;
  for (std::size_t i = 0, j = 0; i < sorted.size(); i = j) {
    while (j < sorted.size() && sorted[j] <= sorted[i] * (1 + same)) ++j;
    const double from = below(asked, sorted[i]), to = up_to(asked, sorted[j - 1]);
    result.ks_statistic = std::max({result.ks_statistic, std::abs(static_cast<double>(i) / n - from),
                                    std::abs(static_cast<double>(j) / n - to)});
    continuous = continuous && to - from < atom;
  }
  if (continuous) {
    const double root = std::sqrt(n);
    result.ks_p_value = kolmogorov_above((root + 0.12 + 0.11 / root) * result.ks_statistic);
  }
}

/// The sizes of a discrete distribution, ascending, with their shares; empty for any other.
std::vector<SizeComparison::Class> classes_of(const SizeDistribution& asked) {
  std::vector<SizeComparison::Class> classes;
  for (double reached = 0; reached < 1 - atom;) {
    const double radius = asked.quantile(reached + 0.5 * atom);
    const double share = up_to(asked, radius) - below(asked, radius);
    if (share < atom || classes.size() == most_classes) return {};
    classes.push_back({radius, share, 0});
    reached = up_to(asked, radius);
  }
  return classes;
}

void compare_classes(const std::vector<double>& sorted, const SizeDistribution& asked,
                     SizeComparison& result) {
  result.classes = classes_of(asked);
  bool enough = result.classes.size() > 1;
  for (SizeComparison::Class& c : result.classes) {
    const auto first = std::ranges::lower_bound(sorted, c.radius * (1 - same));
    const auto last = std::ranges::upper_bound(sorted, c.radius * (1 + same));
    c.count = static_cast<std::uint64_t>(last - first);
    const double expected = c.asked_share * static_cast<double>(sorted.size());
    enough = enough && expected >= fewest_expected;
    result.chi_squared += std::pow(static_cast<double>(c.count) - expected, 2) / expected;
  }
  if (enough) {
    const double half_freedom = 0.5 * static_cast<double>(result.classes.size() - 1);
    result.chi_squared_p_value = boost::math::gamma_q(half_freedom, 0.5 * result.chi_squared);
  }
}

void compare_means(const std::vector<double>& sorted, const SizeDistribution& asked, int dimension,
                   SizeComparison& result) {
  const auto n = static_cast<double>(sorted.size());
  double sum = 0, sum_of_volumes = 0;
  for (const double r : sorted) {
    sum += r;
    sum_of_volumes += std::pow(r, dimension);
  }
  const double asked_volume = asked.moment(dimension);
  result.mean_radius = sum / n;
  result.asked_mean_radius = asked.moment(1);
  result.volume_ratio = sum_of_volumes / n / asked_volume;
  const double variance = asked.moment(2 * dimension) / (asked_volume * asked_volume) - 1;
  result.volume_ratio_error = std::sqrt(std::max(0.0, variance) / n);
}

/// Limits of tenths of the volume, ascending; equal ones merged.
std::vector<double> limits_by_volume(const SizeDistribution& asked, int dimension) {
  std::vector<double> limits;
  for (int k = tenths - 1; k > 0; --k) {
    const double limit = radius_holding(asked, static_cast<double>(k) / tenths, dimension);
    if (limits.empty() || limit > limits.back() * (1 + same_limit)) limits.push_back(limit);
  }
  if (limits.back() < asked.max()) limits.push_back(asked.max());
  return limits;
}

void compare_shares(const std::vector<double>& sorted, const SizeDistribution& asked, int dimension,
                    SizeComparison& result) {
  if (asked.min() == asked.max()) return;
  const auto n = static_cast<double>(sorted.size());
  const double asked_volume = asked.moment(dimension);
  double volume = 0;
  for (const double r : sorted) volume += std::pow(r / sorted.back(), dimension);
  // Counts from `first` up to that radius; returns the first larger one.
  const auto add = [&](std::size_t first, SizeComparison::Share share) {
    std::size_t last = first;
    for (; last < sorted.size() && sorted[last] <= share.up_to * (1 + same); ++last)
      share.volume += std::pow(sorted[last] / sorted.back(), dimension) / volume;
    share.count = last - first;
    share.number = static_cast<double>(share.count) / n;
    result.shares.push_back(share);
    return last;
  };
  std::size_t next = 0;
  if (!result.classes.empty() && result.classes.size() <= most_sizes_listed) {
    for (const SizeComparison::Class& c : result.classes)
      next = add(next, {c.radius, c.radius, c.asked_share,
                        c.asked_share * std::pow(c.radius, dimension) / asked_volume, 0, 0, 0});
    return;
  }
  double above = asked.min(), number_above = 1, volume_above = 1;
  for (const double limit : limits_by_volume(asked, dimension)) {
    const double number = asked.moment_above(0, limit * (1 + same));
    const double share = asked.moment_above(dimension, limit * (1 + same)) / asked_volume;
    next = add(next, {above, limit, number_above - number, volume_above - share, 0, 0, 0});
    above = limit;
    number_above = number;
    volume_above = share;
  }
}

/// The smallest radius at or below which this share of the spheres lies.
double quantile(const std::vector<double>& sorted, double share) {
  const double rank = std::ceil(share * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

void compare_volume_quantiles(const std::vector<double>& sorted, const SizeDistribution& asked, int dimension,
                              SizeComparison& result) {
  std::vector<double> up_to;
  double sum = 0;
  for (const double r : sorted) up_to.push_back(sum += std::pow(r / sorted.back(), dimension));
  for (const double share : {0.1, 0.5, 0.9}) {
    const auto found = std::ranges::lower_bound(up_to, share * sum);
    const auto k = std::min(sorted.size() - 1, static_cast<std::size_t>(found - up_to.begin()));
    result.volume_quantiles.push_back({share, sorted[k], radius_holding(asked, 1 - share, dimension)});
  }
}

}  // namespace

SizeComparison compare_sizes(std::span<const double> radii, const SizeDistribution& asked, int dimension) {
  std::vector<double> sorted(radii.begin(), radii.end());
  std::ranges::sort(sorted);
  SizeComparison result;
  compare_cumulative(sorted, asked, result);
  compare_classes(sorted, asked, result);
  compare_shares(sorted, asked, dimension, result);
  compare_means(sorted, asked, dimension, result);
  for (const double share : {0.0, 0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 1.0})
    result.quantiles.push_back({share, quantile(sorted, share), asked.quantile(share)});
  compare_volume_quantiles(sorted, asked, dimension, result);
  return result;
}

std::optional<DrawnComparison> compare_with_drawn(std::span<const double> radii, RadiusSequence sequence,
                                                  bool cut_tail) {
  std::vector<double> there(radii.begin(), radii.end()), drawn;
  std::ranges::sort(there);
  DrawnComparison result;
  while (drawn.size() < there.size()) {
    const double r = sequence.next();
    if (!cut_tail || r <= there.back()) {
      drawn.push_back(r);
    } else if (++result.above_largest > there.size()) {
      return {};
    }
  }
  std::ranges::sort(drawn);
  std::vector<double> missing;
  std::ranges::set_difference(drawn, there, std::back_inserter(missing));
  result.missing = missing.size();
  for (std::size_t k = 0; k < drawn.size(); ++k)
    result.largest_deviation = std::max(result.largest_deviation, std::abs(there[k] / drawn[k] - 1));
  const double scale = there.front() / drawn.front();
  const auto is_scaled = [&](double there_k, double drawn_k) {
    return std::abs(there_k / drawn_k / scale - 1) <= same;
  };
  if (result.missing > 0 && std::abs(scale - 1) <= most_scaled &&
      std::ranges::equal(there, drawn, is_scaled)) {
    result.scale = scale;
    result.missing = 0;
  }
  return result;
}

}  // namespace bernal

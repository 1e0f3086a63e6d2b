#include "bernal/measure/size_correlation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "bernal/core/dimension.hpp"
#include "bernal/measure/bond_order.hpp"
#include "measure/localised.hpp"
#include "measure/pair_distances.hpp"
#include "measure/touching.hpp"

namespace bernal {
namespace {

/// Relative to the radius: spheres that differ by less are equal.
constexpr double size_rounding = 1e-12;
constexpr double bin_slack = 1e-6;

/// Sums over pairs in bins of distance.
class MarkTally {
 public:
  MarkTally(const std::vector<double>& marks, std::size_t bins, double width)
      : marks_(&marks), counts_(bins, 0), products_(bins, 0), width_(width) {}

  double reach() const { return width_ * static_cast<double>(counts_.size()); }
  void add(std::uint32_t i, std::uint32_t j, double squared_distance) {
    const auto bin = static_cast<std::size_t>(std::sqrt(squared_distance) / width_);
    if (bin >= counts_.size()) return;
    ++counts_[bin];
    products_[bin] += (*marks_)[i] * (*marks_)[j];
  }
  void add(const MarkTally& other) {
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      counts_[k] += other.counts_[k];
      products_[k] += other.products_[k];
    }
  }
  void write_to(SizeCorrelation& out, double distinct) const {
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      const auto count = static_cast<double>(counts_[k]);
      out.d.push_back((static_cast<double>(k) + 0.5) * width_);
      out.c.push_back(count > 0 ? products_[k] / count : 0);
      out.error.push_back(1 / std::sqrt(std::max(1.0, distinct * count)));
    }
  }

 private:
  const std::vector<double>* marks_;
  std::vector<std::uint64_t> counts_;
  std::vector<double> products_;
  double width_;
};

/// Standardised radii; empty if all are equal.
std::vector<double> marks_of(const std::vector<double>& radii, double mean) {
  double squares = 0;
  for (const double r : radii) squares += (r / mean - 1) * (r / mean - 1);
  const double deviation = std::sqrt(squares / static_cast<double>(radii.size())) * mean;
  if (!(deviation > size_rounding * mean)) return {};
  std::vector<double> marks = radii;
  for (double& mark : marks) mark = (mark - mean) / deviation;
  return marks;
}

/// Sums over both ends of all bonds, whose order does not affect Pearson's correlation.
std::optional<SizeCorrelation::Neighbours> neighbours_of(const std::vector<NearPair>& bonds,
                                                         const std::vector<double>& marks) {
  double products = 0, sum = 0, squares = 0, n = 0;
  for (const NearPair& bond : bonds) {
    if (bond.first == bond.second) continue;  // a sphere and its own image
    const double a = marks[bond.first], b = marks[bond.second];
    products += a * b;
    sum += 0.5 * (a + b);
    squares += 0.5 * (a * a + b * b);
    ++n;
  }
  if (n == 0) return {};
  const double mean = sum / n, variance = squares / n - mean * mean;
  if (!(variance > size_rounding)) return {};
  return SizeCorrelation::Neighbours{(products / n - mean * mean) / variance, 1 / std::sqrt(n),
                                     static_cast<std::uint64_t>(n)};
}

template <int D>
double shortest_period(const TiltedBoundary<D>& boundary) {
  if (boundary.is_tilted()) return boundary.shortest_period();
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < D; ++k)
    if (boundary.repeats(k)) shortest = std::min(shortest, boundary.edges[k]);
  return shortest;
}

/// Spheres and periods may be in any unit of length, 1 / `unit` times the scene's.
template <int D>
std::optional<SizeCorrelation> correlation_in(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary,
                                              double unit, const std::vector<NearPair>& bonds,
                                              const SizeCorrelationOptions& options) {
  const double mean =
      std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
  const std::vector<double> marks = marks_of(spheres.r, mean);
  if (marks.empty()) return {};
  const double width = options.bin * 2 * mean;
  const double reach = std::min(options.reach * 2 * mean, 0.5 * shortest_period(boundary));
  const double bins = std::floor(reach / width + bin_slack);
  if (!(bins >= 1)) return {};
  SizeCorrelation found;
  const MarkTally tally =
      tally_of_pairs<D>(spheres, boundary, MarkTally(marks, static_cast<std::size_t>(bins), width),
                        options.work, found.references);
  tally.write_to(found, share_of_distinct(found.references, spheres.size()));
  found.neighbours = neighbours_of(bonds, marks);
  found.mean_diameter = 2 * mean * unit;
  found.bin_width = width * unit;
  for (double& d : found.d) d *= unit;
  return found;
}

}  // namespace

std::optional<SizeCorrelation::Mean> SizeCorrelation::mean_between(double from, double to) const {
  double sum = 0, pairs = 0;
  for (std::size_t k = 0; k < d.size(); ++k) {
    const double at = d[k] / mean_diameter;
    if (at < from || at >= to) continue;
    const double there = 1 / (error[k] * error[k]);
    sum += there * c[k];
    pairs += there;
  }
  if (!(pairs > 0)) return {};
  return Mean{sum / pairs, 1 / std::sqrt(pairs)};
}

std::optional<SizeCorrelation> size_correlation(const Spheres<dynamic>& spheres, const Domain& domain,
                                                const SizeCorrelationOptions& options) {
  if (spheres.size() < 2) return {};
  const auto [smallest, largest] = std::ranges::minmax(spheres.r);
  if (smallest == largest) return {};  // cheap test first
  const std::vector<NearPair> bonds =
      near_pairs_inside(spheres, domain, BondOrder::widest_gap,
                        spheres.size() > BondOrder::most_spheres ? BondOrder::looked_at : spheres.size());
  if (has_walls(domain) && dimension_of(domain) == 3) {
    const Frame frame = frame_of(domain);
    return correlation_in<3>(localised(spheres, frame), localised(boundary_of<3>(domain), frame), frame.scale,
                             bonds, options);
  }
  return with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    return correlation_in<D>(spheres.in<D>(), tilted_boundary_of<D>(domain), 1, bonds, options);
  });
}

}  // namespace bernal

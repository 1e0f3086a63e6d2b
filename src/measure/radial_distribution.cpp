#include "bernal/measure/radial_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/core/dimension.hpp"
#include "measure/pair_distances.hpp"

namespace bernal {
namespace {

/// A distance may be below a bin by this share of the width and still count in it: a rounded contact.
constexpr double slack = 1e-6;

/// A histogram of distances.
class Histogram {
 public:
  Histogram(std::size_t bins, double width) : counts_(bins, 0), width_(width) {}

  double reach() const { return width_ * static_cast<double>(counts_.size()); }
  void add(std::uint32_t, std::uint32_t, double squared_distance) {
    const auto bin = static_cast<std::size_t>(std::sqrt(squared_distance) / width_ + slack);
    if (bin < counts_.size()) ++counts_[bin];
  }
  void add(const Histogram& other) {
    for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += other.counts_[k];
  }
  const std::vector<std::uint64_t>& counts() const { return counts_; }

 private:
  std::vector<std::uint64_t> counts_;
  double width_;
};

double shell_volume(int dimension, double from, double to) {
  return ball_volume(dimension, to) - ball_volume(dimension, from);
}

/// Pairs of two references count from both ends; the error is that of the expected number of distinct pairs.
void normalise(const std::vector<std::uint64_t>& counts, const Spheres<dynamic>& spheres, double volume,
               RadialDistribution& radial) {
  const auto n = static_cast<double>(spheres.size());
  const auto references = static_cast<double>(radial.references);
  const double density = (n - 1) / volume;
  const double distinct = share_of_distinct(radial.references, spheres.size());
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double from = static_cast<double>(k) * radial.bin_width, to = from + radial.bin_width;
    const double expected = references * density * shell_volume(spheres.dimension(), from, to);
    const auto count = static_cast<double>(counts[k]);
    radial.r.push_back(0.5 * (from + to));
    radial.g.push_back(count / expected);
    radial.error.push_back(std::sqrt(std::max(1.0, count / distinct)) / expected);
  }
}

void find_peaks(RadialDistribution& radial) {
  if (radial.radius_spread > RadialDistribution::most_spread) return;
  for (const auto& [from, to] : {std::pair{0.9, 1.2}, std::pair{1.6, 1.85}, std::pair{1.9, 2.1}}) {
    const auto bin = [&, width = radial.bin_width](double diameters) {
      return std::min(radial.g.size(),
                      static_cast<std::size_t>(std::lround(diameters * radial.mean_diameter / width)));
    };
    const std::size_t first = bin(from), end = bin(to);
    if (end == radial.g.size() || first == 0) continue;
    const auto k =
        static_cast<std::size_t>(std::max_element(radial.g.begin() + static_cast<std::ptrdiff_t>(first),
                                                  radial.g.begin() + static_cast<std::ptrdiff_t>(end)) -
                                 radial.g.begin());
    if (radial.g[k] > radial.g[k - 1] && radial.g[k] > radial.g[k + 1])
      radial.peaks.push_back({radial.r[k], radial.g[k], radial.error[k]});
  }
}

}  // namespace

std::optional<RadialDistribution> radial_distribution(const Spheres<dynamic>& spheres, const Domain& domain,
                                                      const RadialOptions& options) {
  const std::vector<double>& radii = spheres.r;
  if (has_walls(domain) || radii.size() < 2) return {};
  const auto n = static_cast<double>(radii.size());
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / n;
  double squares = 0;
  for (const double r : radii) squares += (r / mean - 1) * (r / mean - 1);

  RadialDistribution radial;
  radial.mean_diameter = 2 * mean;
  radial.radius_spread = std::sqrt(squares / n);
  radial.bin_width = options.bin * radial.mean_diameter;
  const double reach =
      std::min(options.reach * radial.mean_diameter, 0.5 * bounds_of<dynamic>(domain).size().minCoeff());
  const double bins = std::floor(reach / radial.bin_width + slack);
  if (!(bins >= 1)) return {};
  const Histogram empty(static_cast<std::size_t>(bins), radial.bin_width);
  Histogram found = empty;
  with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    found =
        tally_of_pairs<D>(spheres.in<D>(), boundary_of<D>(domain), empty, options.work, radial.references);
  });
  normalise(found.counts(), spheres, volume_of(domain), radial);
  find_peaks(radial);
  return radial;
}

}  // namespace bernal

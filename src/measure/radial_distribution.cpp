#include "bernal/measure/radial_distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "core/parallel.hpp"
#include "measure/depths.hpp"
#include "measure/localised.hpp"
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

/// How many bins end where two spheres of the smallest radius touch, or nearer. No pair can be in them, so
/// that nothing is left to chance; where spheres overlap and one is, there are no such bins.
std::size_t bins_below_contact(const std::vector<std::uint64_t>& counts, double width, double smallest) {
  const auto bins =
      std::min(counts.size(), static_cast<std::size_t>(std::floor(2 * smallest / width + slack)));
  const bool is_hard = std::all_of(counts.begin(), counts.begin() + static_cast<std::ptrdiff_t>(bins),
                                   [](std::uint64_t count) { return count == 0; });
  return is_hard ? bins : 0;
}

/// Pairs of two references count from both ends; the error is that of the expected number of distinct pairs.
void normalise(const std::vector<std::uint64_t>& counts, int dimension, const std::vector<double>& radii,
               std::size_t spheres, double volume, RadialDistribution& radial) {
  const auto n = static_cast<double>(spheres);
  const auto references = static_cast<double>(radial.references);
  const double density = (n - 1) / volume;
  const double distinct = share_of_distinct(radial.references, spheres);
  const std::size_t empty = bins_below_contact(counts, radial.bin_width, *std::ranges::min_element(radii));
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const double from = static_cast<double>(k) * radial.bin_width, to = from + radial.bin_width;
    const double share = radial.share.empty() ? 1 : radial.share[k];
    const double expected = references * density * share * shell_volume(dimension, from, to);
    const auto count = static_cast<double>(counts[k]);
    const double g = count / expected;
    radial.r.push_back(0.5 * (from + to));
    radial.g.push_back(g);
    if (k < empty) {
      radial.error.push_back(0);
      continue;
    }
    const double of_share = radial.share.empty() ? 0 : g * radial.share_error[k] / share;
    radial.error.push_back(std::hypot(std::sqrt(std::max(1.0, count / distinct)) / expected, of_share));
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

/// Where centres may be between walls.
struct Window {
  const Container& container;  ///< in its own frame, as all that follows
  std::optional<LowerPart> below;
  double margin;  ///< from the walls
  double volume;

  bool contains(const Vector<3>& p) const {
    return (!below || below->contains(p)) && container.clearance_within(p, 2 * margin) >= margin;
  }
};

/// Those that lie there, with the rounding of those that touch the walls.
Spheres<3> centers_in(const Window& window, const Spheres<3>& all) {
  constexpr double rounding = 1e-6;
  std::vector<std::uint8_t> inside(all.size());
  parallel_for(all.size(), [&](std::size_t i) {
    const Vector<3> c = all.center(i);
    inside[i] = (!window.below || window.below->contains(c)) &&
                window.container.clearance_within(c, 2 * window.margin) >= (1 - rounding) * window.margin;
  });
  Spheres<3> centers;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (inside[i]) centers.push_back(all.center(i), all.r[i]);
  return centers;
}

/// The mean share of the shells about the centres that lies in the window: of every bin as many places, each
/// in a random direction from one of the centres, which take turns.
void sample_shares(const Window& window, const Spheres<3>& centers, double width, double places,
                   RadialDistribution& radial, std::size_t bins) {
  constexpr double fewest = 200;
  const auto tried = static_cast<std::size_t>(std::max(fewest, places / static_cast<double>(bins)));
  const std::size_t n = centers.size();
  radial.share.assign(bins, 0);
  radial.share_error.assign(bins, 0);
  parallel_for(bins, [&](std::size_t bin) {
    Random random(3, stream(Stream::measure, bin));
    std::size_t inside = 0;
    for (std::size_t k = 0; k < tried; ++k) {
      // As evenly as can be over centres and over the thickness of the shell.
      const auto i = static_cast<std::size_t>((static_cast<double>(k) + random.uniform()) /
                                              static_cast<double>(tried) * static_cast<double>(n));
      const double r = (static_cast<double>(bin) + random.uniform()) * width;
      inside += window.contains(centers.center(std::min(i, n - 1)) + r * uniform_direction<3>(random));
    }
    const double share = static_cast<double>(inside) / static_cast<double>(tried);
    radial.share[bin] = share;
    radial.share_error[bin] = std::sqrt(std::max(share * (1 - share), 0.0) / static_cast<double>(tried));
  });
}

/// g(r) between walls; the bins are those of `radial`.
void between_walls(const Spheres<dynamic>& spheres, const Domain& domain, const RadialOptions& options,
                   const std::shared_ptr<const Container>& made, RadialDistribution& radial,
                   std::size_t bins) {
  const Frame frame = frame_of(domain);
  const auto container = local_container(domain, made);
  const auto below = options.below ? std::optional(options.below->to_local(frame)) : std::nullopt;
  const Spheres<3> all = localised(spheres, frame);
  const double smallest = *std::ranges::min_element(all.r), diameter = radial.mean_diameter / frame.scale;
  Window window{*container, below, diameter, 0};
  Spheres<3> centers = centers_in(window, all);
  if (2 * centers.size() < all.size()) {
    window.margin = smallest;
    centers = centers_in(window, all);
  }
  if (centers.size() < 2) return;
  const double width = radial.bin_width / frame.scale;
  const double places = options.places * (std::holds_alternative<Mesh>(domain) ? 0.2 : 1.0);
  const Depths depths(to_local(domain, frame), *container, 2 * window.margin,
                      static_cast<std::size_t>(std::max(places / 4, 1e4)), below);
  window.volume = depths.volume() * depths.deeper(window.margin);
  if (!(window.volume > 0)) return;
  sample_shares(window, centers, width, places, radial, bins);
  while (!radial.share.empty() && radial.share.back() < RadialOptions::least_share) {
    radial.share.pop_back();
    radial.share_error.pop_back();
  }
  if (radial.share.empty()) return;
  const Histogram empty(radial.share.size(), width);
  const Histogram found = tally_of_pairs<3>(centers, localised(boundary_of<3>(domain), frame), empty,
                                            options.work, radial.references);
  normalise(found.counts(), 3, spheres.r, centers.size(), window.volume * std::pow(frame.scale, 3), radial);
}

}  // namespace

std::optional<RadialDistribution> radial_distribution(const Spheres<dynamic>& spheres, const Domain& domain,
                                                      const RadialOptions& options,
                                                      const std::shared_ptr<const Container>& made) {
  const std::vector<double>& radii = spheres.r;
  const bool walls = has_walls(domain);
  if (radii.size() < 2 || (walls && dimension_of(domain) != 3)) return {};
  const auto n = static_cast<double>(radii.size());
  const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / n;
  double squares = 0;
  for (const double r : radii) squares += (r / mean - 1) * (r / mean - 1);

  RadialDistribution radial;
  radial.mean_diameter = 2 * mean;
  radial.radius_spread = std::sqrt(squares / n);
  radial.bin_width = options.bin * radial.mean_diameter;
  double reach = options.reach * radial.mean_diameter;
  with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    const auto boundary = tilted_boundary_of<dimension>(domain);
    for (const double period : boundary.edges)
      if (period > 0) reach = std::min(reach, 0.5 * period);
    if (boundary.is_tilted()) reach = std::min(reach, 0.5 * boundary.shortest_period());
  });
  const double bins = std::floor(reach / radial.bin_width + slack);
  if (!(bins >= 1)) return {};
  if (walls) {
    between_walls(spheres, domain, options, made, radial, static_cast<std::size_t>(bins));
    if (radial.r.empty()) return {};
    find_peaks(radial);
    return radial;
  }
  const Histogram empty(static_cast<std::size_t>(bins), radial.bin_width);
  Histogram found = empty;
  with_dimension(spheres.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    found = tally_of_pairs<D>(spheres.in<D>(), tilted_boundary_of<D>(domain), empty, options.work,
                              radial.references);
  });
  normalise(found.counts(), spheres.dimension(), radii, spheres.size(), volume_of(domain), radial);
  find_peaks(radial);
  return radial;
}

}  // namespace bernal

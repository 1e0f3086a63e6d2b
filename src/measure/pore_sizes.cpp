#include "bernal/measure/pore_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/random.hpp"
#include "core/parallel.hpp"
#include "domain/places.hpp"
#include "measure/even_points.hpp"
#include "measure/localised.hpp"
#include "near/sphere_tree.hpp"

namespace bernal {
namespace {

constexpr std::size_t points_a_part = 512, most_bins = 100;

/// The distances from points to the nearest solid, negative inside spheres.
std::vector<double> distances_in_period(const Spheres<dynamic>& packed, const Domain& domain,
                                        std::size_t points) {
  std::vector<double> found(points);
  with_dimension(packed.dimension(), EveryDimension{}, [&](auto dimension) {
    constexpr int D = dimension;
    const Boundary<D> boundary = boundary_of<D>(domain);
    const SphereTree<D> tree(packed.in<D>(), boundary);
    const Bounds<D> period{boundary.origin, boundary.origin + boundary.edges};
    parallel_for((points + points_a_part - 1) / points_a_part, [&](std::size_t part) {
      Random random(3, stream(Stream::measure, part));
      for (std::size_t k = part * points_a_part; k < std::min(points, (part + 1) * points_a_part); ++k)
        found[k] = tree.nearest(uniform_point<D>(random, period)).gap;
    });
  });
  return found;
}

std::vector<double> distances_between_walls(const Spheres<dynamic>& packed, const Domain& domain,
                                            const Container& container, const PoreOptions& options) {
  const Frame frame = frame_of(domain);
  const SphereTree<3> tree(localised(packed, frame), container.boundary());
  const auto below = options.below ? std::optional(options.below->to_local(frame)) : std::nullopt;
  const Bounds<3> bounds = below ? below->cut(container.bounds()) : container.bounds();
  std::vector<Vector<3>> inside = points_inside(container, options.points, 3, [&](std::size_t k) {
    return Vector<3>(bounds.lower + bounds.size().cwiseProduct(even_point(k)));
  });
  if (below) std::erase_if(inside, [&](const Vector<3>& p) { return !below->contains(p); });
  std::vector<double> found(inside.size());
  parallel_for((inside.size() + points_a_part - 1) / points_a_part, [&](std::size_t part) {
    for (std::size_t k = part * points_a_part; k < std::min(inside.size(), (part + 1) * points_a_part); ++k) {
      const double gap = tree.nearest(inside[k]).gap;
      found[k] = frame.scale * std::min(gap, container.clearance_within(inside[k], gap));
    }
  });
  return found;
}

struct Mean {
  double value = 0, error = 0;
};
template <class Of>
Mean mean_of(const std::vector<double>& distances, Of&& of) {
  const auto n = static_cast<double>(distances.size());
  Mean mean;
  double squares = 0;
  for (const double d : distances) mean.value += of(d) / n;
  for (const double d : distances) squares += (of(d) - mean.value) * (of(d) - mean.value);
  mean.error = n > 1 ? std::sqrt(squares / n / (n - 1)) : 0;
  return mean;
}

void add_histogram(const std::vector<double>& sorted, double bin, PoreSizes& pores) {
  pores.bin_width = std::max(bin, sorted.back() / most_bins);
  const auto bins = static_cast<std::size_t>(sorted.back() / pores.bin_width) + 1;
  std::vector<double> counts(bins, 0);
  for (const double d : sorted) ++counts[std::min(bins - 1, static_cast<std::size_t>(d / pores.bin_width))];
  const double one = 1 / (static_cast<double>(sorted.size()) * pores.bin_width);
  for (std::size_t k = 0; k < bins; ++k) {
    pores.d.push_back((static_cast<double>(k) + 0.5) * pores.bin_width);
    pores.density.push_back(one * counts[k]);
    pores.error.push_back(one * std::sqrt(std::max(1.0, counts[k])));
  }
}

}  // namespace

std::optional<PoreSizes> pore_sizes(const Spheres<dynamic>& spheres, const Domain& domain,
                                    const PoreOptions& options,
                                    const std::shared_ptr<const Container>& made) {
  const int dimension = dimension_of(domain);
  if (spheres.empty() || options.points == 0 || (has_walls(domain) && dimension != 2 && dimension != 3))
    return {};
  std::vector<double> distances =
      has_walls(domain) ? distances_between_walls(spheres, domain, *local_container(domain, made), options)
                        : distances_in_period(spheres, domain, options.points);
  if (distances.empty()) return {};
  PoreSizes pores;
  pores.points = distances.size();
  std::erase_if(distances, [](double d) { return !(d > 0); });
  std::ranges::sort(distances);
  pores.in_pores = distances.size();
  const auto all = static_cast<double>(pores.points), n = static_cast<double>(pores.in_pores);
  pores.porosity = n / all;
  pores.porosity_error = std::sqrt(pores.porosity * (1 - pores.porosity) / all);
  pores.mean_diameter =
      2 * std::accumulate(spheres.r.begin(), spheres.r.end(), 0.0) / static_cast<double>(spheres.size());
  if (distances.empty()) return pores;
  const Mean mean = mean_of(distances, [](double d) { return d; });
  const Mean second = mean_of(distances, [](double d) { return d * d; });
  pores.mean = mean.value;
  pores.mean_error = mean.error;
  pores.second_moment = second.value;
  pores.second_moment_error = second.error;
  pores.largest = distances.back();
  for (const double share : {0.05, 0.25, 0.5, 0.75, 0.95, 0.99}) {
    const auto k = static_cast<std::size_t>(std::ceil(share * n));
    pores.quantiles.push_back({share, distances[std::max<std::size_t>(k, 1) - 1]});
  }
  add_histogram(distances, options.bin * pores.mean_diameter, pores);
  return pores;
}

}  // namespace bernal

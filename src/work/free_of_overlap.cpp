#include "work/free_of_overlap.hpp"

#include <algorithm>

#include "bernal/core/boundary.hpp"
#include "bernal/core/tolerance.hpp"
#include "core/every_dimension.hpp"
#include "core/order.hpp"
#include "core/parallel.hpp"
#include "domain/dyadic.hpp"
#include "near/cell_grid.hpp"
#include "near/size_levels.hpp"
#include "work/random_insertion.hpp"

namespace bernal {
namespace {

/// The same as `contact_factor` for walls at 0 and at the edge: the largest r / distance of a sphere.
template <int D>
double wall_contact_factor(const Spheres<D>& spheres, const Vector<D>& edges,
                           const std::vector<bool>& walls) {
  double factor = 0;
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (std::size_t i = 0; i < spheres.size() && walls[k]; ++i) {
      const double x = spheres.x[k][i];
      factor = std::max(factor, spheres.r[i] / std::min(x, edges[static_cast<int>(k)] - x));
    }
  return factor;
}

/// Calls visit(i, j, from j to i) for all pairs whose surfaces may be nearer than the reach beyond the first
/// one's centre, reach(r, largest radius): the largest first, so that none has to look far for a larger one.
template <int D, class Reach, class Visit>
void for_each_pair(const Spheres<D>& spheres, const Vector<D>& edges, Reach&& reach, Visit&& visit) {
  const Boundary<D> boundary{edges};
  const auto [smallest, largest] = std::ranges::minmax(spheres.r);
  CellGrid<D> grid(boundary, smallest, largest, spheres.size());
  for (const std::uint32_t i : largest_first(spheres.r)) {
    const Vector<D> c = spheres.center(i);
    grid.for_each_near(c, reach(spheres.r[i], largest),
                       [&](std::uint32_t j) { visit(i, j, boundary.minimum_image(c - spheres.center(j))); });
    grid.insert(i, c, spheres.r[i]);
  }
}

/// Of more spheres the linked lists of a `CellGrid` are no longer in the cache.
constexpr std::size_t enough_for_threads = 50'000;

/// The contact factor, above one that is known, where grids of few axes find who is near, in threads: each
/// pair is met from its smaller sphere, and the largest of the ratios does not depend on the order. Also of
/// tilted boxes, each image of a pair for itself.
template <int D>
double contact_factor_by_levels(const Spheres<D>& spheres, const TiltedBoundary<D>& boundary, double known) {
  constexpr std::size_t chunk = 4096;
  constexpr double rounding = 1 + 1e-9;
  const Boundary<D> upright{boundary.edges};
  const bool is_tilted = boundary.is_tilted();
  const auto ratio = [&](std::uint32_t i, std::uint32_t j, const Vector<D>& apart) {
    return (spheres.r[i] + spheres.r[j]) / (is_tilted ? apart : upright.minimum_image(apart)).norm();
  };
  const std::vector<SizeLevel<D>> levels = levels_of<D>(spheres, boundary, 0);
  double largest = known;
  for (std::size_t l = levels.size(); l-- > 0;) {
    const PointGrid<D>& grid = *levels[l].grid;
    const std::size_t count = grid.ids().size(), parts = (count + chunk - 1) / chunk;
    std::vector<double> factors(parts, largest);
    parallel_for(parts, [&](std::size_t part) {
      const std::size_t first = part * chunk, last = std::min(count, first + chunk);
      double factor = largest;
      // Those that follow each other in the order of the cells are nearly as close as the closest.
      for (std::size_t k = first + 1; k < last; ++k)
        factor = std::max(factor, ratio(grid.ids()[k - 1], grid.ids()[k], grid.point(k - 1) - grid.point(k)));
      for (std::size_t k = first; k < last; ++k) {
        const std::uint32_t i = grid.ids()[k];
        const Vector<D> c = grid.point(k);
        for (std::size_t m = 0; m <= l; ++m) {
          const double reach = (spheres.r[i] + levels[m].largest) / factor, far = reach * reach * rounding;
          levels[m].grid->for_each_near(c, reach, [&](std::uint32_t j, const Vector<D>& apart) {
            if (apart.squaredNorm() < far && j != i)
              factor =
                  std::max(factor, ratio(i, j, is_tilted ? apart : c - boundary.wrap(spheres.center(j))));
          });
        }
      }
      factors[part] = factor;
    });
    largest = std::ranges::max(factors);
  }
  return largest;
}

}  // namespace

template <int D>
double contact_factor(const Spheres<D>& spheres, const Vector<D>& edges, const Tilt& tilt) {
  double factor = 2 * std::ranges::max(spheres.r) / edges.minCoeff();
  if constexpr (D == 2 || D == 3) {
    const TiltedBoundary<D> boundary(edges, tilt);
    if (boundary.is_tilted()) factor = 2 * std::ranges::max(spheres.r) / boundary.shortest_period();
    if (spheres.size() >= enough_for_threads || boundary.is_tilted())
      return contact_factor_by_levels<D>(spheres, boundary, factor);
  }
  for_each_pair<D>(
      spheres, edges,
      [&](double r, double largest) {  // d < (r + rj) / factor, less rj, for the rj that makes it the most
        return r / factor + largest * std::max(0.0, 1 / factor - 1);
      },
      [&](std::uint32_t i, std::uint32_t j, const Vector<D>& apart) {
        factor = std::max(factor, (spheres.r[i] + spheres.r[j]) / apart.norm());
      });
  return factor;
}

template <int D>
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const Spheres<D>& spheres,
                                                                 const Vector<D>& edges, double allowed) {
  const double least = std::ranges::min(spheres.r);
  const double share = (1 - allowed) * (1 + tolerance::growth(edges.maxCoeff() / least));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for_each_pair<D>(
      spheres, edges, [&](double r, double) { return r + 1e-6 * least; },
      [&](std::uint32_t i, std::uint32_t j, const Vector<D>& apart) {
        const double reach = share * (spheres.r[i] + spheres.r[j]);
        if (apart.squaredNorm() < reach * reach) pairs.emplace_back(i, j);
      });
  return pairs;
}

template <int D>
bool is_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls) {
  constexpr double wide_enough = 2.001;  // that of two images one is far
  const Vector<D> around = edges_around_walls<D>(edges, walls);
  if (!(around.minCoeff() > wide_enough * 2 * std::ranges::max(spheres.r))) return false;
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (std::size_t i = 0; i < spheres.size() && walls[k]; ++i) {
      const Dyadic x = spheres.x[k][i], r = spheres.r[i];
      if (x < r || Dyadic(edges[static_cast<int>(k)]) - x < r) return false;
    }
  return std::ranges::none_of(overlapping<D>(spheres, around, 0), [&](const auto& pair) {
    const auto [i, j] = pair;
    Dyadic squared;
    for (int k = 0; k < D; ++k) {
      const auto& x = spheres.x[static_cast<std::size_t>(k)];
      const double images = std::round((x[j] - x[i]) / around[k]);
      squared = squared + square(Dyadic(x[i]) - Dyadic(x[j]) + Dyadic(images) * Dyadic(around[k]));
    }
    return squared < square(Dyadic(spheres.r[i]) + Dyadic(spheres.r[j]));
  });
}

template <int D>
Vector<D> edges_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, double allowed,
                                const std::vector<bool>& walls, const Tilt& tilt) {
  const double touching = contact_factor<D>(spheres, edges_around_walls(edges, walls), tilt);
  const double factor = std::max(std::clamp(1.0, touching * (1 - allowed), touching),
                                 wall_contact_factor(spheres, edges, walls));
  const double smallest = *std::ranges::min_element(spheres.r);
  // Images are reached by sums of edges and tilts, each with a rounding of its own.
  double longest = edges.maxCoeff();
  for (const double length : tilt) longest += 2 * std::abs(length);
  return edges * (factor * (1 + tolerance::growth(factor * longest / smallest)));
}

template <int D>
void free_of_overlap(Spheres<D>& spheres, Vector<D>& edges, const Task& task, Reporter& report) {
  const Tilt tilt = task.tilt(edges);
  Vector<D> free = edges_free_of_overlap<D>(spheres, edges, task.allowed_overlap, task.walls, tilt);
  while (!free.allFinite()) {  // cancelled while centres coincide
    Random random = report.random(Stream::relax);
    displace_at_random<D>(spheres, edges, task.walls, 1e-3 * std::ranges::max(spheres.r), random, tilt);
    free = edges_free_of_overlap<D>(spheres, edges, task.allowed_overlap, task.walls, tilt);
  }
  resize_box<D>(spheres, edges, free, is_tilted(task.domain));
}

#define BERNAL_INSTANTIATE(D)                                                                          \
  template std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const Spheres<D>&,         \
                                                                            const Vector<D>&, double); \
  template bool is_free_of_overlap(const Spheres<D>&, const Vector<D>&, const std::vector<bool>&);     \
  template void free_of_overlap(Spheres<D>&, Vector<D>&, const Task&, Reporter&);                      \
  template double contact_factor(const Spheres<D>&, const Vector<D>&, const Tilt&);                    \
  template Vector<D> edges_free_of_overlap(const Spheres<D>&, const Vector<D>&, double,                \
                                           const std::vector<bool>&, const Tilt&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal

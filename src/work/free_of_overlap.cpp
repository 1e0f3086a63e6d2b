#include "work/free_of_overlap.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <optional>
#include <span>

#include "bernal/core/tolerance.hpp"
#include "bernal/domain/boundary.hpp"
#include "core/every_dimension.hpp"
#include "core/parallel.hpp"
#include "domain/dyadic.hpp"
#include "neighbors/cell_grid.hpp"
#include "work/blocks.hpp"
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
  std::vector<std::uint32_t> order(spheres.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::stable_sort(order, std::greater<>(), [&](auto i) { return spheres.r[i]; });
  CellGrid<D> grid(boundary, smallest, largest, spheres.size());
  for (const std::uint32_t i : order) {
    const Vector<D> c = spheres.center(i);
    grid.for_each_near(c, reach(spheres.r[i], largest),
                       [&](std::uint32_t j) { visit(i, j, boundary.minimum_image(c - spheres.center(j))); });
    grid.insert(i, c, spheres.r[i]);
  }
}

/// Of more spheres the cache holds only some, and blocks are looked at one by one.
constexpr std::size_t enough_for_blocks = 50'000, spheres_a_block = 1 << 13;

/// The contact factor of a block's own spheres, the first of those in it and around it, above one that is
/// known; `of_all` is the metric, which only those are held against that are as near by their places here.
template <int D>
double contact_factor_in(const typename Blocks<D>::Local& here, std::size_t own, const Spheres<D>& spheres,
                         const Bounds<D>& bounds, const Boundary<D>& local, const Boundary<D>& of_all,
                         double largest, double factor) {
  const auto& [ids, places] = here;
  std::vector<double> radii;  // beside each other, as the places are
  radii.reserve(ids.size());
  for (const std::uint32_t i : ids) radii.push_back(spheres.r[i]);
  // The larger first, of equal ones those around: so each own one finds all of these that are no smaller.
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.rbegin(), order.rend(), 0u);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t k) { return radii[k]; });
  if (order.empty()) return factor;
  CellGrid<D> grid(bounds, local, radii[order.back()], radii[order.front()], ids.size());
  constexpr double rounding = 1e-9;  // of the places of images
  for (const std::uint32_t k : order) {
    const double r = radii[k];
    const double reach = r / factor + largest * (std::max(0.0, 1 / factor - 1) + rounding);
    if (k < own)
      grid.for_each_near(places[k], reach, [&](std::uint32_t m) {
        const double near = (r + radii[m]) / factor + largest * rounding;
        if (ids[m] == ids[k] || local.minimum_image(places[k] - places[m]).squaredNorm() > near * near)
          return;
        const Vector<D> apart = of_all.minimum_image(spheres.center(ids[k]) - spheres.center(ids[m]));
        factor = std::max(factor, (r + radii[m]) / apart.norm());
      });
    grid.insert(k, places[k], r);
  }
  return factor;
}

/// The same number as by looking at all at once: each pair is met in the block of the smaller, and the
/// largest of the ratios does not depend on the order. Nothing where spheres reach too far for blocks.
template <int D>
std::optional<double> contact_factor_in_blocks(const Spheres<D>& spheres, const Vector<D>& edges) {
  // Of the diameter: so far apart are the closest spheres at most, or others could matter, too.
  constexpr double farthest = 1.25;
  const double largest = std::ranges::max(spheres.r);
  const Blocks<D> blocks(spheres, edges, farthest * 2 * largest, spheres_a_block);
  if (blocks.size() == 1) return {};
  const Boundary<D> of_all{edges};
  Boundary<D> local = of_all;
  for (int k = 0; k < D; ++k)
    if (blocks.is_cut(k)) local.edges[k] = 0;
  const auto factor_in = [&](std::size_t b, double known) {
    return contact_factor_in<D>(blocks.local(b), blocks.own(b).size(), spheres, blocks.around(b), local,
                                of_all, largest, known);
  };
  const double known = factor_in(0, 2 * largest / edges.minCoeff());
  if (!(known * farthest >= 1) || !std::isfinite(known)) return {};
  std::vector<double> factors(blocks.size(), known);
  parallel_for(1, blocks.size(), [&](std::size_t b) { factors[b] = factor_in(b, known); });
  return std::ranges::max(factors);
}

}  // namespace

template <int D>
double contact_factor(const Spheres<D>& spheres, const Vector<D>& edges) {
  if constexpr (D == 2 || D == 3)
    if (spheres.size() >= enough_for_blocks)
      if (const auto factor = contact_factor_in_blocks<D>(spheres, edges)) return *factor;
  double factor = 2 * std::ranges::max(spheres.r) / edges.minCoeff();
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
                                const std::vector<bool>& walls) {
  const double touching = contact_factor(spheres, edges_around_walls(edges, walls));
  const double factor = std::max(std::clamp(1.0, touching * (1 - allowed), touching),
                                 wall_contact_factor(spheres, edges, walls));
  const double smallest = *std::ranges::min_element(spheres.r);
  return edges * (factor * (1 + tolerance::growth(factor * edges.maxCoeff() / smallest)));
}

template <int D>
void free_of_overlap(Spheres<D>& spheres, Vector<D>& edges, Work& work) {
  Vector<D> free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap, work.walls);
  while (!free.allFinite()) {  // cancelled while centres coincide
    Random random = work.random(Stream::relax);
    displace_at_random<D>(spheres, edges, work.walls, 1e-3 * std::ranges::max(spheres.r), random);
    free = edges_free_of_overlap<D>(spheres, edges, work.allowed_overlap, work.walls);
  }
  resize_box<D>(spheres, edges, free);
}

#define BERNAL_INSTANTIATE(D)                                                                          \
  template std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const Spheres<D>&,         \
                                                                            const Vector<D>&, double); \
  template bool is_free_of_overlap(const Spheres<D>&, const Vector<D>&, const std::vector<bool>&);     \
  template void free_of_overlap(Spheres<D>&, Vector<D>&, Work&);                                       \
  template double contact_factor(const Spheres<D>&, const Vector<D>&);                                 \
  template Vector<D> edges_free_of_overlap(const Spheres<D>&, const Vector<D>&, double,                \
                                           const std::vector<bool>&);
BERNAL_IN_EVERY_DIMENSION(BERNAL_INSTANTIATE)
#undef BERNAL_INSTANTIATE

}  // namespace bernal

#pragma once
#include <algorithm>
#include <optional>
#include <type_traits>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "bernal/core/monitor.hpp"
#include "bernal/core/random.hpp"
#include "bernal/core/spheres.hpp"
#include "core/order.hpp"
#include "near/cell_grid.hpp"

namespace bernal {

/// The first of at most `trials` random places that is free, if there is one. Throws Cancelled.
template <class Draw, class IsFree>
std::optional<std::invoke_result_t<Draw>> find_place(double trials, Draw&& draw, IsFree&& is_free,
                                                     const Monitor& monitor) {
  constexpr std::uint64_t between_looks = 64;
  for (std::uint64_t trial = 0; static_cast<double>(trial) < trials; ++trial) {
    if (trial % between_looks == between_looks - 1 && monitor.stop()) throw Cancelled();
    const auto place = draw();
    if (is_free(place)) return place;
  }
  return std::nullopt;
}

/// Gives every sphere, or all from one on, a place anywhere in a box.
template <int D>
void place_at_random(Spheres<D>& spheres, const Vector<D>& edges, Random& random, std::size_t first = 0);

/// Moves every sphere by `length` in a direction of its own; `walls` of the box stop its centre.
template <int D>
void displace_at_random(Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls,
                        double length, Random& random, const Tilt& tilt = {});

/// Random sequential insertion of the spheres that are not `placed`, the largest first and all with the share
/// `size` of their radii: each at the first of the places draw(r) that overlaps none before it and
/// clears_walls(place, r). Returns whether all found one within `trials`; those that did stay there. `bounds`
/// are those of the region, as for CellGrid. Throws Cancelled. Cost: O(1) a trial, some hundred of them where
/// a third is full.
template <int D, class Draw, class ClearsWalls>
bool insert_at_random(Spheres<D>& spheres, const std::vector<bool>& placed, double size,
                      const Bounds<D>& bounds, const Boundary<D>& boundary, double trials, Draw&& draw,
                      ClearsWalls&& clears_walls, const Monitor& monitor) {
  const auto [least, most] = std::ranges::minmax(spheres.r);
  CellGrid<D> grid(bounds, boundary, size * least, size * most, spheres.size());
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    if (placed[i])
      grid.insert(i, spheres.center(i), size * spheres.r[i]);
    else
      order.push_back(i);
  }
  sort_largest_first(order, spheres.r);
  for (const std::uint32_t i : order) {
    const double r = size * spheres.r[i];
    const auto is_free = [&](const Vector<D>& c) {
      const bool taken = grid.any_near(c, r, [&](std::uint32_t j) {
        const double sum = r + size * spheres.r[j];
        return boundary.minimum_image(c - spheres.center(j)).squaredNorm() < sum * sum;
      });
      return !taken && clears_walls(c, r);
    };
    const std::optional<Vector<D>> place = find_place(
        trials, [&] { return draw(r); }, is_free, monitor);
    if (!place) return false;
    spheres.set_center(i, *place);
    grid.insert(i, *place, r);
  }
  return true;
}

}  // namespace bernal

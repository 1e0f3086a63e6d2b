#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "bernal/core/spheres.hpp"
#include "work/reporter.hpp"
#include "work/task.hpp"

namespace bernal {

/// A coordinate in [0, edge) of a box that has grown by `factor` to this edge.
inline double carried_along(double x, double factor, double edge) {
  x *= factor;
  return x < edge ? x : 0;  // or rounded to the edge, which is the image of 0
}

/// Gives a periodic box other edges, and every centre the same place relative to them, in [0, edge). Exact
/// but for two roundings of each coordinate. In a tilted box 0 is no image of the edge alone, so that what is
/// rounded to it stays before it.
template <int D>
void resize_box(Spheres<D>& spheres, Vector<D>& edges, const Vector<D>& new_edges, bool is_tilted = false) {
  for (int k = 0; k < D; ++k) {
    const double factor = new_edges[k] / edges[k], last = std::nextafter(new_edges[k], 0.0);
    for (double& x : spheres.x[k])
      x = is_tilted ? std::min(x * factor, last) : carried_along(x, factor, new_edges[k]);
  }
  edges = new_edges;
}

/// The smallest factor, to rounding, by which a periodic box and its centres have to grow so that no two
/// spheres overlap, nor a sphere its own image: the largest (ri + rj) / d over all pairs of images. Below 1
/// where there is room to shrink. Infinite where two centres coincide.
///
/// Only pairs that could raise the factor found so far are looked at; spheres come in the order of falling
/// radii, so that none has to look far for a larger one. A `tilt` grows with the edges. Precondition: there
/// are spheres. Cost: O(N) where the spheres are about in contact, O(N log N) where they are thinly spread.
template <int D>
double contact_factor(const Spheres<D>& spheres, const Vector<D>& edges, const Tilt& tilt = {});

/// The edges of a periodic box around one that ends at walls along some axes, so large that no sphere between
/// these meets an image of another, and is nearer to the walls than to images.
template <int D>
Vector<D> edges_around_walls(Vector<D> edges, const std::vector<bool>& walls) {
  for (int k = 0; k < D; ++k)
    if (!walls.empty() && walls[static_cast<std::size_t>(k)]) edges[k] *= 2.5;
  return edges;
}

/// The edges, in the proportions of these, of about the smallest box in which the spheres certainly do not
/// overlap, whatever the rounding, after `resize_box`; with `allowed` > 0, in which no overlap ratio is
/// larger than that, but no smaller than the box at hand unless it has room to spare. Infinite or NaN where
/// two centres coincide. `walls` says along which axes the box ends at walls, which no sphere may cross;
/// empty: none. Cost: as `contact_factor`.
template <int D>
Vector<D> edges_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, double allowed = 0,
                                const std::vector<bool>& walls = {}, const Tilt& tilt = {});

/// Grows or shrinks the box until nothing overlaps more than is allowed, or crosses its walls. Centres that
/// coincide are parted.
template <int D>
void free_of_overlap(Spheres<D>& spheres, Vector<D>& edges, const Task& task, Reporter& report);

/// Whether nothing overlaps, nor crosses a wall, decided exactly of the numbers as they stand: touching is
/// allowed. Of a box narrower than two of the largest spheres it may say no where it is so.
/// Preconditions and cost: as `overlapping`, and 5 µs a pair that touches to rounding.
template <int D>
bool is_free_of_overlap(const Spheres<D>& spheres, const Vector<D>& edges, const std::vector<bool>& walls);

/// The pairs of spheres in a periodic box that overlap by more than the ratio `allowed`, or are so near to it
/// that rounding leaves it open: d < (1 - allowed) (ri + rj), of the nearest images. Pairs that are not here
/// certainly do not. Precondition: centres are in [0, edge), and there are spheres.
/// Cost: O(N) where they do not overlap much.
template <int D>
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(const Spheres<D>& spheres,
                                                                 const Vector<D>& edges, double allowed);

}  // namespace bernal

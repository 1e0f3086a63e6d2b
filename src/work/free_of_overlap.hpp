#pragma once
#include <vector>

#include "bernal/core/spheres.hpp"

namespace bernal {

/// The smallest factor, to rounding, by which a periodic box and its centres have to grow so that no two
/// spheres overlap, nor a sphere its own image: the largest (ri + rj) / d over all pairs of images. Below 1
/// where there is room to shrink. Infinite where two centres coincide.
///
/// Only pairs that could raise the factor found so far are looked at; spheres come in the order of falling
/// radii, so that none has to look far for a larger one. Precondition: there are spheres.
/// Cost: O(N) where the spheres are about in contact, O(N log N) where they are thinly spread.
template <int D>
double contact_factor(const Spheres<D>& spheres, const Vector<D>& edges);

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
                                const std::vector<bool>& walls = {});

}  // namespace bernal

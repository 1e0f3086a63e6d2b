#pragma once
#include "bernal/core/spheres.hpp"

namespace bernal {

/// Gives a periodic box other edges, and every centre the same place relative to them, in [0, edge). Exact
/// but for two roundings of each coordinate.
template <int D>
void resize_box(Spheres<D>& spheres, Vector<D>& edges, const Vector<D>& new_edges) {
  for (int k = 0; k < D; ++k) {
    const double factor = new_edges[k] / edges[k];
    for (double& x : spheres.x[k]) {
      x *= factor;
      if (!(x < new_edges[k])) x = 0;  // rounded to the edge, which is the image of 0
    }
  }
  edges = new_edges;
}

}  // namespace bernal

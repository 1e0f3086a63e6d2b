#pragma once
#include <cmath>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The metric of a box that repeats itself: axis k has the period edges[k] > 0, or none (an open axis) where
/// that is 0.
template <int D>
struct Boundary {
  Vector<D> edges = Vector<D>::Zero();

  /// The image of p with every periodic component in [0, edge).
  Vector<D> wrap(Vector<D> p) const {
    for (int k = 0; k < p.size(); ++k) {
      if (!(edges[k] > 0)) continue;
      p[k] -= edges[k] * std::floor(p[k] / edges[k]);
      if (!(p[k] < edges[k])) p[k] = 0;  // a tiny negative number rounds to the edge itself
    }
    return p;
  }
  /// The shortest of all images of a displacement, to rounding; each component in [-edge/2, edge/2].
  Vector<D> minimum_image(Vector<D> d) const {
    for (int k = 0; k < d.size(); ++k) {
      if (edges[k] > 0) d[k] -= edges[k] * std::nearbyint(d[k] / edges[k]);
    }
    return d;
  }
};

}  // namespace bernal

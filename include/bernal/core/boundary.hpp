#pragma once
#include <cmath>

#include "bernal/core/vector.hpp"

namespace bernal {

/// The metric of space that repeats itself: axis k has the period edges[k] > 0, or none (an open axis) where
/// that is 0.
template <int D>
struct Boundary {
  using ArchivedAsBytes = void;
  Vector<D> edges = Vector<D>::Zero();
  Vector<D> origin = Vector<D>::Zero();  ///< the lowest corner of the period that centres are wrapped into

  bool repeats(int axis) const { return edges[axis] > 0; }
  bool repeats() const { return edges.maxCoeff() > 0; }

  /// The image of p with every periodic component in [origin, origin + edge).
  Vector<D> wrap(Vector<D> p) const {
    for (int k = 0; k < p.size(); ++k) {
      const double end = origin[k] + edges[k];
      if (!(edges[k] > 0) || (p[k] >= origin[k] && p[k] < end)) continue;
      p[k] -= edges[k] * std::floor((p[k] - origin[k]) / edges[k]);
      if (!(p[k] < end && p[k] >= origin[k])) p[k] = origin[k];  // rounded to the end itself, or past it
    }
    return p;
  }
  /// The shortest of all images of a displacement, to rounding; each component in [-edge/2, edge/2].
  Vector<D> minimum_image(Vector<D> d) const {
    for (int k = 0; k < d.size(); ++k) {
      if (std::abs(d[k]) > 0.5 * edges[k] && edges[k] > 0) d[k] -= edges[k] * std::nearbyint(d[k] / edges[k]);
    }
    return d;
  }
  /// Calls visit(image) for every image of the displacement d whose components are all below `reach`, and
  /// perhaps for some on that limit. Precondition: every axis is periodic.
  /// Cost: the product over the axes of 2 reach / edge, rounded up.
  template <class Visit>
  void for_each_image(const Vector<D>& d, double reach, Visit&& visit) const {
    Vector<D> lowest = d;
    for (int k = 0; k < d.size(); ++k) lowest[k] -= edges[k] * std::floor((d[k] + reach) / edges[k]);
    if (!(lowest.maxCoeff() <= reach)) return;
    for (Vector<D> image = lowest;;) {
      visit(image);
      int k = 0;
      for (; k < d.size(); ++k) {
        image[k] += edges[k];
        if (image[k] <= reach) break;
        image[k] = lowest[k];
      }
      if (k == d.size()) return;
    }
  }
};

}  // namespace bernal

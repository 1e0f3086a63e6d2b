#pragma once
#include <cmath>

#include "bernal/core/boundary.hpp"
#include "soft/fixed_point_grid.hpp"

namespace bernal {

/// Of all cells with the same images as a tilted box the one whose vectors are tilted least: by at most half
/// of the edges before. Its slopes do not change while the box grows.
template <int D>
class LeastTiltedCell {
 public:
  using ArchivedAsBytes = void;
  using Floats = typename RegistersFor<D>::Floats;

  LeastTiltedCell() = default;
  LeastTiltedCell(const Vector<D>& edges, const Tilt& tilt) : given_(tilt) {
    least_[0] = std::remainder(tilt[0], edges[0]);
    if constexpr (D == 3) {
      const double turns = std::nearbyint(tilt[2] / edges[1]);
      least_[2] = tilt[2] - turns * edges[1];
      least_[1] = std::remainder(tilt[1] - turns * least_[0], edges[0]);
      of_third_[0] = static_cast<float>(least_[1] / edges[2]);
      of_third_[1] = static_cast<float>(least_[2] / edges[2]);
    }
    of_second_[0] = static_cast<float>(least_[0] / edges[1]);
  }

  void grow(double factor) {
    given_ = scaled(given_, factor);
    least_ = scaled(least_, factor);
  }

  TiltedBoundary<D> boundary(const Vector<D>& edges) const { return {edges, least_}; }
  /// Of the box as it was given.
  TiltedBoundary<D> given(const Vector<D>& edges) const { return {edges, given_}; }

  /// The distance of each pair of faces: the edge over the length of a row of the inverse of the cell
  /// vectors, which are taken over their edges.
  Vector<D> widths(Vector<D> edges) const {
    const double xy = of_second_[0], xz = of_third_[0], yz = of_third_[1];
    edges[0] /= std::hypot(1.0, xy, xy * yz - xz);
    if constexpr (D == 3) edges[1] /= std::hypot(1.0, yz);
    return edges;
  }

  /// The way that leads so far along each cell vector, in edges; and the inverse.
  Floats way(const Floats& along) const { return along + of_second_ * along[1] + of_third_ * along[2]; }
  Floats along(Floats way) const {
    way -= of_third_ * way[2];
    way -= of_second_ * way[1];
    return way;
  }

 private:
  Tilt given_{}, least_{};
  Floats of_second_{},
      of_third_{};  // how far the second cell vector, and the third, leads along the axes before
};

}  // namespace bernal

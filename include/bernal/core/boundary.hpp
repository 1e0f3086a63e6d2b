#pragma once
#include <array>
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

/// How far a periodic box is tilted, as LAMMPS has it: xy, xz and yz of the cell vectors a = (lx, 0, 0),
/// b = (xy, ly, 0) and c = (xz, yz, lz); in the plane xy alone.
using Tilt = std::array<double, 3>;
inline Tilt scaled(Tilt tilt, double factor) {
  for (double& length : tilt) length *= factor;
  return tilt;
}

/// The metric of space that repeats itself with cell vectors that may be tilted. The brick [origin, origin +
/// edge) along each axis is a period of it, too: whoever leaves it through its upper face across axis k comes
/// in again through the lower one, moved by -along(k, j) along each axis j < k. So centres lie in the brick,
/// and a grid of it is one of the cell.
///
/// A type of its own, since whoever knows upright boxes only must not be given a tilted one.
template <int D>
struct TiltedBoundary {
  Vector<D> edges = Vector<D>::Zero();
  Vector<D> origin = Vector<D>::Zero();
  Tilt tilt{};  ///< all 0, or every axis has a period and D is 2 or 3

  TiltedBoundary() = default;
  /// An upright one.
  TiltedBoundary(const Boundary<D>& upright) : edges(upright.edges), origin(upright.origin) {}
  TiltedBoundary(const Vector<D>& lengths, const Tilt& how) : edges(lengths), tilt(how) {}

  bool repeats(int axis) const { return edges[axis] > 0; }
  bool repeats() const { return edges.maxCoeff() > 0; }
  bool is_tilted() const { return tilt != Tilt{}; }

  /// The component along axis `k` < `axis` of the cell vector of `axis`.
  double along(int axis, int k) const {
    return axis < 3 ? tilt[static_cast<std::size_t>(axis * (axis - 1) / 2 + k)] : 0;
  }
  Vector<D> cell_vector(int axis) const {
    Vector<D> v = Vector<D>::Zero();
    v[axis] = edges[axis];
    for (int k = 0; k < axis; ++k) v[k] = along(axis, k);
    return v;
  }

  /// p as a sum of cell vectors from the origin on: each share is in [0, 1) within the cell. Precondition:
  /// every axis has a period.
  Vector<D> in_cell_vectors(Vector<D> p) const {
    p -= origin;
    for (int k = D - 1; k >= 0; --k) {
      p[k] /= edges[k];
      for (int j = 0; j < k; ++j) p[j] -= p[k] * along(k, j);
    }
    return p;
  }

  /// The image of p in the brick.
  Vector<D> wrap(Vector<D> p) const {
    for (int k = D - 1; k >= 0; --k) {
      const double end = origin[k] + edges[k];
      if (!(edges[k] > 0) || (p[k] >= origin[k] && p[k] < end)) continue;
      const double turns = std::floor((p[k] - origin[k]) / edges[k]);
      p[k] -= edges[k] * turns;
      for (int j = 0; j < k; ++j) p[j] -= along(k, j) * turns;
      if (p[k] < end && p[k] >= origin[k]) continue;
      // Rounded to the end itself, which is the image of the other end, or past it.
      if (p[k] >= end)
        for (int j = 0; j < k; ++j) p[j] -= along(k, j);
      p[k] = origin[k];
    }
    return p;
  }
  /// Calls visit(image) for every image of the displacement d that is at most about `reach` long. Cost: for
  /// each axis but the first 2 reach / edge, rounded up, multiplied.
  template <class Visit>
  void for_each_image(const Vector<D>& d, double reach, Visit&& visit) const {
    visit_images<D - 1>(d, reach * reach * (1 + 1e-12), visit);
  }
  /// The least distance between a point and an image of it. Precondition: every axis has a period.
  double shortest_period() const {
    double least = edges[0];
    for (int k = 1; k < D; ++k) least = std::fmin(least, cell_vector(k).norm());
    double shortest = least;
    if (is_tilted())
      for_each_image(Vector<D>::Zero(), least, [&](const Vector<D>& image) {
        if (!image.isZero(0)) shortest = std::fmin(shortest, image.norm());
      });
    return shortest;
  }

 private:
  template <int K, class Visit>
  void visit_images(const Vector<D>& d, double squared, Visit& visit) const {
    if constexpr (K < 0) {
      visit(d);
    } else {
      const double half = std::sqrt(squared);
      double first = 0, last = 0;
      if (edges[K] > 0) {
        first = std::ceil((-half - d[K]) / edges[K] - 1e-9);
        last = std::floor((half - d[K]) / edges[K] + 1e-9);
      }
      for (double turn = first; turn <= last; ++turn) {
        Vector<D> image = d;
        image[K] += turn * edges[K];
        for (int j = 0; j < K; ++j) image[j] += turn * along(K, j);
        visit_images<K - 1>(image, std::fmax(0.0, squared - image[K] * image[K]), visit);
      }
    }
  }
};

}  // namespace bernal

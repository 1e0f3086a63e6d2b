#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "verify/box_tree.hpp"

// The search for the smallest gap ratio, beside the decisions: what is known so far bounds where a smaller
// one can be.

namespace bernal::verify {

/// The smallest of the numbers offered so far, by any thread; infinity if none was. The order of offers does
/// not matter for the smallest of all. Cost: a read of one atomic, a write only where it becomes smaller.
class LeastSoFar {
 public:
  double value() const { return value_.load(std::memory_order_relaxed); }
  void offer(double x) {
    double before = value();
    while (x < before && !value_.compare_exchange_weak(before, x, std::memory_order_relaxed)) {
    }
  }

 private:
  std::atomic<double> value_ = std::numeric_limits<double>::infinity();
};

/// (d - ri - rj - gap) / (ri + rj + gap) in double: off by at most 8 roundoffs of 1 + that ratio, if distance
/// and sum of radii are off by a few.
inline double gap_ratio(double distance, double sum_of_radii, double gap) {
  const double reach = sum_of_radii + gap;
  return (distance - reach) / reach;
}

template <int D>
double least_extent(const Box<D>& box) {
  double extent = box.upper[0] - box.lower[0];
  for (int k = 1; k < D; ++k) extent = std::min(extent, box.upper[k] - box.lower[k]);
  return extent;
}

/// As `widened`, to rounding.
template <int D>
Box<D> widened_by_about(Box<D> box, double by) {
  for (int k = 0; k < D; ++k) {
    box.lower[k] -= by;
    box.upper[k] += by;
  }
  return box;
}

/// How far boxes of balls must be widened so that the boxes of every two balls with a gap ratio of at most
/// `most` touch: such balls touch if each of them is enlarged to (1 + most)(r + gap / 2).
///
/// The radius of a ball is at most half the least extent of a box that holds it, and at most the largest
/// radius. The margin is above the rounding of the boxes, of their ends in the next periods, and of the
/// ratio, so that the pairs found do not depend on rounding.
class Widening {
 public:
  /// `largest`: a bound of all coordinates, finite periods included. `most` may be infinite, or negative.
  Widening(double most, double gap, double largest_radius, double largest)
      : share_(std::max(most, 0.0) * (1 + 0x1p-40)),
        largest_diameter_(2 * largest_radius),
        margin_(0x1p-46 * largest) {
    if (gap > 0) margin_ += (1 + share_) * (0.5 * gap);
  }

  template <int D>
  double of(const Box<D>& box) const {
    return share_ * (0.5 * std::min(largest_diameter_, least_extent(box))) + margin_;
  }
  /// Of any box.
  double of_largest() const { return share_ * (0.5 * largest_diameter_) + margin_; }

  template <int D>
  Box<D> widened(const Box<D>& box) const {
    return widened_by_about(box, of(box));
  }

 private:
  double share_, largest_diameter_, margin_;
};

/// A query of a tree whose boxes are to be widened.
template <class Reach>
struct WidenedQuery {
  Reach reach;
  Widening widening;
};
template <int D, class Reach>
bool touch(const Box<D>& box, const WidenedQuery<Reach>& query) {
  return touch(query.widening.widened(box), query.reach);
}

/// How far from a centre a wall may be whose gap ratio is at most `most`, with margins as in Widening.
/// `largest`: a bound of the coordinates of centre and walls.
inline double wall_reach(double most, double r, double wall_gap, double largest) {
  return (1 + 0x1p-40) * (1 + std::max(most, 0.0)) * (r + wall_gap) + 0x1p-46 * largest;
}

/// A lower bound of the distance of p from everything in the box, with the same margins.
template <int D>
double least_distance_from_box(const Vector<D>& p, const Box<D>& box, double largest) {
  double squared = 0;
  for (int k = 0; k < D; ++k) {
    const double outside = std::max({box.lower[k] - p[k], 0.0, p[k] - box.upper[k]});
    squared += outside * outside;
  }
  return (1 - 0x1p-40) * std::sqrt(squared) - 0x1p-46 * largest;
}

/// The largest finite |coordinate| of a box; 0 for an empty one.
template <int D>
double largest_coordinate(const Box<D>& box) {
  double largest = 0;
  for (int k = 0; k < D; ++k)
    for (const double x : {box.lower[k], box.upper[k]})
      if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace bernal::verify

#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/domain/domain.hpp"
#include "verify/box_tree.hpp"

// The spaces in which a certificate places balls: the distance of two coordinates, in any arithmetic, and
// which boxes touch.

namespace bernal::verify {

inline double magnitude(double x) { return std::abs(x); }
inline double smaller(double a, double b) { return std::min(a, b); }

/// Throws Error{bad_argument} unless it holds.
inline void require(bool holds, const char* what) {
  if (!holds) throw Error(ErrorCode::bad_argument, what);
}

/// The period of every axis of a domain, infinite if it has none. This is derived here independently from the
/// plain data, because the packer's own metric is not trusted. Throws Error{bad_argument} unless every period
/// is positive and finite and every axis is either periodic or not.
Vector<dynamic> periods_of(const Domain& domain);

/// Infinite space, in which a ball has one position.
template <int D>
struct OpenSpace {
  static constexpr bool repeats = false;

  template <class Number>
  static Number offset(int, double a, double b) {
    return Number(a) - Number(b);
  }
  static Box<D> reach_of(const Box<D>& box) { return box; }
  static double largest_period() { return 0; }
  static double representative(int, double x) { return x; }
};

/// A box, and the ends of its images in the adjacent periods, as far as others can meet them.
template <int D>
struct RepeatedBox {
  Box<D> box;
  std::array<double, D> lower_of_next, upper_of_previous;
};

/// Whether `box` has a point in common with an image of the other, both being boxes of balls in a
/// PeriodicSpace. Only the adjacent images matter, because centres differ by at most an edge; and only their
/// near ends, because the far end is an edge beyond a centre of its own box, and so beyond all centres.
template <int D>
bool touch(const Box<D>& box, const RepeatedBox<D>& other) {
  bool all = true;
  for (int k = 0; k < D; ++k)
    all &= ((box.lower[k] <= other.box.upper[k]) & (other.box.lower[k] <= box.upper[k])) |
           (other.lower_of_next[k] <= box.upper[k]) | (box.lower[k] <= other.upper_of_previous[k]);
  return all;
}

/// Space with the period edges[k] along axis k, infinite if there is none. Every ball has an image in each
/// period and is represented by the one with -edge/2 <= c <= edge/2 on every axis.
///
/// Squared distances add up over the axes, and the image of a ball can be chosen for each axis separately; so
/// the nearest image is the nearest along every axis, and |ci - cj + k·L| >= d holds for every integer vector
/// k if it holds for that image.
template <int D>
struct PeriodicSpace {
  static constexpr bool repeats = true;

  Vector<D> edges;

  /// The representative coordinate. Exact: IEEE 754's remainder is not rounded. Precondition: finite.
  double representative(int k, double x) const {
    return 2 * std::abs(x) <= edges[k] ? x : std::remainder(x, edges[k]);  // x if the edge is infinite
  }

  /// Of those that are finite; 0 if none is.
  double largest_period() const {
    double largest = 0;
    for (const double edge : edges)
      if (edge < Box<D>::infinity) largest = std::max(largest, edge);
    return largest;
  }

  /// The smallest |a - b + n edge| over integers n: |a - b| or edge - |a - b|, because |a - b| <= edge.
  template <class Number>
  Number offset(int k, double a, double b) const {
    const Number direct = magnitude(Number(a) - Number(b));
    if (edges[k] == Box<D>::infinity) return direct;
    return smaller(direct, Number(edges[k]) - direct);
  }

  RepeatedBox<D> reach_of(const Box<D>& box) const {
    RepeatedBox<D> reach{box, {}, {}};
    for (int k = 0; k < D; ++k) {
      if (edges[k] == Box<D>::infinity) {
        reach.lower_of_next[k] = Box<D>::infinity;
        reach.upper_of_previous[k] = -Box<D>::infinity;
        continue;
      }
      reach.lower_of_next[k] = rounded_down(box.lower[k] + edges[k]);
      reach.upper_of_previous[k] = rounded_up(box.upper[k] - edges[k]);
    }
    return reach;
  }
};

}  // namespace bernal::verify

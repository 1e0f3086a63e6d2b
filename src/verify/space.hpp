#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "bernal/core/error.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/domain/domain.hpp"
#include "verify/box_tree.hpp"

// What a certificate has to know of the space in which balls meet: how far apart two coordinates are, in any
// arithmetic, and which boxes come together.

namespace bernal::verify {

inline double magnitude(double x) { return std::abs(x); }
inline double smaller(double a, double b) { return std::min(a, b); }

/// Throws Error{bad_argument} unless it holds.
inline void require(bool holds, const char* what) {
  if (!holds) throw Error(ErrorCode::bad_argument, what);
}

/// The period of every axis of a domain, infinite where it has none. What repeats is said here once more,
/// from the plain data: the packer's own metric is not trusted. Throws Error{bad_argument} unless every
/// period is positive and finite and every axis is said to repeat itself or to end.
Vector<dynamic> periods_of(const Domain& domain);

/// Space without end, in which a ball is in one place.
template <int D>
struct OpenSpace {
  static constexpr bool repeats = false;

  template <class Number>
  static Number offset(int, double a, double b) {
    return Number(a) - Number(b);
  }
  static Box<D> reach_of(const Box<D>& box) { return box; }
  static double representative(int, double x) { return x; }
};

/// A box and the ends of its images in the periods before and after, as far as others can meet them.
template <int D>
struct RepeatedBox {
  Box<D> box;
  std::array<double, D> lower_of_next, upper_of_previous;
};

/// Whether `box` has a point in common with an image of the other, both being boxes of balls in a
/// PeriodicSpace. No image but the next ones to either side has to be asked: centres are an edge apart at
/// most. Nor has the far end of those: it is an edge beyond a centre of its own box, and so beyond all
/// centres.
template <int D>
bool touch(const Box<D>& box, const RepeatedBox<D>& other) {
  bool all = true;
  for (int k = 0; k < D; ++k)
    all &= ((box.lower[k] <= other.box.upper[k]) & (other.box.lower[k] <= box.upper[k])) |
           (other.lower_of_next[k] <= box.upper[k]) | (box.lower[k] <= other.upper_of_previous[k]);
  return all;
}

/// Space that repeats itself with the period edges[k] along axis k, or does not where that is infinite. Every
/// ball has an image in each period and is represented by that with -edge/2 <= c <= edge/2 on every axis.
///
/// Squared distances add up over the axes, and the image of a ball may be chosen for each axis by itself: so
/// the nearest of all images of a ball is the one that is nearest along every axis, and |ci - cj + k·L| >= d
/// holds for every vector k of integers if it holds for that one.
template <int D>
struct PeriodicSpace {
  static constexpr bool repeats = true;

  Vector<D> edges;

  /// The representative coordinate. Exact: IEEE 754's remainder has no rounding error. Precondition: finite.
  double representative(int k, double x) const {
    return 2 * std::abs(x) <= edges[k] ? x : std::remainder(x, edges[k]);  // x where the edge is infinite
  }

  /// The smallest |a - b + n edge| over all integers n: |a - b| or edge - |a - b|, because |a - b| <= edge.
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

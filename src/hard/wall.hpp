#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/core/vector.hpp"

namespace bernal {

/// A piece of the wall around a convex region, as what is inside sees it. The region is where all its pieces
/// have a clearance of 0 or more:
///
/// | round | along               | center            | extent | clearance of p                    |
/// |-------|---------------------|-------------------|--------|-----------------------------------|
/// | no    | unit normal, out    |                   | o      | o - n·p                           |
/// | yes   | unit axis: cylinder | a point of the axis | R    | R - |P (p - center)|, P across it |
/// | yes   | 0: sphere           | centre            | R      | R - |p - center|                  |
template <int D>
struct Wall {
  bool round = false;
  Vector<D> along = Vector<D>::Zero();
  Vector<D> center = Vector<D>::Zero();
  double extent = 0;

  Vector<D> across(const Vector<D>& v) const { return v - v.dot(along) * along; }
  double clearance(const Vector<D>& p) const {
    return round ? extent - across(p - center).norm() : extent - along.dot(p);
  }
  /// The unit normal out of the region where a sphere at p touches.
  Vector<D> outward(const Vector<D>& p) const { return round ? across(p - center).normalized() : along; }
  void shift(const Vector<D>& by) {
    center += by;
    if (!round) extent += along.dot(by);
  }

  /// The time until a sphere at p with velocity v, whose radius is r and grows by r' a unit of time, touches:
  /// 0 for one that already does, or overlaps by rounding, and comes closer; infinite where it never will.
  ///
  /// A plane: n·(p + v t) + r + r' t = o. A round wall: |d + w t| = s - r' t with d = P (p - center),
  /// w = P v, s = R - r; with a = w² - r'², b = d·w + s r', c = d² - s² that is a t² + 2 b t + c = 0, and
  /// from inside, c <= 0, the root that comes next is -c / (b + √(b² - a c)) where b > 0, else
  /// (√(b² - a c) - b) / a, neither of which cancels. A sphere that is outside by rounding and flies along
  /// the wall without getting in again, b² < a c, collides where it is nearest to the inside.
  double time_to_touch(const Vector<D>& p, const Vector<D>& v, double r, double growth) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (!round) {
      const double closing = along.dot(v) + growth;
      return closing > 0 ? std::max(0.0, extent - along.dot(p) - r) / closing : never;
    }
    const Vector<D> d = across(p - center), w = across(v);
    const double s = extent - r;
    const double a = w.squaredNorm() - growth * growth, b = d.dot(w) + s * growth;
    const double c = d.squaredNorm() - s * s;
    const double root = std::sqrt(std::max(0.0, b * b - a * c));
    if (b > 0) return std::max(0.0, -c) / (b + root);
    return a > 0 ? (root - b) / a : never;
  }
};

}  // namespace bernal

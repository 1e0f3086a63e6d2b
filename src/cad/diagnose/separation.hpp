#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Whether a direction d provably separates the points `a` from the points `b`: every d·a below every d·b, or
/// above. Then their convex hulls are disjoint. The converse does not hold.
///
/// Proof in double precision, with u = 2^-53: differences from `origin` have one rounding, products one, sums
/// two, so the error of a computed d·(p - origin) is at most 4u / (1 - 4u) Σ_k |d_k| |p_k - origin_k|, plus
/// less than the smallest normal number if products underflow. The bound used is twice that, with the largest
/// |p_k - origin_k| of all points, which covers its own rounding. The direction is exact as given and need
/// not be normal to anything. Overflow proves nothing.
class Separation {
 public:
  Separation(std::span<const Vector<3>> a, std::span<const Vector<3>> b, const Vector<3>& origin)
      : a_(a), b_(b), origin_(origin) {
    for (const auto& points : {a, b})
      for (const Vector<3>& p : points) extent_ = extent_.cwiseMax((p - origin).cwiseAbs());
  }

  bool proven_along(const Vector<3>& d) const {
    const auto [lowest_a, highest_a] = range(a_, d);
    const auto [lowest_b, highest_b] = range(b_, d);
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    const double wrong = 8 * u * d.cwiseAbs().dot(extent_) + std::numeric_limits<double>::min();
    return lowest_b - highest_a > 2 * wrong || lowest_a - highest_b > 2 * wrong;
  }

 private:
  struct Range {
    double lowest, highest;
  };
  Range range(std::span<const Vector<3>> points, const Vector<3>& d) const {
    Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Vector<3>& p : points) {
      const double at = d.dot(p - origin_);
      range.lowest = std::min(range.lowest, at);
      range.highest = std::max(range.highest, at);
    }
    return range;
  }

  std::span<const Vector<3>> a_, b_;
  Vector<3> origin_;
  Vector<3> extent_ = Vector<3>::Zero();
};

}  // namespace bernal::cad

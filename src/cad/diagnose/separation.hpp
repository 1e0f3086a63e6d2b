#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// Whether some direction d is proven to part the points `a` from the points `b`: every d·a below every d·b,
/// or above. Then their convex hulls have no point in common. No proof does not mean that they have.
///
/// Proof in double precision. With u = 2^-53, differences from `origin` carry one rounding, products one,
/// sums two, so that each computed d·(p - origin) is wrong by at most 4u / (1 - 4u) Σ_k |d_k| |p_k -
/// origin_k|, and by less than the smallest normal number where products underflow. Twice that, from the
/// largest |p_k - origin_k| of all points, is taken, which covers the rounding of the bound itself. The
/// direction is what it is in double: it need not be across anything. Whatever overflows proves nothing.
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

#pragma once
#include <limits>

#include "bernal/core/vector.hpp"

namespace bernal {

// Points of segments and triangles nearest to a point p.
//
// All functions work with *offsets* p - q rather than with the nearest point q: an offset is a difference of
// differences and so keeps the accuracy of the distances involved, wherever in space the triangle is.

/// p minus the point of the segment [a, b] nearest to p. A segment without length is a point. Error: a few
/// roundoffs of |p - a| + |b - a|.
inline Vector<3> offset_from_segment(const Vector<3>& p, const Vector<3>& a, const Vector<3>& b) {
  const Vector<3> base = b - a;
  const Vector<3> w = p - a;
  const double along = w.dot(base);
  const double squared_length = base.squaredNorm();
  if (!(along > 0)) return w;
  if (along >= squared_length) return p - b;
  return w - (along / squared_length) * base;
}

/// A triangle prepared for distance queries that stay accurate on needles, caps and triangles without area.
///
/// Coordinates are along the longest edge (the *base*) and along the height over it: p ~ corner + s·base +
/// t·height. Both s·|base| and the residual after removing it are accurate to a few roundoffs u of the
/// lengths involved; only the *direction* of the height suffers if the triangle is thin, by u·|side| /
/// |height|. So a face candidate inside the triangle is on it to rounding, and misses the nearest point
/// sideways by no more than the smaller of |height| and |p - q|·u·|side| / |height|. In the distance that is
/// at most a roundoff of the lengths for any shape; and the plane through the candidate normal to p - q still
/// has the whole triangle behind it to rounding, because the error is a tilt along the height, where the
/// triangle is thin. If no candidate is inside, the nearest of the three edges is taken; no region is ever
/// inferred from signs.
class PreparedTriangle {
 public:
  PreparedTriangle(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c)
      : corner_(a), end_(b), apex_(c) {
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    if (bc > ab && bc >= ca) {
      corner_ = b, end_ = c, apex_ = a;
    } else if (ca > ab) {
      corner_ = c, end_ = a, apex_ = b;
    }
    base_ = end_ - corner_;
    const Vector<3> side = apex_ - corner_;
    per_squared_base_ = inverse(base_.squaredNorm());
    foot_ = side.dot(base_) * per_squared_base_;
    height_ = side - foot_ * base_;
    per_squared_height_ = inverse(height_.squaredNorm());
  }

  /// p minus the nearest point of the triangle. Error of its length: a few roundoffs of |p - corner| +
  /// |base|.
  Vector<3> offset(const Vector<3>& p) const {
    const Vector<3> w = p - corner_;
    const double s = w.dot(base_) * per_squared_base_;
    const Vector<3> off_base = w - s * base_;
    const double t = off_base.dot(height_) * per_squared_height_;
    if (t >= 0 && t <= 1 && s >= foot_ * t && 1 - s >= (1 - foot_) * t) return off_base - t * height_;
    Vector<3> nearest = offset_from_segment(p, corner_, end_);
    for (const Vector<3>& start : {corner_, end_}) {
      const Vector<3> other = offset_from_segment(p, start, apex_);
      if (other.squaredNorm() < nearest.squaredNorm()) nearest = other;
    }
    return nearest;
  }

  double base_length() const { return base_.norm(); }

 private:
  static double inverse(double x) { return x > std::numeric_limits<double>::min() ? 1 / x : 0; }

  Vector<3> corner_, end_, apex_, base_, height_;
  double foot_ = 0;  ///< of the apex on the base, as a fraction of the base
  double per_squared_base_ = 0, per_squared_height_ = 0;
};

/// The point of the triangle nearest to p.
inline Vector<3> closest_point_of_triangle(const Vector<3>& p, const Vector<3>& a, const Vector<3>& b,
                                           const Vector<3>& c) {
  return p - PreparedTriangle(a, b, c).offset(p);
}

}  // namespace bernal

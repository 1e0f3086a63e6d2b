#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// A flat cylinder around a piece of wall, along the mean of its triangles' normals.
///
/// The box of a smooth piece that is oblique to the axes is nearly as thick as it is wide, and so from the
/// middle of a round part, or beside an oblique face, thousands of boxes are nearer than the wall is. The
/// disc is as thick as the piece is curved. Single precision, widened by more than that takes and by more
/// than distances in double are wrong; 32 bytes, so that a tree has one for each of its nodes. Where it
/// would be no thinner than the box it knows nothing.
class BoundingDisc {
 public:
  /// Around nothing that is known.
  BoundingDisc() = default;

  /// Around the triangles of leaves, each with `triangle()`; `extent` is that of all coordinates.
  template <class Leaf>
  BoundingDisc(std::span<const Leaf> leaves, double extent) {
    Vector<3> normal = Vector<3>::Zero();
    Bounds<3> bounds{leaves.front().triangle().a, leaves.front().triangle().a};
    const auto for_each_corner = [&](const auto& see) {
      for (const Leaf& leaf : leaves)
        for (const Vector<3>* v : {&leaf.triangle().a, &leaf.triangle().b, &leaf.triangle().c}) see(*v);
    };
    for (const Leaf& leaf : leaves) {
      const auto& t = leaf.triangle();
      normal += (t.b - t.a).cross(t.c - t.a);
    }
    for_each_corner([&](const Vector<3>& v) {
      bounds.lower = bounds.lower.cwiseMin(v);
      bounds.upper = bounds.upper.cwiseMax(v);
    });
    const double length = normal.norm();
    axis_ = (length > 0 ? Vector<3>(normal / length) : Vector<3>::UnitZ()).cast<float>();
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const Vector<3> axis = axis_.cast<double>(), middle = bounds.center();
    for_each_corner([&](const Vector<3>& v) {
      low = std::min(low, axis.dot(v - middle));
      high = std::max(high, axis.dot(v - middle));
    });
    center_ = (middle + 0.5 * (low + high) * axis).cast<float>();
    const Vector<3> center = center_.cast<double>();
    double half = 0, radius = 0;
    for_each_corner([&](const Vector<3>& v) {
      half = std::max(half, std::abs(axis.dot(v - center)));
      radius = std::max(radius, (v - center).cross(axis).squaredNorm());
    });
    half_thickness_ = static_cast<float>((1 + margin) * half + least_margin * extent);
    radius_ = static_cast<float>((1 + margin) * std::sqrt(radius) + least_margin * extent);
    if (half_thickness_ > worthwhile * bounds.size().minCoeff()) *this = BoundingDisc();
  }

  /// Surely nothing in it is as near to p as `distance`, which may be negative or infinite.
  bool is_beyond(const Vector<3>& p, double distance) const {
    if (knows_nothing()) return distance < 0;
    const Vector<3> w = p - center_.cast<double>(), axis = axis_.cast<double>();
    const double above = std::max(0.0, (1 - margin) * std::abs(axis.dot(w)) - half_thickness_);
    if (above > distance) return true;
    const double beside = std::max(0.0, (1 - margin) * w.cross(axis).norm() - radius_);
    return above * above + beside * beside > distance * std::abs(distance);
  }

  /// At most n·(p - x) for every point x in it; n is a unit vector.
  double depth_along(const Vector<3>& n, const Vector<3>& p) const {
    if (knows_nothing()) return -std::numeric_limits<double>::infinity();
    const Vector<3> axis = axis_.cast<double>();
    return n.dot(p - center_.cast<double>()) - std::abs(n.dot(axis)) * half_thickness_ -
           n.cross(axis).norm() * radius_;
  }

 private:
  bool knows_nothing() const { return !(radius_ < std::numeric_limits<float>::infinity()); }

  static constexpr double margin = 1e-6, least_margin = 1e-12;
  /// Thicker than this share of the box, it tells little that the box does not.
  static constexpr double worthwhile = 0.25;

  Eigen::Vector3f center_ = Eigen::Vector3f::Zero(), axis_ = Eigen::Vector3f::Zero();
  float half_thickness_ = std::numeric_limits<float>::infinity();
  float radius_ = std::numeric_limits<float>::infinity();
};

}  // namespace bernal::cad

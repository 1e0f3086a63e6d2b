#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "bernal/core/vector.hpp"

namespace bernal::cad {

/// A box around a piece of wall, with one axis along the mean of its triangles' normals and one along the
/// longer direction in the plane normal to that.
///
/// The axis-aligned box of an oblique smooth piece is nearly as thick as it is wide, and that of slanting
/// needles nearly as wide as they are long; so from the middle of a round part, or beside an oblique face,
/// thousands of such boxes are nearer than the wall. The oriented box is as thick as the piece is curved. It
/// is in single precision, widened by more than the error of that and of distances in double, and fits one
/// cache line. If it would be hardly smaller than the other box it is left unbounded.
class alignas(64) OrientedBox {
 public:
  /// An unbounded box, which excludes nothing.
  OrientedBox() = default;

  /// Around the triangles of leaves, each with `triangle()`; `extent` is that of all coordinates.
  template <class Leaf>
  OrientedBox(std::span<const Leaf> leaves, double extent) {
    const auto for_each_corner = [&](const auto& see) {
      for (const Leaf& leaf : leaves)
        for (const Vector<3>* v : {&leaf.triangle().a, &leaf.triangle().b, &leaf.triangle().c}) see(*v);
    };
    Vector<3> normal = Vector<3>::Zero();
    Bounds<3> bounds{leaves.front().triangle().a, leaves.front().triangle().a};
    for (const Leaf& leaf : leaves)
      normal += (leaf.triangle().b - leaf.triangle().a).cross(leaf.triangle().c - leaf.triangle().a);
    for_each_corner([&](const Vector<3>& v) {
      bounds.lower = bounds.lower.cwiseMin(v);
      bounds.upper = bounds.upper.cwiseMax(v);
    });
    const double length = normal.norm();
    if (!(length > 0)) return;
    normal /= length;

    const Vector<3> middle = bounds.center(), x = normal.unitOrthogonal(), y = normal.cross(x);
    double xx = 0, xy = 0, yy = 0;
    for_each_corner([&](const Vector<3>& v) {
      const double along_x = x.dot(v - middle), along_y = y.dot(v - middle);
      xx += along_x * along_x;
      xy += along_x * along_y;
      yy += along_y * along_y;
    });
    const double turn = 0.5 * std::atan2(2 * xy, xx - yy);
    const Vector<3> longer = std::cos(turn) * x + std::sin(turn) * y;
    axes_ << longer.transpose().cast<float>(), normal.cross(longer).transpose().cast<float>(),
        normal.transpose().cast<float>();

    const Eigen::Matrix3d axes = axes_.cast<double>();
    Vector<3> low = Vector<3>::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for_each_corner([&](const Vector<3>& v) {
      const Vector<3> along = axes * (v - middle);
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    });
    center_ = (middle + 0.5 * axes.transpose() * (low + high)).cast<float>();
    const Vector<3> center = axes * (center_.cast<double>() - middle);
    const Vector<3> half = (high - center).cwiseMax(center - low);
    const double least = least_worth * std::max(half.maxCoeff(), 0.5 * bounds.size().maxCoeff());
    if ((half.array() + least).prod() > worthwhile * (0.5 * bounds.size().array() + least).prod()) return;
    half_ = ((1 + margin) * half.array() + least_margin * extent).cast<float>();
  }

  /// A lower bound on the squared distance of p from every point in the box.
  double squared_distance(const Vector<3>& p) const {
    const Vector<3> along = axes_.cast<double>() * (p - center_.cast<double>());
    return ((1 - margin) * along.cwiseAbs() - half_.cast<double>()).cwiseMax(0.0).squaredNorm();
  }

  /// Whether everything in the box is certainly farther from p than `distance`, which may be negative or
  /// infinite.
  bool is_beyond(const Vector<3>& p, double distance) const {
    return squared_distance(p) > distance * std::abs(distance);
  }

  /// A lower bound on n·(p - x) over the points x in the box; n is a unit vector.
  double depth_along(const Vector<3>& n, const Vector<3>& p) const {
    const Vector<3> half = half_.cast<double>();
    const Vector<3> across = (axes_.cast<double>() * n).cwiseAbs();
    return n.dot(p - center_.cast<double>()) - (across.array() + margin).matrix().dot(half);
  }

 private:
  static constexpr double margin = 1e-6, least_margin = 1e-12;
  /// A box larger than this share of the other box is not worth a test. Both are compared with a least
  /// thickness, a share of their length.
  static constexpr double worthwhile = 0.5, least_worth = 1e-3;

  Eigen::Matrix3f axes_ = Eigen::Matrix3f::Zero();  ///< rows
  Eigen::Vector3f center_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f half_ = Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity());
};

}  // namespace bernal::cad

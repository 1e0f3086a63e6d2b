#include "meshes/round_surface.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace bernal {

namespace {

/// For a torus that a wall bends: to first order, by the gradient of the distance of what p is before
/// bending.
DistanceFrom distance_from_bent(const RoundSurface& surface, const Vector<3>& p) {
  const RoundSurface::Bend& bend = surface.bend;
  const Vector<3> from = p - surface.center;
  const double along = from.dot(surface.axis), squared = bend.wall_radius * bend.wall_radius;
  const Vector<3> beside = from - along * surface.axis;
  const Vector<3> slope = bend.across.isZero() ? beside : Vector<3>(beside.dot(bend.across) * bend.across);
  const double depth = std::sqrt(std::max(0.0, squared - slope.squaredNorm()));
  if (!(depth > 0)) return {};
  const double scale = 1 - (bend.wall_radius - depth) / bend.height;
  RoundSurface straight = surface;
  straight.bend = {};
  const double before = (along - bend.from) / scale;
  const DistanceFrom found =
      distance_from(straight, surface.center + beside + (bend.from + before) * surface.axis);
  // The height before bending grows by 1 / scale along the axis, and across it as the wall rises.
  const double rising = found.direction.dot(surface.axis) / scale;
  const Vector<3> gradient = found.direction - found.direction.dot(surface.axis) * surface.axis +
                             rising * (surface.axis + before / (bend.height * depth) * slope);
  const double length = gradient.norm();
  return length > 0 ? DistanceFrom{found.distance / length, gradient / length} : DistanceFrom{};
}

}  // namespace

DistanceFrom distance_from(const RoundSurface& surface, const Vector<3>& p) {
  if (surface.bend.wall_radius > 0) return distance_from_bent(surface, p);
  const Vector<3> from = p - surface.center;
  const auto away = [](const Vector<3>& d, double length) {
    return length > 0 ? Vector<3>(d / length) : Vector<3>(Vector<3>::Zero());
  };
  if (surface.kind == RoundSurface::Kind::sphere) {
    const double length = from.norm();
    return {length - surface.radius, away(from, length)};
  }
  const double along = from.dot(surface.axis);
  if (surface.kind == RoundSurface::Kind::plane) return {along, surface.axis};
  const Vector<3> beside = from - along * surface.axis;
  const double length = beside.norm();
  if (surface.kind == RoundSurface::Kind::cylinder) return {length - surface.radius, away(beside, length)};
  const Vector<3> of_tube = from - surface.radius * away(beside, length);
  const double to_tube = of_tube.norm();
  return {to_tube - surface.tube, away(of_tube, to_tube)};
}

std::optional<Vector<3>> point_on_all(std::span<const RoundSurface> surfaces, const Vector<3>& near) {
  constexpr int most_steps = 40;
  constexpr double good = 1e-12, rank = 1e-5;
  double scale = 0;
  for (const RoundSurface& surface : surfaces) scale = std::max({scale, surface.radius, surface.tube});
  Vector<3> p = near;
  for (int step = 0; step < most_steps; ++step) {
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 6, 3> rows(static_cast<Eigen::Index>(surfaces.size()), 3);
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> off(static_cast<Eigen::Index>(surfaces.size()));
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      const DistanceFrom from = distance_from(surfaces[k], p);
      rows.row(static_cast<Eigen::Index>(k)) = from.direction.transpose();
      off[static_cast<Eigen::Index>(k)] = from.distance;
    }
    if (off.cwiseAbs().maxCoeff() <= good * scale) return p;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(rank);
    solver.compute(rows);
    p -= solver.solve(off);
    if (!p.allFinite()) return {};
  }
  return {};
}

}  // namespace bernal

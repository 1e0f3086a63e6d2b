#include "hard/convex_walls.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

constexpr int most_fits = 16;
/// In tolerances: corners this far inside of a plane still belong to it, and none may lie farther outside.
constexpr double band = 2, outside = 4;

Wall<3> plane(const Vector<3>& normal, const Vector<3>& point) {
  return {.along = normal, .extent = normal.dot(point)};
}

struct Plane {
  Vector<3> normal;
  double offset;
};

/// Finds one plane after the other, each from the largest facet that has none yet.
class Planes {
 public:
  Planes(const Mesh& mesh, double tolerance)
      : mesh_(mesh), tolerance_(tolerance), covered_(mesh.triangles.size()), height_(mesh.vertices.size()) {}

  std::vector<Wall<3>> find() {
    const std::size_t facets = mesh_.triangles.size();
    std::vector<Vector<3>> normals(facets);
    for (std::size_t t = 0; t < facets; ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const Vector<3>& a = mesh_.vertices[i];
      normals[t] = (mesh_.vertices[j] - a).cross(mesh_.vertices[k] - a);
    }
    std::vector<std::size_t> order(facets);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(
        order, [&](auto s, auto t) { return normals[s].squaredNorm() > normals[t].squaredNorm(); });
    std::vector<Wall<3>> walls;
    for (const std::size_t t : order)
      if (!covered_[t] && normals[t].squaredNorm() > 0) walls.push_back(wall_of(t, normals[t].normalized()));
    return walls;
  }

 private:
  Wall<3> wall_of(std::size_t facet, const Vector<3>& normal) {
    const auto& corners = mesh_.triangles[facet];
    Plane best{normal, 0};
    for (const auto v : corners) best.offset += normal.dot(mesh_.vertices[v]) / 3;
    std::size_t known = corners.size();
    for (int k = 0; k < most_fits; ++k) {
      const std::vector<std::uint32_t> near = corners_near(best);
      if (near.size() <= known) break;
      known = near.size();
      best = fit(near, normal);
    }

    double highest = best.offset;
    for (std::size_t v = 0; v < height_.size(); ++v) {
      height_[v] = best.normal.dot(mesh_.vertices[v]);
      highest = std::max(highest, height_[v]);
    }
    if (highest - best.offset > outside * tolerance_)
      throw Error(
          ErrorCode::bad_scene,
          fmt::format("\"grow\" packs convex containers, and this one is not: a corner of the mesh lies "
                      "{:.1g} of its diameter outside of the plane of a facet; \"relax\" packs any",
                      (highest - best.offset) / bounds_of(Shape(mesh_)).diagonal()));
    double innermost = best.offset;
    covered_[facet] = true;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const double lowest = std::min({height_[i], height_[j], height_[k]});
      if (t != facet && !(lowest >= best.offset - band * tolerance_)) continue;
      covered_[t] = true;
      innermost = std::min(innermost, lowest);
    }
    return {.along = best.normal, .extent = innermost};
  }

  std::vector<std::uint32_t> corners_near(const Plane& plane) const {
    std::vector<std::uint32_t> near;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
      if (std::abs(plane.normal.dot(mesh_.vertices[v]) - plane.offset) <= tolerance_)
        near.push_back(static_cast<std::uint32_t>(v));
    return near;
  }

  /// Through their centre, across the direction in which they scatter least.
  Plane fit(const std::vector<std::uint32_t>& corners, const Vector<3>& facing) const {
    Vector<3> center = Vector<3>::Zero();
    for (const auto v : corners) center += mesh_.vertices[v];
    center /= static_cast<double>(corners.size());
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
    for (const auto v : corners) {
      const Vector<3> d = mesh_.vertices[v] - center;
      scatter += d * d.transpose();
    }
    Vector<3> normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
    if (normal.dot(facing) < 0) normal = -normal;
    return {normal, normal.dot(center)};
  }

  const Mesh& mesh_;
  const double tolerance_;
  std::vector<bool> covered_;
  std::vector<double> height_;
};

struct WallsOf {
  double tolerance;

  std::vector<Wall<3>> operator()(const BoxShape& box) const {
    const Bounds<3> bounds = bounds_of(box);
    std::vector<Wall<3>> walls;
    for (int k = 0; k < 3; ++k) {
      walls.push_back(plane(-Vector<3>::Unit(k), bounds.lower));
      walls.push_back(plane(Vector<3>::Unit(k), bounds.upper));
    }
    return walls;
  }
  std::vector<Wall<3>> operator()(const CylinderShape& cylinder) const {
    const Vector<3> axis = cylinder.axis.stableNormalized();
    return {{.round = true, .along = axis, .center = cylinder.base, .extent = cylinder.radius},
            plane(-axis, cylinder.base),
            plane(axis, cylinder.base + cylinder.height * axis)};
  }
  std::vector<Wall<3>> operator()(const SphereShape& sphere) const {
    return {{.round = true, .center = sphere.center, .extent = sphere.radius}};
  }
  std::vector<Wall<3>> operator()(const Mesh& mesh) const { return Planes(mesh, tolerance).find(); }
};

}  // namespace

std::vector<Wall<3>> convex_walls(const Shape& shape, double tolerance) {
  return std::visit(WallsOf{tolerance}, shape);
}

}  // namespace bernal

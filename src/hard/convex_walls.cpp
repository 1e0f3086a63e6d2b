#include "hard/convex_walls.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/order.hpp"
#include "near/box_tree.hpp"

namespace bernal {
namespace {

constexpr int most_fits = 16;
/// In tolerances: corners this far inside of a plane still belong to it, and none may lie farther outside.
constexpr double band = 2, outside = 4;

template <int D>
Wall<D> plane(const Vector<D>& normal, const Vector<D>& point) {
  return {.along = normal, .extent = normal.dot(point)};
}

/// Finds one plane after the other, each from the largest facet that has none yet.
class Planes {
 public:
  Planes(const Mesh& mesh, double tolerance)
      : mesh_(mesh),
        tolerance_(tolerance),
        tree_(mesh.vertices, {}, 8),
        facets_at_(mesh.vertices.size()),
        covered_(mesh.triangles.size()),
        height_(mesh.vertices.size(), below) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const auto v : mesh.triangles[t]) facets_at_[v].push_back(t);
  }

  /// None where the mesh is not convex.
  std::vector<Wall<3>> find() {
    const auto facets = static_cast<std::uint32_t>(mesh_.triangles.size());
    std::vector<Vector<3>> normals(facets);
    for (std::uint32_t t = 0; t < facets; ++t) {
      const auto& [i, j, k] = mesh_.triangles[t];
      const Vector<3>& a = mesh_.vertices[i];
      normals[t] = (mesh_.vertices[j] - a).cross(mesh_.vertices[k] - a);
    }
    std::vector<double> squared_areas;
    for (const Vector<3>& normal : normals) squared_areas.push_back(normal.squaredNorm());
    std::vector<Wall<3>> walls;
    for (const auto t : largest_first(squared_areas)) {
      if (covered_[t] || !(squared_areas[t] > 0)) continue;
      const std::optional<Wall<3>> wall = wall_of(t, normals[t].normalized());
      if (!wall) return {};
      walls.push_back(*wall);
    }
    return walls;
  }

 private:
  static constexpr double below = -std::numeric_limits<double>::infinity();

  /// Calls visit(corner, normal·corner) for those where that is `level` or more. No corner of a node is
  /// higher than the corner of its bounds that is farthest along the normal, to the last bit, since products
  /// and sums round in order.
  template <class Visit>
  void for_each_above(const Vector<3>& normal, double level, const Visit& visit) const {
    tree_.for_each_leaf(
        [&](const BoxTree<3>::Node& node) {
          const Bounds<3>& bounds = node.bounds;
          const Vector<3> highest = (normal.array() > 0).select(bounds.upper, bounds.lower);
          return normal.dot(highest) >= level;
        },
        [&](const BoxTree<3>::Node& leaf) {
          for (std::uint32_t k = leaf.first; k < leaf.last; ++k) {
            const std::uint32_t v = tree_.order()[k];
            if (const double height = normal.dot(mesh_.vertices[v]); height >= level) visit(v, height);
          }
        });
  }

  /// None where the facet has the mesh on both sides.
  std::optional<Wall<3>> wall_of(std::uint32_t facet, const Vector<3>& normal) {
    const Wall<3> best = plane_about(facet, normal);
    double highest = best.extent;
    std::vector<std::uint32_t> near;
    const auto note = [&](std::uint32_t v, double height) {
      near.push_back(v);
      height_[v] = height;
      highest = std::max(highest, height);
    };
    for_each_above(best.along, best.extent - band * tolerance_, note);
    if (highest - best.extent > outside * tolerance_) {
      for (const auto v : near) height_[v] = below;
      return {};
    }
    for (const auto v : mesh_.triangles[facet]) note(v, best.along.dot(mesh_.vertices[v]));
    double innermost = best.extent;
    for (const auto v : near)
      for (const auto t : facets_at_[v]) {
        const auto& [i, j, k] = mesh_.triangles[t];
        const double lowest = std::min({height_[i], height_[j], height_[k]});
        if (lowest == below) continue;
        covered_[t] = true;
        innermost = std::min(innermost, lowest);
      }
    for (const auto v : near) height_[v] = below;
    return Wall<3>{.along = best.along, .extent = innermost};
  }

  /// The plane of the facet, and then the best one through all corners near it as long as these become more.
  Wall<3> plane_about(std::uint32_t facet, const Vector<3>& normal) const {
    const auto& corners = mesh_.triangles[facet];
    Wall<3> best{.along = normal};
    for (const auto v : corners) best.extent += normal.dot(mesh_.vertices[v]) / 3;
    std::size_t known = corners.size();
    for (int k = 0; k < most_fits; ++k) {
      std::vector<std::uint32_t> near;
      for_each_above(best.along, best.extent - tolerance_, [&](std::uint32_t v, double height) {
        if (height <= best.extent + tolerance_) near.push_back(v);
      });
      if (near.size() <= known) break;
      known = near.size();
      best = fit(near, normal);
    }
    return best;
  }

  /// Through their centre, across the direction in which they scatter least.
  Wall<3> fit(const std::vector<std::uint32_t>& corners, const Vector<3>& facing) const {
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
    return plane<3>(normal, center);
  }

  const Mesh& mesh_;
  const double tolerance_;
  const BoxTree<3> tree_;                              // of the corners
  std::vector<std::vector<std::uint32_t>> facets_at_;  // of each corner
  std::vector<bool> covered_;
  std::vector<double> height_;  // over the plane at hand, of corners near it
};

template <int D>
std::vector<Wall<D>> walls_of_box(const Box& box) {
  const Vector<D> lower = bounds_of(box).lower.template head<D>(),
                  upper = bounds_of(box).upper.template head<D>();
  std::vector<Wall<D>> walls;
  for (int k = 0; k < D; ++k) {
    if (!box.has_wall(k)) continue;
    walls.push_back(plane<D>(-Vector<D>::Unit(k), lower));
    walls.push_back(plane<D>(Vector<D>::Unit(k), upper));
  }
  return walls;
}

struct WallsOf {
  double tolerance;

  std::vector<Wall<3>> operator()(const Box& box) const { return walls_of_box<3>(box); }
  std::vector<Wall<3>> operator()(const Cylinder& cylinder) const {
    const Vector<3> axis = cylinder.axis.stableNormalized();
    std::vector<Wall<3>> walls{
        {.round = true, .along = axis, .center = cylinder.base, .extent = cylinder.radius}};
    if (cylinder.periodic) return walls;
    walls.push_back(plane<3>(-axis, cylinder.base));
    walls.push_back(plane<3>(axis, cylinder.base + cylinder.height * axis));
    return walls;
  }
  std::vector<Wall<3>> operator()(const Sphere& sphere) const {
    return {{.round = true, .center = sphere.center, .extent = sphere.radius}};
  }
  std::vector<Wall<3>> operator()(const Mesh& mesh) const {
    require_closed_walls(mesh, "growth");
    std::vector<Wall<3>> walls = Planes(mesh, tolerance).find();
    for (Wall<3>& wall : walls) wall.extent -= mesh.inset;
    return walls;
  }
  std::vector<Wall<3>> operator()(const Revolved&) const { return {}; }
  std::vector<Wall<3>> operator()(const Polygon&) const { return {}; }
};

}  // namespace

template <>
std::vector<Wall<3>> convex_walls(const Domain& shape, double tolerance) {
  return std::visit(WallsOf{tolerance}, shape);
}

template <>
std::vector<Wall<2>> convex_walls(const Domain& shape, double) {
  const auto* box = std::get_if<Box>(&shape);
  return box ? walls_of_box<2>(*box) : std::vector<Wall<2>>();
}

}  // namespace bernal

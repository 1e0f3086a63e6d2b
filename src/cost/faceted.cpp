#include "cost/faceted.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bernal::cost {
namespace {

/// Corners on rings about an axis, between two points on it: closed, outward.
class Lathe {
 public:
  explicit Lathe(std::uint32_t around) : around_(around) {}

  void ring(const Vector<3>& center, const Vector<3>& u, const Vector<3>& v, double radius) {
    for (std::uint32_t k = 0; k < around_; ++k) {
      const double angle = 2 * std::numbers::pi * k / around_;
      mesh_.vertices.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
    ++rings_;
  }
  /// Between the last two rings.
  void wall() {
    const std::uint32_t low = (rings_ - 2) * around_, high = low + around_;
    for (std::uint32_t k = 0; k < around_; ++k) {
      const std::uint32_t next = (k + 1) % around_;
      mesh_.triangles.push_back({low + k, low + next, high + next});
      mesh_.triangles.push_back({low + k, high + next, high + k});
    }
  }
  /// From the first ring down to one point, and from the last ring up to another.
  Mesh closed(const Vector<3>& bottom, const Vector<3>& top) && {
    const std::uint32_t last = (rings_ - 1) * around_;
    const auto below = static_cast<std::uint32_t>(mesh_.vertices.size()), above = below + 1;
    mesh_.vertices.insert(mesh_.vertices.end(), {bottom, top});
    for (std::uint32_t k = 0; k < around_; ++k) {
      const std::uint32_t next = (k + 1) % around_;
      mesh_.triangles.push_back({below, next, k});
      mesh_.triangles.push_back({above, last + k, last + next});
    }
    return std::move(mesh_);
  }

 private:
  Mesh mesh_;
  std::uint32_t around_, rings_ = 0;
};

Faceted prism(const Cylinder& cylinder, int faces) {
  const Vector<3> axis = cylinder.axis.normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const Vector<3> top = cylinder.base + cylinder.height * axis;
  Lathe lathe(static_cast<std::uint32_t>(std::max(3, faces - 2)));
  lathe.ring(cylinder.base, u, v, cylinder.radius);
  lathe.ring(top, u, v, cylinder.radius);
  lathe.wall();
  return {std::move(lathe).closed(cylinder.base, top),
          cylinder.radius * (1 - std::cos(std::numbers::pi / std::max(3, faces - 2)))};
}

/// Of n rings of 2 n faces: about 2 n² of them.
Faceted polyhedron(const Sphere& sphere, int faces) {
  const int n = std::max(2, static_cast<int>(std::lround(std::sqrt(0.5 * faces))));
  const double step = std::numbers::pi / n;
  Lathe lathe(static_cast<std::uint32_t>(2 * n));
  for (int k = 1; k < n; ++k) {
    const double height = -sphere.radius * std::cos(k * step);
    lathe.ring(sphere.center + height * Vector<3>::UnitZ(), Vector<3>::UnitX(), Vector<3>::UnitY(),
               sphere.radius * std::sin(k * step));
    if (k > 1) lathe.wall();
  }
  const Vector<3> pole = sphere.radius * Vector<3>::UnitZ();
  // The middle of a face at the equator is nearest to the centre: half a step off in both directions.
  const double nearest = std::pow(std::cos(0.5 * step), 2);
  return {std::move(lathe).closed(sphere.center - pole, sphere.center + pole), sphere.radius * (1 - nearest)};
}

}  // namespace

std::optional<Faceted> faceted(const Domain& container, int faces) {
  if (const auto* cylinder = std::get_if<Cylinder>(&container); cylinder && !cylinder->periodic)
    return prism(*cylinder, faces);
  if (const auto* sphere = std::get_if<Sphere>(&container)) return polyhedron(*sphere, faces);
  return {};
}

}  // namespace bernal::cost

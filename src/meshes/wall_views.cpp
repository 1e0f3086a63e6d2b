#include "meshes/wall_views.hpp"

#include <cmath>
#include <numbers>

#include "solids/solids.hpp"

namespace bernal {

std::vector<WallSheet> walls_around(const Domain& domain, const Vector<3>& p) {
  std::vector<WallSheet> views;
  if (const auto* box = std::get_if<Box>(&domain)) {
    for (int k = 0; k < 3; ++k) {
      if (box->repeats(k)) continue;
      views.push_back({static_cast<std::uint32_t>(2 * k), -Vector<3>::Unit(k), p[k] - box->corner[k]});
      views.push_back(
          {static_cast<std::uint32_t>(2 * k + 1), Vector<3>::Unit(k), box->corner[k] + box->size[k] - p[k]});
    }
  } else if (const auto* cylinder = std::get_if<Cylinder>(&domain)) {
    const Vector<3> a = cylinder->axis.normalized(), d = p - cylinder->base;
    const double z = d.dot(a);
    const Vector<3> across = d - z * a;
    if (across.norm() > 0) views.push_back({0, across.normalized(), cylinder->radius - across.norm()});
    if (!cylinder->periodic) {
      views.push_back({1, -a, z});
      views.push_back({2, a, cylinder->height - z});
    }
  } else if (const auto* sphere = std::get_if<Sphere>(&domain)) {
    const Vector<3> d = p - sphere->center;
    if (d.norm() > 0) views.push_back({0, d.normalized(), sphere->radius - d.norm()});
  }
  return views;
}

double radius_of_wall(const Domain& domain, std::uint32_t wall) {
  if (const auto* sphere = std::get_if<Sphere>(&domain)) return sphere->radius;
  const auto* cylinder = std::get_if<Cylinder>(&domain);
  return cylinder != nullptr && wall == 0u ? cylinder->radius : 0;
}

double rise_of_wall(const Domain& domain, std::uint32_t wall, double radius) {
  const double of_wall = radius_of_wall(domain, wall);
  return of_wall > 0 ? radius * radius / (of_wall + std::sqrt(of_wall * of_wall - radius * radius)) : 0;
}

double volume_before_wall(const Domain& domain, std::uint32_t wall, double radius) {
  const double of_wall = radius_of_wall(domain, wall), squared = radius * radius;
  if (!(of_wall > 0)) return 0;
  if (std::holds_alternative<Sphere>(domain)) {
    const double rise = rise_of_wall(domain, wall, radius);
    return std::numbers::pi * squared * rise - cap_volume(of_wall, rise);
  }
  constexpr int nodes = 48;
  double sum = 0;
  for (int k = 1; k <= nodes; ++k) {
    const double t = std::numbers::pi * k / (nodes + 1), x = radius * std::cos(t), s = std::sin(t);
    sum += s * s * (x * x / (of_wall + std::sqrt(of_wall * of_wall - x * x)));
  }
  return 2 * squared * std::numbers::pi / (nodes + 1) * sum;
}

}  // namespace bernal

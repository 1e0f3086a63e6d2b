#include "meshes/wall_views.hpp"

namespace bernal {

std::vector<WallView> walls_around(const Domain& domain, const Vector<3>& p) {
  std::vector<WallView> views;
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

}  // namespace bernal

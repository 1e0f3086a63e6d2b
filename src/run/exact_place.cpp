#include "run/exact_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bernal/cad/mesh_container.hpp"

namespace bernal {

std::optional<Vector<3>> ExactPlace::near(const Vector<3>& place, double r) {
  if (!of_scene_) {
    const Frame none{.resolution = frame_.resolution * frame_.scale};
    const bool plain =
        plan_.scene.walls == WallArithmetic::plain;  // of which a place that touches has no use
    of_scene_ =
        make_container(plan_.domain, plain ? WallArithmetic::filtered : plan_.scene.walls, none.resolution);
  }
  const Vector<3> at = frame_.to_scene(place);
  if (const auto found = rounded_near(at, r)) return found;
  for (const Vector<3>& turned : in_half_planes(at))
    if (const auto found = rounded_near(turned, r)) return found;
  return {};
}

double ExactPlace::nearly() const { return 1e-9 * frame_.scale + 4 * frame_.resolution * frame_.scale; }

std::optional<Vector<3>> ExactPlace::rounded_near(const Vector<3>& at, double r) const {
  // Of corners that are no doubles, those of the container are off by less than two spacings an axis.
  const auto* mesh = std::get_if<Mesh>(&plan_.domain);
  const double off = mesh && mesh->exact ? 4 * frame_.resolution * frame_.scale : 0;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Vector<3> middle = bounds_of(plan_.domain).center();
  for (const bool in_the_middle : {false, true}) {
    for (int n = 0; n < 27; ++n) {
      Vector<3> p = at;
      for (int k = 0, step = n; k < plan_.scene.dimension(); ++k, step /= 3) {
        if (in_the_middle && std::abs(p[k] - middle[k]) < nearly()) p[k] = middle[k];
        if (step % 3 > 0) p[k] = std::nextafter(p[k], step % 3 == 1 ? infinity : -infinity);
      }
      const Vector<3> local = frame_.to_local(p);
      if (frame_.to_scene(local) == p && of_scene_->contains(p, frame_.scale * r + off)) return local;
    }
  }
  return {};
}

std::vector<Vector<3>> ExactPlace::in_half_planes(const Vector<3>& at) const {
  const auto* solid = std::get_if<Revolved>(&plan_.domain);
  const int along = solid ? Cylinder{.axis = solid->axis}.coordinate_axis() : -1;
  if (along < 0) return {};
  std::vector<double> walls;  // that are upright
  solid->for_each_edge([&](const Vector<2>& a, const Vector<2>& b) {
    if (a[0] == b[0]) walls.push_back(a[0]);
  });
  const int u = (along + 1) % 3, v = (along + 2) % 3;
  const double distance = std::hypot(at[u] - solid->base[u], at[v] - solid->base[v]);
  double used = distance;
  for (const double one : walls)
    for (const double other : walls)
      if (std::abs(0.5 * (one + other) - distance) < nearly()) used = 0.5 * (one + other);
  std::vector<Vector<3>> places;
  for (const int k : {u, v})
    for (const double side : {used, -used}) {
      Vector<3> p = at;
      p[u] = solid->base[u];
      p[v] = solid->base[v];
      p[k] += side;
      places.push_back(p);
    }
  std::ranges::sort(places, [&](const Vector<3>& p, const Vector<3>& q) {
    return (p - at).squaredNorm() < (q - at).squaredNorm();
  });
  return places;
}

}  // namespace bernal

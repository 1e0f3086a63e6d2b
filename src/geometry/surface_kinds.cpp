#include "geometry/surface_kinds.hpp"

#include <map>

#include <Eigen/Geometry>

namespace bernal {

std::vector<SurfaceKind> kinds_of(const TrueSurface& surface) {
  std::map<std::string, SurfaceKind> of_name;
  for (const TrueSurface::Face& face : surface.faces) ++of_name[face.kind].faces;
  double all = 0;
  for (const TrueSurface::Flat& flat : surface.flats) {
    const auto& [a, b, c] = flat.corners;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    of_name[surface.faces[flat.face].kind].share += area;
    all += area;
  }
  std::vector<SurfaceKind> kinds;
  for (auto& [name, kind] : of_name) kinds.push_back({name, kind.faces, kind.share / all});
  std::ranges::stable_sort(kinds, std::greater<>(), &SurfaceKind::share);
  return kinds;
}

}  // namespace bernal

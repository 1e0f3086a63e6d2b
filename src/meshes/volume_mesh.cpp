#include "meshes/volume_mesh.hpp"

#include <optional>

namespace bernal {

std::vector<double> volumes_of_regions(const VolumeMesh& mesh) {
  std::vector<double> six(mesh.regions.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const TetrahedronCorners& corners = mesh.tetrahedra[t];
    const Vector<3>& a = mesh.vertices[corners[0]];
    six[mesh.region[t]] += (mesh.vertices[corners[1]] - a)
                               .dot((mesh.vertices[corners[2]] - a).cross(mesh.vertices[corners[3]] - a));
  }
  for (double& volume : six) volume /= 6;
  return six;
}

std::vector<double> volumes_between(const ConformingSurface& surface) {
  std::vector<double> six(surface.regions.size(), 0.0);
  // Sums of cones from a corner of each region's: near its triangles less is lost to rounding.
  std::vector<std::optional<Vector<3>>> apex(surface.regions.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const FaceCorners& corners = surface.triangles[t];
    const auto& sides = surface.patches[surface.patch[t]].regions;
    for (int side = 0; side < 2; ++side) {
      const std::int32_t region = sides[static_cast<std::size_t>(side)];
      if (region == SurfacePatch::nothing) continue;
      std::optional<Vector<3>>& of_region = apex[static_cast<std::size_t>(region)];
      if (!of_region) of_region = surface.vertices[corners[0]];
      const Vector<3>& from = *of_region;
      const double cone =
          (surface.vertices[corners[0]] - from)
              .dot((surface.vertices[corners[1]] - from).cross(surface.vertices[corners[2]] - from));
      six[static_cast<std::size_t>(region)] += side == 0 ? cone : -cone;
    }
  }
  for (double& volume : six) volume /= 6;
  return six;
}

}  // namespace bernal

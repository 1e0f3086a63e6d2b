#include "meshes/volume_mesh.hpp"

#include <optional>

namespace bernal {

std::vector<TetrahedronCorners> tetrahedra_of(const PrismCorners& prism,
                                              const std::array<std::uint32_t, 3>& ranks) {
  // A turn of the corners that puts the lowest first leaves two orders of the others.
  std::size_t first = 0;
  for (const std::size_t k : {1, 2})
    if (ranks[k] < ranks[first]) first = k;
  const std::array<std::size_t, 3> at = {first, (first + 1) % 3, (first + 2) % 3};
  const std::uint32_t a = prism[at[0]], b = prism[at[1]], c = prism[at[2]];
  const std::uint32_t u = prism[at[0] + 3], v = prism[at[1] + 3], w = prism[at[2] + 3];
  std::vector<TetrahedronCorners> made;
  const auto add = [&](const TetrahedronCorners& corners) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (corners[i] == corners[j]) return;
    made.push_back(corners);
  };
  add({a, v, w, u});
  if (ranks[at[1]] < ranks[at[2]]) {
    add({a, b, w, v});
    add({a, b, c, w});
  } else {
    add({a, v, c, w});
    add({a, b, c, v});
  }
  return made;
}

std::vector<std::uint32_t> distinct_corners(const PrismCorners& p) {
  for (std::size_t k = 0; k < 3; ++k) {  // a turn of the corners that puts one of few kinds first
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const bool stands = p[k] != p[k + 3], others_stand = p[i] != p[i + 3], last_stands = p[j] != p[j + 3];
    if (stands && !others_stand && !last_stands) return {p[k], p[i], p[j], p[k + 3]};
    if (!stands && others_stand && last_stands) return {p[i], p[i + 3], p[j + 3], p[j], p[k]};
  }
  return {p.begin(), p.end()};
}

std::vector<double> volumes_of_regions(const VolumeMesh& mesh) {
  std::vector<double> six(mesh.regions.size(), 0.0);
  const auto add = [&](std::uint32_t region, const TetrahedronCorners& corners) {
    const Vector<3>& a = mesh.vertices[corners[0]];
    six[region] += (mesh.vertices[corners[1]] - a)
                       .dot((mesh.vertices[corners[2]] - a).cross(mesh.vertices[corners[3]] - a));
  };
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) add(mesh.region[t], mesh.tetrahedra[t]);
  for (const PrismCorners& prism : mesh.stacks.prisms)
    for (const TetrahedronCorners& corners : tetrahedra_of(prism)) add(0, corners);
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

#include "meshes/fill_layers.hpp"

#include <limits>

namespace bernal {
namespace {

constexpr std::uint32_t left_out = std::numeric_limits<std::uint32_t>::max();

/// A surface without what bounds nothing but regions that are filled, and the way back to its numbers.
struct RestOfSurface {
  ConformingSurface surface;
  std::vector<std::uint32_t> vertex, region;  ///< in the whole surface
};

RestOfSurface rest_of(const ConformingSurface& whole) {
  RestOfSurface rest;
  std::vector<std::int32_t> region(whole.regions.size(), 0);
  for (const std::uint32_t filled : whole.prisms.region) region[filled] = SurfacePatch::nothing;
  for (std::uint32_t r = 0; r < region.size(); ++r) {
    if (region[r] == SurfacePatch::nothing) continue;
    region[r] = static_cast<std::int32_t>(rest.region.size());
    rest.region.push_back(r);
    rest.surface.regions.push_back(whole.regions[r]);
  }
  rest.surface.patches = whole.patches;
  for (SurfacePatch& patch : rest.surface.patches)
    for (std::int32_t& side : patch.regions)
      if (side != SurfacePatch::nothing) side = region[static_cast<std::size_t>(side)];
  std::vector<std::uint32_t> number(whole.vertices.size(), left_out);
  for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
    const auto& sides = rest.surface.patches[whole.patch[t]].regions;
    if (sides[0] == SurfacePatch::nothing && sides[1] == SurfacePatch::nothing) continue;
    FaceCorners corners = whole.triangles[t];
    for (std::uint32_t& c : corners) {
      if (number[c] == left_out) {
        number[c] = static_cast<std::uint32_t>(rest.vertex.size());
        rest.vertex.push_back(c);
        rest.surface.vertices.push_back(whole.vertices[c]);
        rest.surface.size.push_back(whole.size.empty() ? 0 : whole.size[c]);
      }
      c = number[c];
    }
    rest.surface.triangles.push_back(corners);
    rest.surface.patch.push_back(whole.patch[t]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const auto& [lower, upper] : whole.periodic[axis])
      if (number[lower] != left_out && number[upper] != left_out)
        rest.surface.periodic[axis].push_back({number[lower], number[upper]});
  return rest;
}

}  // namespace

VolumeMesh fill_with_layers(const ConformingSurface& surface, const TetrahedraOptions& options,
                            FillReport& report, const Monitor& monitor) {
  if (surface.prisms.empty()) return fill(surface, options, report, monitor);
  const RestOfSurface rest = rest_of(surface);
  VolumeMesh mesh = fill(rest.surface, options, report, monitor);
  // Vertices of the whole surface come first, then those that TetGen added.
  const std::size_t given = rest.vertex.size(), count = surface.vertices.size();
  for (TetrahedronCorners& corners : mesh.tetrahedra)
    for (std::uint32_t& c : corners)
      c = c < given ? rest.vertex[c] : static_cast<std::uint32_t>(c - given + count);
  std::vector<Vector<3>> vertices = surface.vertices;
  vertices.insert(vertices.end(), mesh.vertices.begin() + static_cast<std::ptrdiff_t>(given),
                  mesh.vertices.end());
  mesh.vertices = std::move(vertices);
  for (std::uint32_t& region : mesh.region) region = rest.region[region];
  mesh.tetrahedra.insert(mesh.tetrahedra.end(), surface.prisms.tetrahedra.begin(),
                         surface.prisms.tetrahedra.end());
  mesh.region.insert(mesh.region.end(), surface.prisms.region.begin(), surface.prisms.region.end());
  mesh.triangles = surface.triangles;
  mesh.patch = surface.patch;
  mesh.patches = surface.patches;
  mesh.regions = surface.regions;
  mesh.periodic = surface.periodic;
  require_filled(mesh, surface, report);
  return mesh;
}

}  // namespace bernal

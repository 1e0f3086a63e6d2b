#include "meshes/conforming_surface.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/parallel.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

void require_options(const SurfaceMeshOptions& options) {
  if (!(options.sphere_edge >= 0.01 && options.sphere_edge <= 1) ||
      !(options.neck_edge >= 0.005 && options.neck_edge <= 1) || !(options.per_gap >= 0.1) ||
      !(options.per_layer >= 0.1))
    throw Error(
        ErrorCode::bad_argument,
        "edges of a mesh are from 0.01 to 1 on spheres and from 0.005 to 1 at bridges, in radii, and at "
        "least 0.1 widths of gaps and thicknesses of layers");
}

/// Vertices that no triangle has are left out: corners of a box inside of spheres. Those that lids alone have
/// go to them.
void leave_out_unused(ConformingSurface& made) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max(), of_lid = unused - 1;
  std::vector<std::uint32_t> number(made.vertices.size(), unused);
  for (const FaceCorners& t : made.lids.triangles)
    for (const std::uint32_t c : t) number[c] = of_lid;
  for (const FaceCorners& t : made.triangles)
    for (const std::uint32_t c : t) number[c] = 0;
  std::vector<std::uint32_t> of_lids;
  std::uint32_t used = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == of_lid) {
      of_lids.push_back(v);
      made.lids.vertices.push_back(made.vertices[v]);
    } else if (number[v] != unused) {
      number[v] = used;
      made.vertices[used] = made.vertices[v];
      made.size[used++] = made.size[v];
    }
  }
  made.vertices.resize(used);
  made.size.resize(used);
  for (auto& pairs : made.periodic) {
    std::erase_if(pairs,
                  [&](const auto& pair) { return number[pair[0]] >= of_lid || number[pair[1]] >= of_lid; });
    for (auto& pair : pairs) pair = {number[pair[0]], number[pair[1]]};
  }
  for (const std::uint32_t v : of_lids) number[v] = used++;
  const auto renumber = [&](auto& corners) {
    for (std::uint32_t& c : corners) c = number[c];
  };
  std::ranges::for_each(made.triangles, renumber);
  std::ranges::for_each(made.lids.triangles, renumber);
  std::ranges::for_each(made.lids.chords, renumber);
  std::ranges::for_each(made.prisms.tetrahedra, renumber);
}

}  // namespace

ConformingSurface conforming_surface(const Solids& solids, const SurfaceMeshOptions& options,
                                     const Monitor& monitor) {
  require_options(options);
  const auto* box = std::get_if<Box>(&solids.domain);
  const auto* cylinder = std::get_if<Cylinder>(&solids.domain);
  const auto* sphere = std::get_if<Sphere>(&solids.domain);
  const auto* mesh = std::get_if<Mesh>(&solids.domain);
  if ((box == nullptr && cylinder == nullptr && sphere == nullptr && mesh == nullptr) ||
      solids.spheres.dimension() != 3 || (mesh != nullptr && mesh->inset != 0))
    throw Error(ErrorCode::bad_argument,
                fmt::format("meshes are made in boxes, cylinders, spheres and CAD parts of three dimensions, "
                            "not in a {}",
                            name_of(solids.domain)));
  SurfaceDraft draft(solids, options);
  deepen_caps(draft);
  if (mesh != nullptr && !solids.is_cut()) draft.flat_walls = flat_walls_of(*mesh);
  add_necks(draft);
  if (options.solids) add_shells(draft);
  add_circles(draft);
  add_neck_traces(draft);
  mesh_necks(draft);
  const Interruptible interruptible(monitor);
  mesh_pieces(draft, monitor);
  monitor.report({"surface", -1, "walls and ends of periods"});
  mesh_flat_faces(draft);
  mesh_copied_shells(draft);
  if (solids.part) {
    mesh_cut_faces(draft, *solids.part);
  } else if (box != nullptr) {
    mesh_box(draft, *box);
  } else if (cylinder != nullptr) {
    mesh_cylinder(draft, *cylinder);
  } else if (mesh != nullptr) {
    mesh_flat_walls(draft, *mesh);
  } else {
    mesh_ball(draft, *sphere);
  }
  add_regions(draft);
  state(draft);
  leave_out_unused(draft.made);
  return std::move(draft.made);
}

}  // namespace bernal

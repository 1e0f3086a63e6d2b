#include "meshes/conforming_surface.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

void require_options(const SurfaceMeshOptions& options) {
  if (!(options.sphere_edge >= 0.01 && options.sphere_edge <= 1) ||
      !(options.neck_edge >= 0.005 && options.neck_edge <= 1) || !(options.per_gap >= 0.1))
    throw Error(
        ErrorCode::bad_argument,
        "edges of a mesh are from 0.01 to 1 on spheres and from 0.005 to 1 at bridges, in radii, and at "
        "least 0.1 widths of gaps");
}

}  // namespace

ConformingSurface conforming_surface(const Solids& solids, const SurfaceMeshOptions& options,
                                     const Monitor& monitor) {
  require_options(options);
  const auto* box = std::get_if<Box>(&solids.domain);
  const auto* cylinder = std::get_if<Cylinder>(&solids.domain);
  if ((box == nullptr && cylinder == nullptr) || solids.spheres.dimension() != 3)
    throw Error(ErrorCode::bad_argument,
                fmt::format("meshes are made in boxes and cylinders of three dimensions, not in a {}",
                            name_of(solids.domain)));
  SurfaceDraft draft(solids, options);
  for (const Piece& piece : solids.pieces) draft.pieces.push_back({piece, {}});
  add_necks(draft);
  add_circles(draft);
  mesh_necks(draft);
  mesh_pieces(draft, monitor);
  mesh_flat_faces(draft);
  if (box != nullptr) {
    mesh_box(draft, *box);
  } else {
    mesh_cylinder(draft, *cylinder);
  }
  add_regions(draft);
  state(draft);
  return std::move(draft.made);
}

}  // namespace bernal

#include "mesh_files/solids_to_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/measure/slab.hpp"
#include "bernal/scene/sphere_layers.hpp"
#include "mesh_files/mesh_file.hpp"
#include "meshes/flat_walls.hpp"
#include "solids/cut_out.hpp"

namespace bernal {
namespace {

/// Where layers of spheres begin; nothing where only the fluid is meshed.
InnerSpheres shells_of(const Packing& packing, const MeshFileOptions& options) {
  InnerSpheres shells;
  if (!options.solids) return shells;
  const SphereLayers layers = layers_of(packing);
  if (layers.empty()) return shells;
  shells.first.push_back(0);
  for (std::size_t i = 0; i < packing.spheres.size(); ++i) {
    const std::span<const double> outer = layers.of(i);
    for (std::size_t k = 0; k + 1 < outer.size(); ++k) shells.radius.push_back(outer[k]);
    shells.first.push_back(shells.radius.size());
  }
  return shells;
}

/// The box that a text like "x = 1..4, y = 1..4, z = 0..5" names.
Bounds<3> box_in(std::string_view text, Unit unit) {
  Bounds<3> box;
  std::array<bool, 3> has{};
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    LowerPart slab;
    try {
      slab = slab_in(text.substr(from, comma - from), unit);
    } catch (const Error&) {
      break;
    }
    from = comma + 1;
    int axis = 0;
    slab.direction.cwiseAbs().maxCoeff(&axis);
    if (std::abs(slab.direction[axis]) < 1 || has[static_cast<std::size_t>(axis)] ||
        !std::isfinite(slab.from) || !std::isfinite(slab.height))
      break;
    has[static_cast<std::size_t>(axis)] = true;
    const double one = -slab.direction[axis] * slab.from, other = -slab.direction[axis] * slab.height;
    box.lower[axis] = std::min(one, other);
    box.upper[axis] = std::max(one, other);
    if (from > text.size() && has[0] && has[1] && has[2]) return box;
  }
  throw Error(ErrorCode::bad_argument,
              fmt::format("‹cut› takes a box such as \"x = 1..4, y = 1..4, z = 0..5\", not \"{}\"",
                          plain_text(text)));
}

}  // namespace

SolidsToMesh solids_to_mesh(const Packing& packing, const MeshFileOptions& options, const Monitor& monitor,
                            BedMeshReport& report) {
  SolidsInWalls in_walls = solids_in_walls(packing.spheres, packing.domain,
                                           {.contact = options.contact,
                                            .gap = options.gap,
                                            .bridge_radius = options.bridge_radius,
                                            .bridge_angle = options.bridge_angle,
                                            .shells = shells_of(packing, options),
                                            .clear_of_ends = true},
                                           options.neck_edge, monitor);
  report.gaps_at_edges = in_walls.gaps_at_edges;
  report.wall_deviation = in_walls.wall_deviation;
  Solids& solids = in_walls.solids;
  report.cleared = solids.cleared;
  if (options.cut.empty()) return {std::move(solids), {}};
  CutOut part = cut_out(solids, box_in(options.cut, packing.scene.unit), options.gap);
  if (part.solids.spheres.empty())
    throw Error(ErrorCode::bad_argument, "there are no spheres in the box of ‹cut›");
  report.spheres = part.solids.spheres.size();
  report.domain_volume = volume_of(part.solids.domain);
  report.cleared = part.solids.cleared;
  for (const Piece& piece : part.solids.pieces) report.clipped += !piece.cuts.empty();
  return {std::move(part.solids), std::move(part.of_packing)};
}

}  // namespace bernal

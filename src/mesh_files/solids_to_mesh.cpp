#include "mesh_files/solids_to_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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
#include "solids/part_in_file.hpp"

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

/// The box between slabs along the three axes; nothing where they are others.
std::optional<Bounds<3>> box_between(const std::vector<LowerPart>& slabs) {
  Bounds<3> box;
  std::array<bool, 3> has{};
  for (const LowerPart& slab : slabs) {
    int axis = 0;
    slab.direction.cwiseAbs().maxCoeff(&axis);
    if (std::abs(slab.direction[axis]) < 1 || has[static_cast<std::size_t>(axis)] ||
        !std::isfinite(slab.from) || !std::isfinite(slab.height))
      return {};
    has[static_cast<std::size_t>(axis)] = true;
    const double one = -slab.direction[axis] * slab.from, other = -slab.direction[axis] * slab.height;
    box.lower[axis] = std::min(one, other);
    box.upper[axis] = std::max(one, other);
  }
  if (slabs.size() != 3) return {};
  return box;
}

/// The part that a text names: "x = 1..4, y = 1..4, z = 0..5", other planes, or a file.
ConvexPart part_named(std::string_view text, const Packing& packing) {
  const Unit unit = packing.scene.unit;
  if (is_file_of_part(text))
    return part_in_file(text, unit, packing.spheres.empty() ? 0 : std::ranges::min(packing.spheres.r));
  std::vector<LowerPart> slabs;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    try {
      slabs.push_back(slab_in(text.substr(from, comma - from), unit));
    } catch (const Error&) {
      throw Error(ErrorCode::bad_argument,
                  fmt::format("‹cut› takes planes such as \"x = 1..4, y = 1..4, z = 0..5\" or a file such as "
                              "part.stl, not \"{}\"",
                              plain_text(text)));
    }
    from = comma + 1;
  }
  if (const auto box = box_between(slabs)) return part_of_box(*box);
  std::vector<HalfSpace> planes;
  for (const LowerPart& slab : slabs) {
    if (std::isfinite(slab.from)) planes.push_back({slab.direction, -slab.from});
    if (std::isfinite(slab.height)) planes.push_back({-slab.direction, slab.height});
  }
  constexpr double far = 100;
  Bounds<3> around = bounds_of(packing.domain);
  const Vector<3> beyond = Vector<3>::Constant(far * around.diagonal());
  around.lower -= beyond;
  around.upper += beyond;
  return part_between(planes, around);
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
  CutOut part = cut_out(solids, part_named(options.cut, packing), options.gap);
  if (part.solids.spheres.empty())
    throw Error(ErrorCode::bad_argument, "there are no spheres in the part of ‹cut›");
  report.spheres = part.solids.spheres.size();
  report.domain_volume = volume_of(part.solids.domain);
  report.packed_porosity =
      1 - volume_in(*part.solids.part, packing.spheres, packing.domain) / report.domain_volume;
  report.cleared = part.solids.cleared;
  for (const Piece& piece : part.solids.pieces) report.clipped += !piece.cuts.empty();
  return {std::move(part.solids), std::move(part.of_packing)};
}

}  // namespace bernal

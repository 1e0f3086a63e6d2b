#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bernal/cost/cost.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "bernal/plan/mesh_price.hpp"

namespace bernal {

/// A mesh by the length of its edges: what it is expected to cost and, where there was time, what it is like.
struct MeshCostRow {
  double sphere_edge = 0, neck_edge = 0;  ///< in radii, as in MeshFileOptions
  MeshPrice expected = {};
  std::optional<BedMeshReport> measured = {};
  double seconds() const;  ///< of what was measured, all parts together, on the wall
  double bytes() const;    ///< of the program that fills the surface, at its peak
  /// How much more of the domain the mesh holds than the true fluid: chords cut off a share of the spheres.
  double porosity_error() const;
};

struct MeshCostReport {
  std::filesystem::path file;
  std::size_t spheres = 0;
  std::vector<MeshCostRow> rows = {};  ///< the coarsest first
  bool cancelled = false;              ///< what was measured by then is written
};

/// Packs a scene and meshes the fluid around its spheres with shorter and shorter edges: 0.6, 0.45, 0.3, 0.2
/// and 0.15 radii on spheres and half of that where bridges begin. A mesh is made as long as the time that it
/// is expected to take is left; of the others only what is expected is said.
///
/// Writes meshes.csv into `folder` after every mesh; `options` are those of `measure_cost`, without seeds.
/// Throws as `build`, `run`, `mesh_packing`; Error{cannot_write} where somebody else's file has that name.
/// Cost: the time that is given, and that of packing.
MeshCostReport measure_mesh_cost(const Scene&, const std::filesystem::path& folder,
                                 const CostOptions& options = {});

}  // namespace bernal

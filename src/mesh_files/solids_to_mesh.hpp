#pragma once
#include <cstdint>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/mesh_files/mesh_packing.hpp"
#include "solids/solids.hpp"

namespace bernal {

/// The solids of a packing, or of a part of it.
struct SolidsToMesh {
  Solids solids;
  /// Numbers of the spheres in the packing; empty if they are the same.
  std::vector<std::uint32_t> of_packing;
};

/// With contacts treated as the options ask for, the shells of layers where solids are meshed, and of
/// `options.cut` what lies in that part. Says in the report what that made of spheres and walls. Throws
/// Error{bad_argument} where the text of `cut` names no convex part, or none with spheres in it.
SolidsToMesh solids_to_mesh(const Packing& packing, const MeshFileOptions& options, const Monitor& monitor,
                            BedMeshReport& report);

}  // namespace bernal

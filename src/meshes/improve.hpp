#pragma once
#include <cstddef>

#include "bernal/core/monitor.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

struct ImproveOptions {
  double goal = 0.2;  ///< tetrahedra of a smaller SICN are looked at
  int passes = 12;    ///< at most
  /// Whether those whose inner faces do not determine a gradient count as poor, as flow solvers have it:
  /// `TetrahedraNear::quality`. It takes some 2 ms for each of these.
  bool for_gradients = false;
};
struct ImproveReport {
  std::size_t moved = 0, swapped = 0, inserted = 0, removed = 0;  ///< times of each
  int passes = 0;
};

/// Raises the least SICN: moves vertices inside of regions, swaps edges and faces, inserts and removes
/// vertices around tetrahedra of SICN below the goal, each where the least SICN of what it changes rises. The
/// triangles and their vertices stay, and so do volumes of regions to rounding. Ends where no tetrahedron is
/// below the goal or a pass changes nothing.
///
/// Cost: a copy of the numbers of corners, and some 0.1 to 1 ms for a tetrahedron below the goal in each
/// pass. Deterministic. Throws Cancelled.
ImproveReport improve(VolumeMesh&, const ImproveOptions& options = {}, const Monitor& monitor = {});

}  // namespace bernal

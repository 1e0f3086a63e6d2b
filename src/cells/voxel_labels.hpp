#pragma once
#include "bernal/voxels/voxels.hpp"

namespace bernal {

/// An image of the cells of the power diagram, of any container: i + 1 where the centre of a voxel is in the
/// cell of sphere i, of those on a face the first; 0xFFFFFFFF where it is outside the domain. Bytes as those
/// of `voxelise` with labels, the same for any number of threads.
///
/// Every cell is a set of planes, which cut a line of voxels at two ends. Cost: some µs a cell, and 20 ns a
/// row of voxels in it. Memory: 64 MiB of layers or one, and 0.5 kB a cell. Precondition: two or three
/// dimensions.
void label_cells(const Spheres<dynamic>&, const Domain&, const VoxelGrid&, const TakeLayers&,
                 const Monitor& monitor);

}  // namespace bernal

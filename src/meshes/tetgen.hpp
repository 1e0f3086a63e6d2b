#pragma once
#include <filesystem>

#include "meshes/conforming_surface.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// What TetGen reads: packing.node, packing.smesh. Source: TetGen's manual, 1.5, section 5.
/// `holes`: points in what stays empty.
void write_for_tetgen(const ConformingSurface&, const std::vector<Vector<3>>& holes,
                      const std::filesystem::path& folder);

/// What it wrote: vertices, of which those of the surface keep their coordinates to the bit, and
/// tetrahedra with regions. Throws Error{bad_mesh} where that is no mesh of the surface.
VolumeMesh read_from_tetgen(const ConformingSurface&, const std::filesystem::path& folder);

}  // namespace bernal

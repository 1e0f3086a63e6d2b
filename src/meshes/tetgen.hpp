#pragma once
#include <filesystem>

#include "bernal/core/monitor.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// What TetGen reads: packing.node, packing.smesh. Source: TetGen's manual, 1.5, section 5.
/// `holes`: points in what stays empty.
void write_for_tetgen(const ConformingSurface&, const std::vector<Vector<3>>& holes,
                      const std::filesystem::path& folder);

/// What it wrote: vertices, of which those of the surface keep their coordinates to the bit, and
/// tetrahedra; as their regions the numbers of the parts that hang together. Throws Error{bad_mesh} where
/// that is no mesh with this surface.
VolumeMesh read_from_tetgen(const ConformingSurface&, const std::filesystem::path& folder);

/// Points behind or in front of triangles where no mesh is made, one for each closed part of the surface
/// that hangs together and has such a side inside of the domain.
std::vector<Vector<3>> points_of_holes(const ConformingSurface&);

struct TetgenOptions {
  double radius_over_edge = 1.2;  ///< of the sphere through the corners over the shortest edge, at most
  double least_angle = 14;        ///< between faces of tetrahedra away from the surface, in degrees
};

/// Where the program is. Throws Error{bad_argument} with the remedy where it is not installed.
std::filesystem::path require_tetgen();

/// Starts TetGen as a program of its own; the regions of the mesh are as `read_from_tetgen` says. The same
/// surface gives the same mesh. Throws as that and `require_tetgen`; Error{bad_mesh} where it fails,
/// Error{cannot_write} where its files cannot be written, Cancelled. Cost: about 20 µs and 1 kB a
/// tetrahedron.
VolumeMesh run_tetgen(const ConformingSurface&, const TetgenOptions&, double& peak_bytes,
                      const Monitor& monitor = {});

}  // namespace bernal

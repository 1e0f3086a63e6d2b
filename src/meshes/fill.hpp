#pragma once
#include "bernal/core/monitor.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/improve.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

struct TetrahedraOptions {
  double radius_over_edge = 1.2;  ///< of the sphere through the corners over the shortest edge, at most
  double least_angle = 14;        ///< between faces of tetrahedra away from the surface, in degrees
  double goal = 0.2;              ///< of the SICN, see `improve`
};

struct FillReport {
  double seconds = 0;     ///< in the mesher, with its files written and read
  double peak_bytes = 0;  ///< of the mesher
  double seconds_improving = 0;
  ImproveReport improvements;
  double volume_error = 0;  ///< of a region against that between its triangles, over the volume; the largest
};

/// Fills a surface with tetrahedra by TetGen, which is started as a program of its own, and improves them.
/// Checked: every triangle is a face of one tetrahedron on each side that has a region, of that region; the
/// regions have the volumes between their triangles, within 1e-10. The same surface gives the same mesh.
///
/// Throws Error{bad_argument} with the remedy where TetGen is not installed, Error{bad_mesh} where it fails,
/// or what it leaves is not such a mesh, Error{cannot_write} where its files cannot be written, Cancelled.
/// Cost: about 30 µs and 1 kB a tetrahedron.
VolumeMesh fill(const ConformingSurface&, const TetrahedraOptions&, FillReport&, const Monitor& monitor = {});

/// Points behind or in front of triangles where no mesh is made, one for each part of the surface that hangs
/// together and has such a side inside of the domain.
std::vector<Vector<3>> points_of_holes(const ConformingSurface&);

}  // namespace bernal

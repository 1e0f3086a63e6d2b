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
  bool for_gradients = false;     ///< see `ImproveOptions`
  /// Of a surface that is filled at once; larger ones are filled in sections, see `fill_in_sections`.
  std::size_t most_triangles = 1'000'000;
};

struct FillReport {
  double seconds = 0;        ///< in the mesher, with its files written and read
  double peak_bytes = 0;     ///< of the mesher, of as many as run at once
  std::size_t sections = 1;  ///< 1: filled at once
  bool sections_failed = false;
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

/// What `fill` checks, of any mesh of a surface; the largest error of a volume is reported. Throws
/// Error{bad_mesh} where it does not hold.
void require_filled(const VolumeMesh&, const ConformingSurface&, FillReport&);

}  // namespace bernal

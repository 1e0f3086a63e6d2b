#pragma once
#include <cstddef>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "meshes/conforming_surface.hpp"
#include "meshes/fill.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Layers of prisms in the fluid, on spheres and walls.
struct BoundaryLayerOptions {
  int layers = 0;            ///< none: no prisms
  double height = 0.1;       ///< of all layers together, at most, in radii; on walls in mean radii of spheres
  double growth = 1.2;       ///< height of a layer over that of the one below
  double per_gap = 2;        ///< as of SurfaceMeshOptions: edges in widths of the gap that prisms leave
  double sphere_edge = 0.3;  ///< as of SurfaceMeshOptions
  bool on_flat_walls = true;  ///< else walls that are planes have none: lids, faces of a cut box
};

/// Heights of the tops of layers over the height of all, ascending to 1.
std::vector<double> shares_of_layers(const BoundaryLayerOptions&);

/// From every vertex of a surface to the top of the prisms on it; zero where there are none: on circles in
/// which spheres are cut, at edges of walls, and where there is no room.
///
/// Prisms stand along the normals of spheres and walls. They take at most half of the room up to the nearest
/// triangle of another patch, less half of what tetrahedra need, so those of surfaces that face each other
/// stay apart; where that is less than three tenths of the height asked for, or flat beside the edges there,
/// there are none. Where layers end, they are high enough beside the edges there for the faces of each cell
/// to determine a gradient, as far as few layers and the height asked for allow that. Between vertices that
/// are next to each other the height changes by at most half of the distance: prisms end in a slope, without
/// a step.
///
/// Precondition: the fluid alone has a region. The same for any number of threads. Cost: some µs a vertex.
std::vector<Vector<3>> prism_columns(const ConformingSurface&, const BoundaryLayerOptions&);

/// Of a prism: the least of det(e1, e2, e3) / (|e1| |e2| |e3|) over corners that have another one above or
/// below them, e being the edges there, over what it is for an upright prism on an equal-sided triangle:
/// positive at all corners of a cell that is not turned inside out, and independent of how high it is.
double scaled_jacobian(const VolumeMesh&, const PrismCorners&);

/// What prisms are like.
struct PrismReport {
  std::size_t prisms = 0;                    ///< whole ones
  std::size_t ends = 0;                      ///< triangles on which layers end in pyramids and tetrahedra
  double covered = 0;                        ///< share of the area of spheres with whole prisms on them
  double least_height = 0, mean_height = 0;  ///< of all layers together, over vertices that have them
  double least_scaled_jacobian = 1;
};

/// Fills the surface that the columns raise by tetrahedra, as `fill` does, and what is below by prisms.
/// Checked beside what `fill` checks: no corner of a prism is turned inside out, and the regions have the
/// volumes between the triangles of the surface. Throws as `fill`; Error{bad_mesh} where that is not so.
VolumeMesh fill_with_prisms(const ConformingSurface&, const BoundaryLayerOptions&, const TetrahedraOptions&,
                            FillReport&, PrismReport&, const Monitor& monitor = {});

}  // namespace bernal

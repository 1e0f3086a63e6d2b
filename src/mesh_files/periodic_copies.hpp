#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "bernal/core/boundary.hpp"
#include "meshes/volume_mesh.hpp"

namespace bernal {

/// Whether the patch is one of those ends, and no face of a box cut out of a packing.
bool is_end_of_period(const SurfacePatch&, const Boundary<3>&);

/// Triangles that go on beyond the ends of periods.
struct OpenSurface {
  std::vector<Vector<3>> vertices;
  std::vector<FaceCorners> triangles;
  std::vector<std::uint32_t> triangle;  ///< of the mesh, that each of them is or is an image of
};

/// The triangles of a mesh that do not lie in ends of periods, and their images that reach into a margin
/// around the period: where the surface ran into an end, it goes on. Vertices and triangles of the mesh come
/// first, those of images share their vertices with what they join. Faces of a box cut out of a packing stay.
/// Cost: O(T), times 27 in three periods.
OpenSurface with_periodic_copies(const VolumeMesh&, const Boundary<3>&, double margin);

}  // namespace bernal

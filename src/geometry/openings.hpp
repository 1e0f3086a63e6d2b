#pragma once
#include <array>
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Whether each triangle of a mesh that repeats itself is an opening: all its corners lie in the lower or in
/// the upper end plane of an axis along which it does.
std::vector<bool> openings_of(const Mesh&);

/// The other triangles: those of the walls of one period.
std::vector<FaceCorners> triangles_of_walls(const Mesh&);

/// The period itself and so many more on either side of it along each axis, as one closed mesh that does not
/// repeat itself: only the openings at the outermost ends are closed. Its last triangles, `closures` of them,
/// are those; it has the inset of the mesh. Precondition: 0 along axes without a period.
struct RepeatedMesh {
  Mesh mesh;
  std::size_t closures = 0;
};
RepeatedMesh repeated(const Mesh&, const std::array<int, 3>& more);

}  // namespace bernal

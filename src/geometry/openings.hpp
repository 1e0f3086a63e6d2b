#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "bernal/geometry/mesh.hpp"

namespace bernal {

/// Whether a triangle lies in the plane in which coordinate `axis` is `at`, exactly.
inline bool lies_in_plane(const Mesh& mesh, const FaceCorners& triangle, int axis, double at) {
  return std::ranges::all_of(triangle, [&](std::uint32_t c) { return mesh.vertices[c][axis] == at; });
}

/// The triangles of the walls of one period: all but those that lie in the lower or in the upper end plane of
/// an axis along which the mesh repeats itself, which are openings.
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

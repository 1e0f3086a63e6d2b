// Walls that are triangles: their edges first, then the planar parts between them.
#include "meshes/flat_wall_edges.hpp"
#include "meshes/planar_part.hpp"

namespace bernal {

void mesh_flat_walls(SurfaceDraft& draft, const Mesh& mesh) {
  const PlanarWalls& walls = *draft.flat_walls;
  const auto chains = points_on_flat_edges(draft, walls, mesh.vertices);
  std::vector<std::vector<std::uint32_t>> edges(walls.parts.size()), feet(walls.parts.size());
  for (std::uint32_t e = 0; e < walls.edges.size(); ++e)
    for (const std::uint32_t part : walls.edges[e].parts) edges[part].push_back(e);
  for (std::uint32_t n = 0; n < draft.necks.size(); ++n)
    if (draft.necks[n].wall) feet[*draft.necks[n].wall].push_back(n);
  for (std::uint32_t p = 0; p < walls.parts.size(); ++p) {
    if (edges[p].empty()) continue;  // without height: within another part
    const FlatPart& frame = walls.parts[p];
    PlanarPart part(
        draft,
        [&](const Vector<3>& q) {
          return Vector<3>((q - frame.origin).dot(frame.u), (q - frame.origin).dot(frame.v), 0);
        },
        [&](const Vector<3>& q) { return Vector<3>(frame.origin + q[0] * frame.u + q[1] * frame.v); });
    for (const std::uint32_t e : edges[p]) part.add_chain(chains[e], false);
    for (const std::uint32_t n : feet[p]) part.add_chain(draft.necks[n].rim_points[1], true);
    part.mesh(draft.add_patch({SurfacePatch::Kind::wall, p, {0, SurfacePatch::nothing}}), false,
              [&](const Vector<3>& q) { return draft.sizes.on_wall(q, frame.outward, false); });
  }
}

}  // namespace bernal

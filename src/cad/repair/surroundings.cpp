#include "cad/repair/surroundings.hpp"

#include <algorithm>
#include <limits>

#include "cad/diagnose/self_intersections.hpp"
#include "cad/repair/surface_pieces.hpp"
#include "geometry/changes.hpp"
#include "geometry/measures.hpp"

namespace bernal::cad {

Surroundings::Surroundings(const Mesh& solid) : walls_(solid), box_(bounds_of(solid)), tree_of_solid_(solid) {
  const Vector<3> margin = Vector<3>::Constant(0.1 * box_.diagonal());
  box_ = {box_.lower - margin, box_.upper + margin};
  append(walls_, mesh_of_box(box_));
}

bool Surroundings::is_on_box(const Vector<3>& p) const {
  return (p.array() == box_.lower.array()).any() || (p.array() == box_.upper.array()).any();
}

/// Whether a remaining piece encloses the solid itself, as when a plane touches a brim without separating
/// both sides; tested beside the middle of the piece's largest face.
bool Surroundings::is_solid(const SurfacePieces& pieces, std::uint32_t piece, const Mesh& mesh) const {
  Vector<3> middle = Vector<3>::Zero(), normal = Vector<3>::Zero();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (pieces.piece_of(t) != piece) continue;
    const Vector<3> along = doubled_area(mesh, mesh.triangles[t]);
    if (along.squaredNorm() <= normal.squaredNorm()) continue;
    normal = along;
    middle = middle_of(mesh, mesh.triangles[t]);
  }
  const Vector<3> aside = 1e-6 * box_.diagonal() * normal.stableNormalized();
  for (const Vector<3>& p : {Vector<3>(middle + aside), Vector<3>(middle - aside)})
    if (pieces.encloses(piece, p)) return tree_of_solid_.crossing(p, 0, endless) == Crossing::odd;
  return true;  // thinner than can be decided
}

std::vector<Space> Surroundings::closed_off(const std::vector<CutPlane>& planes, double tolerance,
                                            double least, const Vector<3>* point) const {
  Mesh mesh = walls_;
  for (const CutPlane& plane : planes) mesh = cut(mesh, plane, tolerance);
  const MeshTopology topology = topology_of(mesh);
  if (!topology.closed() || orient_consistently(mesh, topology) == no_index) return {};
  const SurfacePieces pieces(mesh);
  std::vector<bool> hollow(pieces.count());
  for (std::uint32_t c = 0; c < pieces.count(); ++c) hollow[c] = pieces.depth(c) % 2 == 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t v : mesh.triangles[t])
      if (is_on_box(mesh.vertices[v])) hollow[pieces.piece_of(t)] = false;
  const std::vector<double> volumes = pieces.volumes();
  const std::uint32_t one = point ? pieces.around(*point) : no_index;
  std::vector<Space> spaces;
  for (std::uint32_t c = 0; c < pieces.count(); ++c) {
    if (!hollow[c] || (point && c != one) || !(volumes[c] > least) || is_solid(pieces, c, mesh)) continue;
    Space space{{}, volumes[c]};
    std::vector<bool> outermost(pieces.count(), false);
    outermost[c] = true;
    for (std::uint32_t other = 0; other < pieces.count(); ++other)
      if (pieces.depth(other) == pieces.depth(c) + 1 && pieces.encloses(c, other))
        space.volume -= volumes[other];
    space.walls = pieces.walls_of(outermost);
    if (planes.empty() || !intersects_itself(space.walls)) spaces.push_back(std::move(space));
  }
  std::ranges::stable_sort(spaces, std::greater<>(), &Space::volume);
  return spaces;
}

Mesh walls_of(const std::vector<Space>& spaces) {
  Mesh all;
  for (const Space& space : spaces) append(all, space.walls);
  return all;
}

}  // namespace bernal::cad

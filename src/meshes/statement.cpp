// What is said of a surface beside its triangles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/surface_draft.hpp"

namespace bernal {

Vector<3> inner_point(const Piece& piece) {
  // The centre, moved behind each cut until it is well behind all of them, as far as the lowest part left
  // asks.
  double room = piece.radius;
  for (const Cut& cut : piece.cuts)
    room = std::min(room, piece.radius + cut.keeps.offset - cut.keeps.normal.dot(piece.center));
  Vector<3> point = piece.center;
  for (int round = 0; round < 50; ++round)
    for (const Cut& cut : piece.cuts)
      if (const double beyond = cut.keeps.normal.dot(point) - cut.keeps.offset; beyond > -0.2 * room)
        point -= (beyond + 0.3 * room) * cut.keeps.normal;
  return point;
}

void add_regions(SurfaceDraft& draft) {
  draft.made.regions.push_back({"fluid", {}});
  if (!draft.options.solids) return;
  for (const DraftPiece& piece : draft.pieces) draft.made.regions.push_back({"spheres", piece.piece.sphere});
  draft.made.regions.insert(draft.made.regions.end(), draft.necks.size(), MeshRegion{"bridges", {}});
}

void state(SurfaceDraft& draft) {
  ConformingSurface& made = draft.made;
  SurfaceStatement& statement = made.statement;
  double least = std::numbers::pi, off_necks = std::numbers::pi;
  double edge = std::numeric_limits<double>::infinity(), six = 0;
  const Vector<3> middle = bounds_of(draft.solids.domain).center();
  for (std::size_t t = 0; t < made.triangles.size(); ++t) {
    const FaceCorners& corners = made.triangles[t];
    const Vector<3>&a = made.vertices[corners[0]], &b = made.vertices[corners[1]],
          &c = made.vertices[corners[2]];
    const SurfacePatch& patch = made.patches[made.patch[t]];
    const double angle = least_angle(a, b, c);
    if (angle < least) {
      least = angle;
      statement.place_of_least_angle = (a + b + c) / 3;
    }
    if (patch.kind != SurfacePatch::Kind::neck) off_necks = std::min(off_necks, angle);
    edge = std::min({edge, (b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double volume = (a - middle).dot((b - middle).cross(c - middle));
    if (patch.regions[0] == 0) six += volume;
    if (patch.regions[1] == 0) six -= volume;
  }
  statement.least_angle = least * 180 / std::numbers::pi;
  statement.least_angle_off_necks = off_necks * 180 / std::numbers::pi;
  statement.least_edge = edge;
  statement.meshed_fluid_volume = six / 6;
  const ContactReport& contacts = draft.solids.contacts;
  const bool is_capped = contacts.treatment == ContactTreatment::cap;
  statement.fluid_volume = volume_of(draft.solids.domain) -
                           (is_capped ? contacts.volume_after : volume_of_balls(draft.solids.spheres));
  if (is_capped) {
    statement.contact_area = contacts.contact_area + draft.deepened.area;
    statement.fluid_volume += draft.deepened.volume;
  }
  std::vector<char> counted(made.necks.size(), 0);
  for (const DraftNeck& neck : draft.necks)
    if (!std::exchange(counted[neck.bond], 1)) statement.fluid_volume -= neck.volume;
}

}  // namespace bernal

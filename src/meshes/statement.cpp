// What is said of a surface beside its triangles.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

/// Distance of a point from everything that bounds the fluid; negative outside of it.
double clearance_at(const SurfaceDraft& draft, const Vector<3>& p) {
  double least = std::min(draft.sizes.from_walls(p), draft.sizes.from_ends(p));
  for (const DraftPiece& piece : draft.pieces)
    least = std::min(least, (p - piece.piece.center).norm() - piece.piece.radius);
  for (const DraftNeck& neck : draft.necks) {
    const Vector<3> d = p - draft.pieces[neck.pieces[0]].piece.center;
    const double along = d.dot(neck.axis);
    if (along > 0 && along < neck.distance)
      least = std::min(least, (d - along * neck.axis).norm() - neck.radius);
  }
  return least;
}

Vector<3> point_in_fluid(const SurfaceDraft& draft) {
  // In front of triangles of spheres and behind those of walls, some hundred of them all over the bed.
  constexpr std::size_t tries = 400;
  const auto& made = draft.made;
  const std::size_t step = std::max<std::size_t>(1, made.triangles.size() / tries);
  Vector<3> best = Vector<3>::Zero();
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < made.triangles.size(); t += step) {
    const FaceCorners& corners = made.triangles[t];
    const Vector<3>&a = made.vertices[corners[0]], &b = made.vertices[corners[1]],
          &c = made.vertices[corners[2]];
    const Vector<3> normal = (b - a).cross(c - a).normalized();
    const double sense = made.patches[made.patch[t]].regions[0] == 0 ? -1 : 1;
    for (const double share : {0.3, 0.8}) {
      const Vector<3> p = (a + b + c) / 3 + sense * share * (b - a).norm() * normal;
      if (const double clear = clearance_at(draft, p); clear > most) {
        most = clear;
        best = p;
      }
    }
  }
  return best;
}

}  // namespace

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
  draft.made.regions.push_back({"fluid", {}, point_in_fluid(draft)});
  if (!draft.options.solids) return;
  for (const DraftPiece& piece : draft.pieces) {
    draft.made.regions.push_back({"spheres", piece.piece.sphere, inner_point(piece.piece)});
  }
  for (const DraftNeck& neck : draft.necks) {
    const Vector<3> from = draft.made.vertices[neck.rims[0][0]], to = draft.made.vertices[neck.rims[1][0]];
    const Vector<3> center = draft.pieces[neck.pieces[0]].piece.center;
    const double along = 0.5 * ((from - center).dot(neck.axis) + (to - center).dot(neck.axis));
    draft.made.regions.push_back({"bridges", {}, center + along * neck.axis});
  }
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
  if (is_capped) statement.contact_area = contacts.contact_area;
  std::vector<char> counted(draft.necks.size(), 0);
  for (const DraftNeck& neck : draft.necks)
    if (!std::exchange(counted[neck.bond], 1)) statement.fluid_volume -= neck.volume;
}

}  // namespace bernal

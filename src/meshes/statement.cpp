// What is said of a surface beside its triangles.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include "bernal/core/dimension.hpp"
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

namespace {

/// The volume of a ball in the domain: of all its images together.
double volume_within(const SurfaceDraft& draft, const Vector<3>& center, double radius) {
  if (!draft.solids.part) return ball_volume(3, radius);
  const std::optional<Piece> piece = piece_in(*draft.solids.part, center, radius);
  return piece ? volume_of(*piece) : 0;
}

/// What necks take of each sphere, and the volume of each neck with that; 0 for images of others.
struct NeckVolumes {
  std::vector<double> of_sphere, of_neck;
};
NeckVolumes neck_volumes(const SurfaceDraft& draft) {
  NeckVolumes made{std::vector<double>(draft.solids.spheres.size(), 0.0), {}};
  std::vector<char> counted(draft.made.necks.size(), 0);
  for (std::uint32_t n = 0; n < draft.necks.size(); ++n) {
    const DraftNeck& neck = draft.necks[n];
    made.of_neck.push_back(0);
    if (std::exchange(counted[neck.bond], 1)) continue;
    made.of_neck[n] = neck.volume;
    for (std::size_t e = 0; e < (neck.wall ? 1u : 2u); ++e) {
      const double r = draft.solids.spheres.r[neck.spheres[e]];
      const double cap = cap_volume(r, r - (e == 0 ? neck.begin : neck.distance - neck.end));
      made.of_neck[n] += cap;
      made.of_sphere[neck.spheres[e]] += cap;
    }
  }
  return made;
}

double volume_of_spheres(const SurfaceDraft& draft) {
  if (!draft.solids.part) return volume_of_balls(draft.solids.spheres);
  double sum = 0;
  for (const Piece& piece : draft.solids.pieces) sum += volume_of(piece);
  return sum;
}

}  // namespace

void add_regions(SurfaceDraft& draft) {
  std::vector<MeshRegion>& regions = draft.made.regions;
  regions.push_back({"fluid", {}});
  if (!draft.options.solids) return;
  const bool is_capped = draft.solids.contacts.treatment == ContactTreatment::cap;
  const NeckVolumes necks = neck_volumes(draft);
  std::set<std::pair<std::uint32_t, std::uint32_t>> counted;
  for (const DraftPiece& piece : draft.pieces) {
    const std::uint32_t sphere = piece.piece.sphere;
    const std::span<const double> shells = draft.solids.shells.of(sphere);
    MeshRegion& region = regions.emplace_back("spheres", sphere);
    if (!shells.empty()) region.layer = piece.layer;
    if (is_capped && piece.is_outer()) continue;
    region.volume = 0;
    if (!counted.insert({sphere, piece.layer}).second) continue;
    const Vector<3>& center = piece.piece.center;
    region.volume = volume_within(draft, center, piece.piece.radius) -
                    (piece.layer > 0 ? volume_within(draft, center, shells[piece.layer - 1]) : 0.0) -
                    (piece.is_outer() ? necks.of_sphere[sphere] : 0.0);
  }
  for (const double volume : necks.of_neck) {
    regions.emplace_back("bridges");
    if (!is_capped) regions.back().volume = volume;
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
  statement.fluid_volume =
      volume_of(draft.solids.domain) - (is_capped ? contacts.volume_after : volume_of_spheres(draft));
  if (is_capped) {
    statement.contact_area = contacts.contact_area + draft.deepened.area;
    statement.fluid_volume += draft.deepened.volume;
  }
  std::vector<char> counted(made.necks.size(), 0);
  for (const DraftNeck& neck : draft.necks)
    if (!std::exchange(counted[neck.bond], 1)) statement.fluid_volume -= neck.volume;
  if (!made.regions.empty()) made.regions.front().volume = statement.fluid_volume;
}

}  // namespace bernal

// Caps whose circles an end of a period would nearly touch or cut at a small angle are cut off deeper.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "measure/touching.hpp"
#include "meshes/surface_draft.hpp"

namespace bernal {
namespace {

using std::numbers::pi;

class CapDepths {
 public:
  explicit CapDepths(SurfaceDraft& draft) : draft_(draft) {}

  void deepen() {
    for (DraftPiece& piece : draft_.pieces)
      for (Cut& cut : piece.piece.cuts) {
        if (cut.face != Cut::contact) continue;
        const double depth = cut.keeps.offset - cut.keeps.normal.dot(piece.piece.center);
        const auto [entry, is_new] = caps_.try_emplace(key_of(piece.piece.sphere, cut.keeps.normal));
        if (is_new) entry->second = cap_of(piece.piece, cut.keeps.normal, depth);
        if (entry->second.depth < entry->second.before)
          cut.keeps.offset -= entry->second.before - entry->second.depth;
      }
    state();
  }

 private:
  using Key = std::pair<std::uint32_t, std::array<double, 3>>;
  struct Cap {
    double radius = 0;  ///< of the sphere
    double before = 0, depth = 0;
    bool faces_another = false;
    double area(double at) const { return pi * (radius * radius - at * at); }
  };
  static Key key_of(std::uint32_t sphere, const Vector<3>& n) { return {sphere, {n[0], n[1], n[2]}}; }

  Cap cap_of(const Piece& piece, const Vector<3>& normal, double depth) const {
    // Radii of circles that are tried, the nearest first.
    constexpr std::array<double, 9> wider = {1, 1.08, 1.16, 1.25, 1.35, 1.45, 1.55, 1.65, 1.8};
    const double r = piece.radius, a = std::sqrt(std::max(0.0, r * r - depth * depth));
    const double edge = 2 * draft_.options.per_gap * draft_.solids.contacts.gap * r;
    Cap cap{.radius = r, .before = depth, .depth = depth};
    double most = -1;
    for (const double share : wider) {
      const double wide = share * a;
      if (!(depth > 0 && wide < 0.6 * r)) break;
      const double clearance =
          clearance_of_ends(draft_.boundary, piece.center, r, normal, wide, std::min(edge, pi / 4 * a));
      if (clearance <= most) continue;
      most = clearance;
      cap.depth = share > 1 ? std::sqrt(r * r - wide * wide) : depth;
      if (clearance >= 1) break;
    }
    return cap;
  }

  /// What deeper caps add to the volume of the fluid and to flat faces: of two that face each other the
  /// smaller counts.
  void state() {
    for (const NearBond& bond :
         near_bonds(draft_.solids.spheres, draft_.solids.domain, draft_.solids.contacts.gap)) {
      const Vector<3> direction = bond.displacement.normalized();
      const auto one = caps_.find(key_of(bond.first, direction)),
                 other = caps_.find(key_of(bond.second, -direction));
      if (one == caps_.end() || other == caps_.end()) continue;
      Cap &a = one->second, &b = other->second;
      a.faces_another = b.faces_another = true;
      draft_.deepened.area +=
          std::min(a.area(a.depth), b.area(b.depth)) - std::min(a.area(a.before), b.area(b.before));
    }
    for (const auto& [key, cap] : caps_) {
      if (!(cap.depth < cap.before)) continue;
      ++draft_.made.statement.deepened_caps;
      draft_.deepened.volume +=
          cap_volume(cap.radius, cap.radius - cap.depth) - cap_volume(cap.radius, cap.radius - cap.before);
      if (!cap.faces_another) draft_.deepened.area += cap.area(cap.depth) - cap.area(cap.before);
    }
  }

  SurfaceDraft& draft_;
  std::map<Key, Cap> caps_;
};

}  // namespace

void deepen_caps(SurfaceDraft& draft) {
  if (draft.boundary.repeats() && draft.solids.contacts.treatment == ContactTreatment::cap)
    CapDepths(draft).deepen();
}

}  // namespace bernal

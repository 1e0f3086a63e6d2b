#include "meshes/neck_bonds.hpp"

#include <cmath>
#include <set>

#include "meshes/wall_views.hpp"

namespace bernal {
namespace {

class NeckBonds {
 public:
  explicit NeckBonds(const SurfaceDraft& draft)
      : draft_(draft), solids_(draft.solids), spheres_(solids_.spheres.in<3>()) {}

  std::vector<NeckBond> found() {
    if (!joins(solids_.contacts.treatment)) return {};
    between_spheres();
    if (draft_.flat_walls) {
      at_flat_walls();
    } else {
      at_walls();
    }
    return std::move(bonds_);
  }

 private:
  void add(NeckBond bond) {
    const double share = solids_.bridge_radius, angle = solids_.bridge_angle;
    bond.is_fillet = solids_.contacts.treatment == ContactTreatment::fillet;
    bond.asked = bond.radius =
        angle > 0 ? radius_for_angle(bond.ends, angle, bond.is_fillet) : share * bond.ends.least_radius();
    bonds_.push_back(bond);
  }

  void between_spheres() {
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::array<int, 3>>> known;
    const Boundary<3>& boundary = draft_.boundary;
    for (const Bridge& bridge : solids_.bridges) {
      NeckBond bond;
      bond.spheres = bridge.spheres;
      const Vector<3> along = (bridge.rims[1] - bridge.rims[0]).normalized();
      std::array<std::array<int, 3>, 2> image{};
      for (std::size_t e = 0; e < 2; ++e) {
        const double r = spheres_.r[bridge.spheres[e]];
        const double depth = std::sqrt(r * r - bridge.radius * bridge.radius);
        const Vector<3> at = bridge.rims[e] + (e == 0 ? -depth : depth) * along -
                             Vector<3>(spheres_.center(bridge.spheres[e]));
        for (int k = 0; k < 3; ++k)
          if (boundary.repeats(k))
            image[e][static_cast<std::size_t>(k)] =
                static_cast<int>(std::nearbyint(at[k] / boundary.edges[k]));
      }
      Vector<3> between = spheres_.center(bond.spheres[1]) - spheres_.center(bond.spheres[0]);
      for (int k = 0; k < 3; ++k) {
        const auto axis = static_cast<std::size_t>(k);
        bond.step[axis] = image[1][axis] - image[0][axis];
        between[k] += bond.step[axis] * boundary.edges[k];
      }
      if (!known.insert({bond.spheres[0], bond.spheres[1], bond.step}).second) continue;
      bond.ends = {spheres_.r[bond.spheres[0]], spheres_.r[bond.spheres[1]], between.norm()};
      bond.axis = between / bond.ends.distance;
      add(bond);
    }
  }

  void at_walls() {
    for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.r[i];
      for (const WallSheet& view : walls_around(solids_.domain, spheres_.center(i))) {
        if (view.distance - r >= solids_.contacts.gap * r) continue;
        add({.spheres = {i, i}, .wall = view.wall, .axis = view.outward, .ends = {r, {}, view.distance}});
      }
    }
  }

  void at_flat_walls() {
    const PlanarWalls& walls = *draft_.flat_walls;
    const FlatFeet feet(std::get<Mesh>(solids_.domain), walls, draft_.sizes.container());
    for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
      const double r = spheres_.r[i];
      const Vector<3> c = spheres_.center(i);
      for (const FlatFeet::Foot& foot : feet.near(c, r, (1 + solids_.contacts.gap) * r)) {
        const FlatPart& part = walls.parts[foot.part];
        add({.spheres = {i, i},
             .wall = foot.part,
             .axis = part.outward,
             .ends = {r, {}, (part.origin - c).dot(part.outward)}});
        NeckBond& bond = bonds_.back();
        bond.room = FlatFeet::radius_in(foot, bond.shape(bond.asked).rims[1], draft_.options.neck_edge * r);
      }
    }
  }

  const SurfaceDraft& draft_;
  const Solids& solids_;
  Spheres<3> spheres_;
  std::vector<NeckBond> bonds_;
};

}  // namespace

std::vector<NeckBond> neck_bonds_of(const SurfaceDraft& draft) { return NeckBonds(draft).found(); }

}  // namespace bernal

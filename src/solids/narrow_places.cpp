#include "solids/narrow_places.hpp"

#include <algorithm>
#include <cmath>

#include "bernal/cad/mesh_container.hpp"
#include "measure/touching.hpp"
#include "near/point_grid.hpp"

namespace bernal {
namespace {

class Places {
 public:
  Places(const Solids& solids, double per_radius, double per_gap)
      : solids_(solids),
        boundary_(boundary_of<3>(solids.domain)),
        per_radius_(per_radius),
        per_gap_(per_gap) {}

  std::vector<NarrowPlace> made() && { return std::move(places_); }
  /// The widest gap between two spheres that needs smaller elements, over the sum of their radii.
  double widest() const { return 0.5 * per_radius_ / per_gap_; }

  /// The width is g + curvature d², with curvature 1/r.
  void add(const Vector<3>& point, const Vector<3>& normal, double gap, double curvature, double radius) {
    const double beside = per_radius_ * radius, wide = beside / per_gap_ - gap;
    if (!(wide > 0)) return;
    constexpr double finest = 1. / 30;
    NarrowPlace place{.point = point,
                      .normal = normal,
                      .reach = std::sqrt(wide / curvature),
                      .size = std::max(per_gap_ * gap, finest * beside),
                      .size_beside = beside};
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b)
        for (int c = -1; c <= 1; ++c) add_image(place, Vector<3>(a, b, c));
  }

 private:
  void add_image(NarrowPlace place, const Vector<3>& moved) {
    for (int k = 0; k < 3; ++k) {
      if (!boundary_.repeats(k)) {
        if (moved[k] != 0) return;
        continue;
      }
      place.point[k] += moved[k] * boundary_.edges[k];
      const double beyond = place.point[k] - boundary_.origin[k];
      if (beyond < -place.reach || beyond > boundary_.edges[k] + place.reach) return;
    }
    places_.push_back(place);
  }

  const Solids& solids_;
  Boundary<3> boundary_;
  double per_radius_, per_gap_;
  std::vector<NarrowPlace> places_;
};

void add_between_spheres(const Solids& solids, Places& places) {
  const Spheres<dynamic>& spheres = solids.spheres;
  for (const NearBond& near : near_bonds(spheres, solids.domain, places.widest())) {
    const double ri = spheres.r[near.first], rj = spheres.r[near.second];
    const Vector<3> normal = near.displacement.normalized();
    const double gap = near.gap * (ri + rj);
    const Vector<3> point = Vector<3>(spheres.center(near.first)) + (ri + 0.5 * gap) * normal;
    places.add(point, normal, gap, 0.5 * (1 / ri + 1 / rj), std::min(ri, rj));
  }
}

void add_at_walls(const Solids& solids, Places& places) {
  if (!has_walls(solids.domain)) return;
  const Frame frame = frame_of(solids.domain);
  const auto container = local_container(solids.domain, nullptr);
  std::vector<WallPoint> points;
  for (std::size_t i = 0; i < solids.spheres.size(); ++i) {
    const double r = solids.spheres.r[i];
    const Vector<3> c = solids.spheres.center(i);
    points.clear();
    container->walls_near(frame.to_local(c), (1 + 2 * places.widest()) * r / frame.scale, points);
    for (const WallPoint& point : points)
      places.add(frame.to_scene(point.point), point.inward, std::max(0.0, point.clearance * frame.scale - r),
                 0.5 / r, r);
  }
}

/// Where an end of a period nearly touches a sphere there is a thin cap on one side, a thin gap on the other.
void add_at_ends(const Solids& solids, Places& places) {
  const Boundary<3> boundary = boundary_of<3>(solids.domain);
  for (std::size_t i = 0; i < solids.spheres.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      if (!boundary.repeats(k)) continue;
      const double r = solids.spheres.r[i];
      Vector<3> point = solids.spheres.center(i);
      for (const double end : {boundary.origin[k], boundary.origin[k] + boundary.edges[k]}) {
        const double from_end =
            std::abs(std::abs(solids.spheres.x[static_cast<std::size_t>(k)][i] - end) - r);
        point[k] = end;
        places.add(point, Vector<3>::Unit(k), from_end, 0.5 / r, r);
      }
    }
}

/// Gives boxes that may overlap different layers, the finest first.
void spread(std::vector<NarrowPlace>& places) {
  if (places.empty()) return;
  std::ranges::stable_sort(places, {}, &NarrowPlace::size);
  Spheres<3> points;
  double largest = 0;
  for (const NarrowPlace& place : places) {
    largest = std::max(largest, 1.5 * place.reach);
    points.push_back(place.point, 1.5 * place.reach);
  }
  const PointGrid<3> grid(points, Boundary<3>{}, 2 * largest);
  for (std::uint32_t i = 0; i < places.size(); ++i) {
    std::array<bool, NarrowPlace::most_layers> taken{};
    grid.for_each_near(places[i].point, points.r[i] + largest, [&](std::uint32_t j, const Vector<3>& d) {
      if (j < i && d.norm() < points.r[i] + points.r[j])
        taken[static_cast<std::size_t>(places[j].layer)] = true;
    });
    int& layer = places[i].layer;
    while (layer + 1 < NarrowPlace::most_layers && taken[static_cast<std::size_t>(layer)]) ++layer;
  }
}

}  // namespace

std::vector<NarrowPlace> narrow_places_of(const Solids& solids, double per_radius, double per_gap) {
  Places places(solids, per_radius, per_gap);
  add_between_spheres(solids, places);
  add_at_walls(solids, places);
  add_at_ends(solids, places);
  std::vector<NarrowPlace> made = std::move(places).made();
  spread(made);
  return made;
}

}  // namespace bernal

#include "plan/room_for_gaps.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/rounding.hpp"
#include "domain/inset_container.hpp"
#include "sizes/enlarged.hpp"

namespace bernal {
namespace {

/// How far inside the walls stand for spheres with half the gap around them.
double walls_moved_by(const Scene& scene) { return sum_rounded_up(scene.wall_gap, -coat_of(scene)); }

bool has_wall(const Scene& scene, int axis) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  return box && std::ranges::find(box->walls, axis) != box->walls.end();
}

/// Of a box that follows from its packing only the proportions are known before something is expected of it.
bool has_size(const Plan& plan) {
  const auto* box = std::get_if<PeriodicBox>(&plan.scene.container);
  return !box || !box->scalable || plan.box_follows;
}

/// A periodic box keeps its origin at zero.
Domain region_of(const Plan& plan) {
  const double margin = margin_of(plan.domain);
  const bool as_it_is =
      (plan.scene.wall_gap == coat_of(plan.scene) && margin == 0) || !has_walls(plan.domain);
  if (as_it_is || !has_size(plan)) return plan.domain;
  Domain region = with_walls_moved(plan.domain, sum_rounded_up(walls_moved_by(plan.scene), margin));
  if (plan.scene.is_periodic()) std::get<Box>(region).corner = std::get<Box>(plan.domain).corner;
  return region;
}

/// Of facets that of the domain, where there is one, as it is dear; others are not.
std::shared_ptr<const Container> container_of(const Domain& region, const Plan& plan) {
  const auto moved = [&](const auto& shape) -> std::shared_ptr<const Container> {
    if (shape.inset == 0) return plan.container;
    const double unit = frame_of(plan.domain).scale;
    return make_inset_container(plan.container, shape.inset / unit,
                                volume_of(region) / std::pow(unit, dimension_of(region)));
  };
  if (!plan.container) return nullptr;
  if (const auto* mesh = std::get_if<Mesh>(&region)) return moved(*mesh);
  if (const auto* polygon = std::get_if<Polygon>(&region)) return moved(*polygon);
  if (const auto* revolved = std::get_if<Revolved>(&region)) return moved(*revolved);
  return nullptr;
}

/// The share of their volume fraction that packed spheres have without their coats: mean volume over mean
/// volume, times that of the region over the domain's.
double share_without_coats(const Plan& plan, const Plan& with_room) {
  const int dimension = plan.scene.dimension();
  const double share = plan.radii->moment(dimension) / with_room.radii->moment(dimension);
  return has_size(plan) ? share * volume_of(with_room.domain) / volume_of(plan.domain) : share;
}

/// The edges of a box of the same proportions, within which the region has as much volume as those span.
Vector<dynamic> box_as_roomy_as(const Scene& scene, const Vector<dynamic>& edges) {
  if (edges_within(scene, edges) == edges) return edges;
  constexpr int halvings = 100;
  double low = 0, high = 1;
  const auto has_room = [&](double times) {
    const Vector<dynamic> within = edges_within(scene, times * edges);
    return within.minCoeff() > 0 && within.prod() >= edges.prod();
  };
  while (!has_room(high)) high *= 2;
  for (int k = 0; k < halvings; ++k) (has_room(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return high * edges;
}

StartSpheres with_coats(StartSpheres start, const Scene& scene) {
  for (double& r : start.spheres.r) r = sum_rounded_up(r, coat_of(scene));
  if (start.edges.size() > 0) start.edges = edges_within(scene, start.edges);
  for (int k = 0; k < start.edges.size(); ++k)
    if (has_wall(scene, k))
      for (double& x : start.spheres.x[static_cast<std::size_t>(k)]) x -= walls_moved_by(scene);
  return start;
}

}  // namespace

double shift_of(const Scene& scene) { return scene.is_periodic() ? walls_moved_by(scene) : 0; }

Vector<dynamic> edges_around(const Scene& scene, const Vector<dynamic>& packed) {
  const double by = walls_moved_by(scene);
  Vector<dynamic> edges = packed;
  for (int k = 0; k < edges.size(); ++k)
    if (has_wall(scene, k)) edges[k] = sum_rounded_up(sum_rounded_up(edges[k], by), by);
  return edges;
}

Vector<dynamic> edges_within(const Scene& scene, const Vector<dynamic>& box) {
  const double by = walls_moved_by(scene);
  Vector<dynamic> edges = box;
  for (int k = 0; k < edges.size(); ++k)
    if (has_wall(scene, k)) edges[k] = sum_rounded_down(sum_rounded_down(edges[k], -by), -by);
  return edges;
}

void require_gaps(const Plan& plan) {
  const Scene& scene = plan.scene;
  const auto fail = [&](std::string_view key, const std::string& why) {
    throw Error(ErrorCode::bad_scene, fmt::format("\"{}\" in [spheres] {}", key, why),
                scene.locations.of(key));
  };
  if (scene.overlap > 0)
    fail(scene.gap > 0 ? "gap" : "wall_gap",
         "and an \"overlap\" in [accuracy] exclude each other: give one of them");
  if (scene.wall_gap > 0 && !has_walls(plan.domain))
    fail("wall_gap", fmt::format("would be without effect: the {} has no walls", name_of(plan.domain)));
  if (!has_size(plan)) return;
  const double width = bounds_of<dynamic>(plan.domain).size().maxCoeff();
  for (const auto& [key, gap] : {std::pair("gap", scene.gap), std::pair("wall_gap", scene.wall_gap)})
    if (gap >= width)
      fail(key, fmt::format("of {:.6g} {} is no less than the {} is wide, {:.6g} {}: use a smaller one or "
                            "check the units",
                            gap, name_of(scene.unit), name_of(plan.domain), width, name_of(scene.unit)));
}

Plan plan_with_room(const Plan& plan) {
  Plan with_room;
  with_room.scene = plan.scene;
  with_room.domain = region_of(plan);
  with_room.container = container_of(with_room.domain, plan);
  with_room.box_follows = plan.box_follows;
  with_room.start = with_coats(plan.start, plan.scene);
  with_room.radii = std::make_unique<Enlarged>(*plan.radii, coat_of(plan.scene));
  const double share = share_without_coats(plan, with_room);
  if (auto& phi = with_room.scene.target.packing_fraction) *phi /= share;
  if (double& height = with_room.scene.target.bed.above_ground;
      height > 0)  // of the coats, above the region's
    height = std::max(height + plan.scene.gap - plan.scene.wall_gap, 2 * with_room.radii->min());
  with_room.attainable_packing_fraction = plan.attainable_packing_fraction / share;
  with_room.expected_packing_fraction = plan.expected_packing_fraction / share;
  with_room.expected_count = plan.expected_count;
  with_room.places_expected = plan.places_expected;
  return with_room;
}

void take_expectations(Plan& plan, const Plan& with_room) {
  plan.box_follows = with_room.box_follows;
  if (plan.box_follows) {
    Box& box = std::get<Box>(plan.domain);
    const Box& other = std::get<Box>(with_room.domain);
    box.size = box_as_roomy_as(plan.scene, other.size);
    box.tilt = tilt_in_proportion(other, box.size);
  }
  const double share = share_without_coats(plan, with_room);
  plan.attainable_packing_fraction = share * with_room.attainable_packing_fraction;
  plan.expected_packing_fraction = share * with_room.expected_packing_fraction;
  Target& target = plan.scene.target;
  if (target.predicted)  // in as many digits as there
    target.packing_fraction =
        std::max(1e-4, std::floor(1e4 * share * *with_room.scene.target.packing_fraction) / 1e4);
  if (target.packing_fraction)
    plan.expected_packing_fraction = std::min(plan.expected_packing_fraction, *target.packing_fraction);
  plan.expected_count = with_room.expected_count;
  plan.expected_seconds = with_room.expected_seconds;
  plan.expected_memory_bytes = with_room.expected_memory_bytes;
  plan.places_expected = with_room.places_expected;
  plan.items = with_room.items;
  plan.absent = with_room.absent;
  if (plan.caution.empty()) plan.caution = with_room.caution;
  plan.scene.draw = with_room.scene.draw;
  target.count = with_room.scene.target.count;
  target.mass = with_room.scene.target.mass;
  target.mass_counted = with_room.scene.target.mass_counted;
}

}  // namespace bernal

#include "plan/plan_zones.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "domain/volume_below.hpp"
#include "plan/made_plan.hpp"
#include "plan/places_of_zones.hpp"
#include "scene/stage_table.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

/// What is told of the whole in place of what each part tells.
void add_items(Plan& whole, const Plan& part) {
  for (const PlanItem& item : part.items) {
    const auto same = std::ranges::find(whole.items, item.name, &PlanItem::name);
    if (same == whole.items.end()) {
      whole.items.push_back(item);
    } else {
      same->seconds += item.seconds;
      same->bytes = std::max(same->bytes, item.bytes);
      same->if_needed = same->if_needed && item.if_needed;
    }
  }
}

/// What is true of every part once, the rest with the name of its part.
void add_hints(Plan& whole, const std::vector<SphereClass>& classes) {
  const auto has = [](const Plan& plan, const std::string& hint) {
    return std::ranges::find(plan.hints, hint) != plan.hints.end();
  };
  for (const PlannedPart& part : whole.parts)
    for (const std::string& hint : part.plan.hints) {
      const bool is_of_all =
          std::ranges::all_of(whole.parts, [&](const PlannedPart& each) { return has(each.plan, hint); });
      std::string told = is_of_all ? hint : fmt::format("{}: {}", classes[part.sphere_class].name, hint);
      if (!has(whole, told)) whole.hints.push_back(std::move(told));
    }
}

/// What a scene says of an amount, once its plan has made a count of a mass.
void take_amount(Scene& said, const Scene& planned) {
  said.draw = planned.draw;
  said.target.count = planned.target.count;
  said.target.mass = planned.target.mass;
  said.target.mass_counted = planned.target.mass_counted;
}

/// The parts as one plan.
void sum_up(Plan& whole) {
  const double volume = volume_of(whole.domain);
  std::vector<std::unique_ptr<SizeDistribution>> radii;
  std::vector<double> counts;
  const std::vector<SphereClass> classes = classes_of(whole.scene);
  whole.absent = whole.parts.front().plan.absent;
  for (const PlannedPart& part : whole.parts) {
    const Plan& plan = part.plan;
    const double share = volume_of(plan.domain) / volume;
    whole.expected_count += plan.expected_count;
    whole.expected_packing_fraction += share * plan.expected_packing_fraction;
    whole.expected_seconds += plan.expected_seconds;
    whole.expected_memory_bytes = std::max(whole.expected_memory_bytes, plan.expected_memory_bytes);
    whole.places_expected = whole.places_expected || plan.places_expected;
    if (whole.caution.empty() && !plan.caution.empty())
      whole.caution = fmt::format("{}: {}", classes[part.sphere_class].name, plan.caution);
    add_items(whole, plan);
    std::erase_if(whole.absent, [&](const std::string& effect) {
      return std::ranges::find(plan.absent, effect) == plan.absent.end();
    });
    radii.push_back(radii_of(plan.scene));
    counts.push_back(std::max(1.0, plan.expected_count));
    const bool is_zone = part.sphere_class < whole.scene.zones.size();
    take_amount(is_zone ? whole.scene.zones[part.sphere_class].spheres : whole.scene, plan.scene);
  }
  add_hints(whole, classes);
  whole.attainable_packing_fraction = whole.expected_packing_fraction;
  whole.radii = radii.size() == 1 ? std::move(radii.front())
                                  : make_mixture(std::move(radii), std::move(counts), Basis::number);
  if (!whole.scene.draw) whole.scene.draw = Draw::random;
}

/// A plan that fails says of which zone.
Plan plan_of_part(const Scene& whole, std::uint32_t sphere_class, const Scene& scene,
                  const PlaceOfPlan& place) {
  try {
    return made_plan(scene, &place);
  } catch (const Error& error) {
    if (sphere_class >= whole.zones.size()) throw;
    const Zone& zone = whole.zones[sphere_class];
    throw Error(error.code(), fmt::format("{}: {}", name_of_zone(whole, sphere_class), error.message()),
                zone.spheres.locations.whole.line > 0 ? zone.spheres.locations.whole : error.location());
  }
}

Scene scene_of_class(const Scene& whole, std::uint32_t sphere_class) {
  return sphere_class < whole.zones.size() ? scene_of_zone(whole, whole.zones[sphere_class])
                                           : scene_of_rest(whole);
}

/// The stages with what they are told of spheres in a bed alone: a part of a periodic box has walls.
void keep_what_acts_in_bed(std::vector<Stage>& stages) {
  for (Stage& stage : stages) {
    const StageTable& table = table_of(stage);
    Stage made = table.make();
    made.locations = stage.locations;
    for (const schema::Key& key : table.keys.keys)
      if (const auto value = key.of(table.options(stage)); value && key.acts_here(true))
        key.member.set(table.options_of(made), *value);
    stage = std::move(made);
  }
}

/// A box that repeats itself along some axes begins at zero along these.
Vector<3> move_to_origin(Scene& scene, Domain& domain) {
  auto* periodic = std::get_if<PeriodicBox>(&scene.container);
  if (!periodic) return Vector<3>::Zero();
  keep_what_acts_in_bed(scene.stages);
  Box& box = std::get<Box>(domain);
  const Vector<3> shift = box.corner;
  box.corner = Vector<3>::Zero();
  periodic->size.assign(box.size.begin(), box.size.end());
  periodic->edge.reset();
  periodic->walls.clear();
  for (int k = 0; k < 3; ++k)
    if (box.has_wall(k)) periodic->walls.push_back(k);
  return shift;
}

void plan_compartments(Plan& whole) {
  for (PlaceOfZone& place : places_of_zones(whole.scene, whole.domain)) {
    Scene scene = scene_of_class(whole.scene, place.sphere_class);
    PlannedPart part{.sphere_class = place.sphere_class};
    part.shift = move_to_origin(scene, place.domain);
    if (whole.scene.is_periodic() && whole.hints.empty())
      whole.hints.push_back(
          "along an axis across which zones lie the box does not repeat itself: a part ends where the period "
          "begins");
    part.plan = plan_of_part(whole.scene, place.sphere_class, scene, {std::move(place.domain)});
    whole.parts.push_back(std::move(part));
  }
}

/// What a layer is expected to hold is less than its sizes would from the ground up.
void expect_above(Plan& plan, double share) {
  plan.expected_count *= share;
  plan.expected_packing_fraction *= share;
  plan.expected_seconds *= share;
  plan.expected_bed.reset();
  for (PlanItem& item : plan.items) item.seconds *= share;
}

void plan_layers(Plan& whole) {
  const VolumeBelow below(whole.domain, down_in(whole.scene));
  PlaceOfPlan place{whole.domain};
  double laid = 0, ground = 0;  // of the container, by the layers so far, and how high they are
  for (const LayerOfZone& layer : layers_of_zones(whole.scene, below.lowest(), below.highest())) {
    PlannedPart part{
        .sphere_class = layer.sphere_class, .on_others = !whole.parts.empty(), .level = layer.level};
    Scene scene = scene_of_class(whole.scene, layer.sphere_class);
    if (layer.level) {
      scene.target.bed.height = layer.level;
      scene.target.bed.layers.reset();
      scene.target.bed.top.reset();
    }
    part.plan = plan_of_part(whole.scene, layer.sphere_class, scene, place);
    place.container = part.plan.container;
    const double above = part.plan.scene.target.bed.above_ground;
    if (part.on_others && above > 0 && above <= ground)
      throw Error(
          ErrorCode::bad_scene,
          fmt::format("a bed that is {:g} {} high ends within the layers below it, which are {:g} high",
                      above, name_of(whole.scene.unit), ground),
          whole.scene.target.where);
    ground = std::max(ground, above);
    const double holds = below(above > 0 ? below.lowest() + above : below.highest());
    const bool is_counted = part.plan.scene.target.count.has_value();
    if (part.on_others && !is_counted) expect_above(part.plan, std::max(0.0, 1 - laid / holds));
    const double solid = part.plan.expected_packing_fraction * volume_of(whole.domain);
    laid = above > 0 ? holds : laid + solid / part.plan.attainable_packing_fraction;
    whole.parts.push_back(std::move(part));
  }
  whole.container = place.container;
}

}  // namespace

Plan plan_of_zones(const Scene& stated) {
  Plan whole;
  whole.scene = stated;
  complete(whole.scene);
  whole.domain = domain_of(whole.scene, whole.container_notes, whole.caution);
  lays_zones(whole.scene) && !has_own_domains(whole.scene) ? plan_layers(whole) : plan_compartments(whole);
  sum_up(whole);
  return whole;
}

Plan plan_of_layer(const Plan& whole, const PlannedPart& part, const Spheres<dynamic>& below) {
  Scene scene = part.plan.scene;
  auto start = std::make_shared<Packing>();
  start->scene.unit = scene.unit;
  start->scene.container = scene.container;
  start->spheres = below;
  scene.start = {.file = "the layers below", .packing = std::move(start)};
  scene.layers.clear();  // the spheres below, which come first, have others
  if (scene.target.count) *scene.target.count += static_cast<std::int64_t>(below.size());
  const PlaceOfPlan place{part.plan.domain, part.plan.container};
  return plan_of_part(whole.scene, part.sphere_class, scene, place);
}

}  // namespace bernal

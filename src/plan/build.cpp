#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/cad/mesh_container.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/voxels/voxels.hpp"
#include "engine/engine_plan.hpp"
#include "plan/caution.hpp"
#include "plan/count_mass.hpp"
#include "plan/estimate.hpp"
#include "plan/fitting.hpp"
#include "plan/hints.hpp"
#include "plan/made_plan.hpp"
#include "plan/price_effects.hpp"
#include "plan/requirements.hpp"
#include "plan/room_for_gaps.hpp"
#include "plan/sizes_at_hand.hpp"
#include "plan/stages.hpp"
#include "plan/start.hpp"
#include "scene/output_table.hpp"
#include "sizes/cut_above.hpp"
#include "sizes/volume_carriers.hpp"
#include "work/bed.hpp"

namespace bernal {
namespace {

/// To check that spheres of a start are free of overlap and to give them their places.
constexpr double seconds_a_placed = 1e-6;

/// Of so many spheres as are asked for: those of the start, and others that are drawn from these.
double volume_of_count(const Plan& plan, const SizeDistribution& radii) {
  const int dimension = plan.scene.dimension();
  const Spheres<dynamic>& there = plan.start.spheres;
  const auto drawn = static_cast<double>(*plan.scene.target.count - static_cast<std::int64_t>(there.size()));
  double volume = drawn * ball_volume(dimension, 1) * radii.moment(dimension);
  for (const double r : there.r) volume += ball_volume(dimension, r);
  return volume;
}

double mean_volume_of(const Plan& plan, const SizeDistribution& radii) {
  if (!plan.start.spheres.empty() && plan.scene.target.count)
    return volume_of_count(plan, radii) / static_cast<double>(*plan.scene.target.count);
  return ball_volume(plan.scene.dimension(), 1) * radii.moment(plan.scene.dimension());
}

/// Puts a number where the scene says "predicted": what its stages are likely to reach less the error of that
/// expectation, so that it is reached, and rounded down to what a reader can take in.
void resolve_predicted(Plan& plan) {
  Target& target = plan.scene.target;
  if (!target.predicted) return;
  if (plan.scene.dimension() != 3)
    throw Error(ErrorCode::bad_scene,
                fmt::format("packing fractions are predicted in three dimensions, not in {}; give \"packing_"
                            "fraction\" as a number",
                            plan.scene.dimension()),
                target.where);
  const double expected = plan.attainable_packing_fraction;
  const double surely = std::max(
      0.5 * expected, expected - error_of_expectation(plan.scene, plan.domain, *plan.radii, expected));
  target.packing_fraction = std::max(1e-4, std::floor(1e4 * surely) / 1e4);
}

/// A container that says what is wrong with it is where the scene names it.
template <class Ask>
auto ask_container(const Plan& plan, const Ask& ask) {
  try {
    return ask();
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(ErrorCode::bad_scene, error.what(), plan.scene.container.locations.whole);
  }
}

/// Null where nothing is above.
std::unique_ptr<SizeDistribution> cut_above(const SizeDistribution& radii, double cut) {
  return cut < radii.max() ? std::make_unique<CutAbove>(radii, cut) : nullptr;
}

/// As what is only estimated needs it: exact arithmetic it does not.
std::shared_ptr<const Container> container_of(const Plan& plan) {
  const bool exact = plan.scene.walls == WallArithmetic::exact;
  return ask_container(plan, [&] {
    return make_local_container(plan.domain, frame_of(plan.domain),
                                exact ? WallArithmetic::plain : plan.scene.walls);
  });
}

/// How the radii are taken from their distribution, where the scene does not say. It is the plan's count and
/// no seed that decides.
void choose_draw(Plan& plan, const SizeDistribution& radii) {
  if (plan.scene.draw) return;
  const double drawn = plan.expected_count - static_cast<double>(plan.start.spheres.size());
  plan.scene.draw = usual_draw(radii, drawn, plan.scene.dimension());
}

void expect_in_container(Plan& plan) {
  const Scene& scene = plan.scene;
  const Domain& container = plan.domain;
  const bool exact = scene.walls == WallArithmetic::exact;
  std::shared_ptr<const Container> made = plan.container;
  // Far from the origin nothing can be told apart, and then nothing fits.
  if (std::holds_alternative<Revolved>(container)) frame_for(scene, container, *plan.radii);
  require_fitting(scene, container, made, plan.radii->min());
  const bool has_limit = std::visit(
      [](const auto& kind) {
        return requires { kind.max; };
      },
      scene.sizes);
  if (const double largest = largest_to_fit(plan); std::isfinite(largest))
    require_fitting(scene, container, made, largest,
                    has_limit ? "give the sizes a \"max\" of that, use smaller ones" : "use smaller ones");
  frame_for(scene, container, *plan.radii);
  if (!made) made = container_of(plan);
  plan.container = exact ? nullptr : made;
  const double cut = tail_cut(scene, container, *plan.radii, made);
  const std::unique_ptr<SizeDistribution> without_tail = cut_above(*plan.radii, cut);
  const SizeDistribution& radii = without_tail ? *without_tail : *plan.radii;
  require_long_periods(scene, container, radii.max());

  count_mass(plan, radii, cut);
  const double mean_volume = mean_volume_of(plan, radii);
  const double volume = volume_of(container);
  double attainable = plan.attainable_packing_fraction =
      ask_container(plan, [&] { return expected_packing_fraction(scene, container, radii, made); });
  // Where nothing is likely to fit, what one sphere would fill: nothing can be divided by an expectation of
  // 0.
  if (!(attainable > 0)) attainable = plan.attainable_packing_fraction = std::min(1.0, mean_volume / volume);
  resolve_predicted(plan);
  if (scene.target.packing_fraction) attainable = std::min(attainable, *scene.target.packing_fraction);
  plan.expected_count = attainable * volume / mean_volume;
  if (scene.target.count)
    plan.expected_count = std::min(plan.expected_count, static_cast<double>(*scene.target.count));
  plan.expected_packing_fraction = plan.expected_count * mean_volume / volume;
  if (!scene.target.packing_fraction) plan.expected_count = std::max(1.0, plan.expected_count);  // one fits
  choose_draw(plan, radii);
}

double rounded_share(double share) {
  int exponent = 0;
  const double mantissa = std::frexp(share, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 44)), exponent - 44);
}

/// What a size means that only gives the proportions of a box: each edge over the longest, to 44 bits. So all
/// sizes in proportion make the same plan, and the one that a run wrote down, rounded, makes that run again.
Vector<dynamic> proportions_of(const Vector<dynamic>& edges) {
  return (edges / edges.maxCoeff()).unaryExpr(&rounded_share);
}

/// The tilt over the longest edge, rounded in the same way.
Tilt tilt_in_proportions(const Box& box) {
  Tilt tilt = box.tilt;
  for (double& length : tilt) length = rounded_share(length / box.size.maxCoeff());
  return tilt;
}

/// That of so many spheres of these sizes as there are likely to be, with those of the start.
double close_packing_at_hand(const Plan& plan, const SizeDistribution& radii) {
  const int dimension = plan.scene.dimension();
  const double without_end = close_packing_fraction(radii, dimension);
  if (dimension != 3 || !plan.scene.draws()) return without_end;
  const std::vector<double>& there = plan.start.spheres.r;
  double drawn = 0;
  if (plan.scene.target.count) {
    drawn = static_cast<double>(*plan.scene.target.count) - static_cast<double>(there.size());
  } else {
    double volume = without_end * volume_of(plan.domain);
    for (const double r : there) volume -= ball_volume(3, r);
    drawn = volume / (ball_volume(3, 1) * radii.moment(3));
  }
  const auto sizes = sizes_at_hand(there, radii, std::max(there.empty() ? 1.0 : 0.0, drawn));
  return sizes ? close_packing_fraction(*sizes, 3) : without_end;
}

/// What the stages are likely to reach: of a box that follows from the packing, in that box, whose walls
/// lower what makes it so large.
double attainable_in_box(const Plan& plan, const SizeDistribution& radii) {
  constexpr int rounds = 5;
  constexpr double least_attainable = 0.05;  // below, the larger ones do not fit into what all would fill
  const Scene& scene = plan.scene;
  const bool between_walls = has_walls(plan.domain) && scene.dimension() == 3 &&
                             any_stage(scene, &StageTraits::reaches, Reaches::close_packing);
  if (!any_in_bed(scene) && !between_walls)
    return gain_of_stages(scene, plan.domain, radii) * close_packing_at_hand(plan, radii);
  if (!plan.box_follows) return expected_packing_fraction(scene, plan.domain, radii);
  Box box = std::get<Box>(plan.domain);
  double attainable = close_packing_fraction(radii, 3);
  for (int k = 0; k < rounds; ++k) {
    const double volume = volume_of_count(plan, radii) / scene.target.packing_fraction.value_or(attainable);
    box.size *= std::cbrt(volume / box.size.prod());
    if (largest_fitting_radius(box) < radii.quantile(0.5)) break;
    const double reached = expected_packing_fraction(scene, box, radii);
    if (reached < least_attainable) break;
    attainable = reached;
  }
  return attainable;
}

void expect_in_periodic_box(Plan& plan) {
  const Scene& scene = plan.scene;
  const int dimension = scene.dimension();
  plan.box_follows = std::get<PeriodicBox>(scene.container).scalable;
  const bool in_bed = any_in_bed(scene);
  const double cut = in_bed ? tail_cut(scene, plan.domain, *plan.radii) : plan.radii->max();
  const std::unique_ptr<SizeDistribution> without_tail = cut_above(*plan.radii, cut);
  const SizeDistribution& radii = without_tail ? *without_tail : *plan.radii;
  if (!plan.box_follows && std::isfinite(cut)) {
    const double allowed = has_walls(plan.domain) ? 0 : scene.overlap;
    require_fitting(scene, plan.domain, plan.container, (1 - allowed) * (in_bed ? cut : plan.radii->min()));
  }
  if (in_bed) require_long_periods(scene, plan.domain, cut);
  count_mass(plan, radii, cut);
  const double mean_volume = mean_volume_of(plan, radii);
  double attainable = plan.attainable_packing_fraction = attainable_in_box(plan, radii);
  resolve_predicted(plan);
  if (scene.target.packing_fraction)
    attainable = std::min(attainable, *scene.target.packing_fraction);
  else if (plan.box_follows)
    attainable = std::min(attainable, reached_by_last(scene));
  if (plan.box_follows) {
    plan.expected_count = static_cast<double>(*scene.target.count);
    Box& box = std::get<Box>(plan.domain);
    Box shape = box;
    shape.size = proportions_of(box.size);
    shape.tilt = tilt_in_proportions(box);
    box.size = shape.size *
               std::pow(plan.expected_count * mean_volume / attainable / shape.size.prod(), 1.0 / dimension);
    box.tilt = tilt_in_proportion(shape, box.size);
  } else {
    plan.expected_count = attainable * volume_of(plan.domain) / mean_volume;
    if (scene.target.count) plan.expected_count = static_cast<double>(*scene.target.count);
  }
  plan.expected_packing_fraction = plan.expected_count * mean_volume / volume_of(plan.domain);
  choose_draw(plan, radii);
}

/// What is there from the start is what can be expected at least.
void expect_start(Plan& plan) {
  const Spheres<dynamic>& spheres = plan.start.spheres;
  if (spheres.empty()) return;
  double volume = 0;
  for (const double r : spheres.r) volume += ball_volume(spheres.dimension(), r);
  const auto n = static_cast<double>(spheres.size());
  if (!plan.box_follows)
    plan.expected_packing_fraction =
        std::max(plan.expected_packing_fraction, volume / volume_of(plan.domain));
  plan.expected_count = std::max(plan.expected_count, n);
  plan.items.push_back({.name = "start",
                        .what = fmt::format("{} spheres that have places", grouped(spheres.size())),
                        .cost = "O(N)",
                        .seconds = seconds_a_placed * n});
}

/// A refusal with what may not be as it is meant with a part, as that may be why: spheres that do not fit
/// into the wall of a vessel are meant for its hollow.
[[noreturn]] void refuse_with_caution(const Error& error, const std::string& caution) {
  throw Error(error.code(), error.message() + "; " + caution, error.location());
}

/// All that is expected of a run, and what it needs for that.
void expect(Plan& plan) {
  const Scene& scene = plan.scene;
  try {
    scene.is_periodic() ? expect_in_periodic_box(plan) : expect_in_container(plan);
  } catch (const Error& error) {
    if (plan.caution.empty()) throw;
    refuse_with_caution(error, plan.caution);
  }
  require_readable_places(plan);
  expect_start(plan);
  plan.places_expected = any_in_bed(scene) && any_stage(scene, &StageTraits::places_expected, true);
  if (plan.caution.empty()) plan.caution = caution_of(plan);
  require_overlap(plan);
  price_effects(plan);
  require_drawable_count(plan);
  require_memory(plan);
  require_fit_for_stages(plan);
}

/// An image that is too large is refused before the run, not after it.
void require_images(const Plan& plan) {
  for (const Output& output : plan.scene.outputs) {
    if (!output.voxel || !table_of(output).keys.find("voxel")) continue;
    try {
      voxel_grid(plan.domain, *output.voxel);
    } catch (const Error& error) {
      throw Error(ErrorCode::bad_scene, error.what(), output.locations.of("voxel"));
    }
  }
}

void expect_with_room(Plan& plan) {
  Plan with_room = plan_with_room(plan);
  expect(with_room);
  take_expectations(plan, with_room);
}

}  // namespace

FillTask fill_task_of(const Plan& plan) {
  constexpr double rare = 1e-4;
  const int dimension = plan.scene.dimension();
  const Target& target = plan.scene.target;
  FillTask task{
      .dimension = dimension,
      .attainable = plan.attainable_packing_fraction / gain_of_stages(plan.scene, plan.domain, *plan.radii),
      .size_ratio = plan.radii->quantile(1 - rare) / plan.radii->quantile(rare),
      .width_of_sizes =
          plan.radii->moment(dimension + 1) / (plan.radii->moment(dimension) * plan.radii->moment(1)),
      .has_walls = has_walls(plan.domain),
      .is_tilted = is_tilted(plan.domain),
      .may_overlap = plan.scene.overlap > 0};
  if (target.packing_fraction)
    task.packing_fraction = *target.packing_fraction;
  else if (target.count)
    task.packing_fraction = volume_of_count(plan, *plan.radii) / volume_of(plan.domain);
  return task;
}

/// As far as is known without expecting anything: what is to fit where.
static Plan begun_plan(const Scene& stated, const PlaceOfPlan* place = nullptr) {
  Plan plan;
  plan.scene = stated;
  complete(plan.scene);
  const Scene& scene = plan.scene;
  require_stage_that_places(scene);
  require_effect_of_accuracy(scene);
  plan.start = read_start(plan.scene);
  if (place)
    plan.domain = place->domain, plan.container = place->container;
  else
    plan.domain = domain_of(plan.scene, plan.container_notes, plan.caution);
  if (scene.engine) engine::require_engine_fits(scene, plan.domain);
  plan.radii = scene.draws() ? radii_of(scene) : radii_there(plan.start.spheres.r);
  set_height_of_bed(plan);
  if (scene.asks_for_gaps()) require_gaps(plan);
  if (is_faceted(plan.domain) && !plan.container)  // what fits into it is asked of it
    plan.container = container_of(plan);
  return plan;
}

static Plan finished(Plan plan) {
  const Scene& scene = plan.scene;
  if (needs_room(plan)) {
    expect_with_room(plan);
    if (plan.scene.target.predicted) {  // again from the number that whoever reads it will have
      plan.scene.target.predicted = false;
      expect_with_room(plan);
      plan.scene.target.predicted = true;
    }
    if (scene.walls == WallArithmetic::exact) plan.container = nullptr;
  } else {
    expect(plan);
  }
  if (any_stage(plan.scene, &StageTraits::makes_bed, true)) plan.expected_bed = expected_bed(plan);
  require_images(plan);
  plan.hints = hints_of(plan);
  return plan;
}

Plan made_plan(const Scene& stated, const PlaceOfPlan* place) { return finished(begun_plan(stated, place)); }

bool all_may_fit(const Plan& plan) {
  return needs_room(plan) ? may_fit(plan_with_room(plan)) : may_fit(plan);
}

std::optional<Plan> made_plan_where_all_fit(const Scene& stated) {
  Plan plan = begun_plan(stated);
  if (!all_may_fit(plan)) return {};
  return finished(std::move(plan));
}

}  // namespace bernal

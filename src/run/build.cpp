#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "hard/grow_in_container.hpp"
#include "run/catalogue.hpp"
#include "run/estimate.hpp"
#include "run/fitting.hpp"

namespace bernal {
namespace {

/// Bytes a sphere takes in the packer: its place, its lists of about 30 neighbours, its cell, and the copies
/// that writing and certifying make.
constexpr double bytes_a_sphere = 600;
/// The same for relaxation in a periodic box.
constexpr double bytes_a_relaxed_sphere = 400;

/// Throws where a stage cannot work in the scene's domain.
void require_possible(const Scene& scene) {
  for (const Spec& stage : scene.stages) {
    const StageEntry& entry = find_entry(stage_catalogue(), stage);
    const bool between_walls =
        scene.container.has("walls") && scene.dimension() == 3 && !scene.container.flag("scalable");
    if (scene.is_periodic() ? entry.run_periodic || (entry.run && between_walls) : entry.run != nullptr)
      continue;
    std::vector<std::string_view> able;
    for (const StageEntry& other : stage_catalogue())
      if (scene.is_periodic() ? other.run_periodic != nullptr : other.run != nullptr)
        able.push_back(other.name);
    throw Error(
        ErrorCode::bad_scene,
        fmt::format("\"{}\" cannot work in a {}; there, the stages are \"{}\"", stage.name,
                    scene.is_periodic() ? "periodic box" : "container with walls", fmt::join(able, "\", \"")),
        stage.where);
  }
  const bool flies = std::ranges::find(scene.stages, "fly", &Spec::name) != scene.stages.end();
  const Target& target = scene.target;
  if (flies && !target.packing_fraction && (!target.count || scene.container.flag("scalable")))
    throw Error(
        ErrorCode::bad_scene,
        "\"fly\" fills a box of given size to a given end: give \"packing_fraction\" in [spheres], or "
        "\"count\" and the size of the box",
        target.where);
}

}  // namespace

Domain domain_of(const Scene& scene, std::string* notes) {
  std::string unused;
  return find_entry(container_catalogue(), scene.container).make(scene, notes ? *notes : unused);
}

Domain packed_domain_of(const Scene& scene) {
  if (scene.is_periodic() && !scene.container.has("size") && !scene.container.has("edge"))
    throw Error(
        ErrorCode::bad_scene,
        "does not say how large the periodic box is; give its \"size\", as the scene.toml that bernal "
        "pack writes beside the spheres does",
        scene.container.where);
  return domain_of(scene);
}

std::unique_ptr<SizeDistribution> radii_of(const Scene& scene) {
  const SizesEntry& entry = find_entry(sizes_catalogue(), scene.sizes);
  try {
    return entry.make(scene.sizes, scene.sizes_are_diameters ? 0.5 : 1.0);
  } catch (const Error& error) {  // what only the numbers together show
    if (error.code() != ErrorCode::bad_argument) throw;
    throw Error(ErrorCode::bad_scene, error.what(), scene.sizes.where);
  }
}

Draw draw_of(const Scene& scene) { return scene.draw == "quantiles" ? Draw::quantiles : Draw::random; }

namespace {

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
  const double surely = std::max(0.5 * expected, expected - error_of_expectation(plan.scene));
  target.packing_fraction = std::max(1e-4, std::floor(1e4 * surely) / 1e4);
}

void expect_in_container(Plan& plan) {
  const Scene& scene = plan.scene;
  const Domain& container = plan.domain;
  require_fitting(scene, container, plan.radii->min());
  if (std::isfinite(plan.radii->max())) {
    require_fitting(scene, container, plan.radii->max());
    require_long_periods(scene, container, plan.radii->max());
  }

  const double mean_volume = ball_volume(3, 1) * plan.radii->moment(3);
  const double volume = volume_of(container);
  double attainable = plan.attainable_packing_fraction =
      expected_packing_fraction(scene, container, *plan.radii);
  resolve_predicted(plan);
  if (scene.target.packing_fraction) attainable = std::min(attainable, *scene.target.packing_fraction);
  plan.expected_count = attainable * volume / mean_volume;
  if (scene.target.count)
    plan.expected_count = std::min(plan.expected_count, static_cast<double>(*scene.target.count));
  plan.expected_packing_fraction = plan.expected_count * mean_volume / volume;
  plan.expected_memory_bytes = plan.expected_count * bytes_a_sphere;
  plan.items.push_back({"walls", fmt::format("{}, {}", kind_of(container), scene.walls),
                        std::holds_alternative<Mesh>(container) ? "O(log faces) a query" : "O(1) a query"});
}

/// Throws where growth would find that the container is not convex.
void require_convex_for_growth(const Plan& plan) {
  const Domain& shape = plan.domain;
  const double rarest = std::min(0.5, 1 / std::max(1.0, plan.expected_count));
  const double smallest = std::max(plan.radii->min(), plan.radii->quantile(rarest));
  for (const Spec& stage : plan.scene.stages) {
    if (stage.name != "grow") continue;
    try {
      const Frame frame = frame_of(shape);
      walls_for_growth(to_local(shape, frame), smallest / frame.scale);
    } catch (const Error& error) {
      throw Error(error.code(), error.what(), stage.where);
    }
  }
}

/// What a size means that only gives the proportions of a box: each edge over the longest, to 44 bits. So all
/// sizes in proportion make the same plan, and the one that a run wrote down, rounded, makes that run again.
Vector<dynamic> proportions_of(const Vector<dynamic>& edges) {
  const auto rounded = [](double share) {
    int exponent = 0;
    const double mantissa = std::frexp(share, &exponent);
    return std::ldexp(std::round(std::ldexp(mantissa, 44)), exponent - 44);
  };
  return (edges / edges.maxCoeff()).unaryExpr(rounded);
}

void expect_in_periodic_box(Plan& plan) {
  const Scene& scene = plan.scene;
  const int dimension = scene.dimension();
  plan.box_follows = scene.container.flag("scalable");
  const double mean_volume = ball_volume(dimension, 1) * plan.radii->moment(dimension);
  double attainable = plan.attainable_packing_fraction = close_packing_fraction(*plan.radii, dimension);
  resolve_predicted(plan);
  if (scene.target.packing_fraction) attainable = std::min(attainable, *scene.target.packing_fraction);
  if (plan.box_follows) {
    plan.expected_count = static_cast<double>(*scene.target.count);
    Vector<dynamic>& edges = std::get<Box>(plan.domain).size;
    edges = proportions_of(edges);
    edges *= std::pow(plan.expected_count * mean_volume / attainable / edges.prod(), 1.0 / dimension);
  } else {
    plan.expected_count = attainable * volume_of(plan.domain) / mean_volume;
    if (scene.target.count) plan.expected_count = static_cast<double>(*scene.target.count);
  }
  plan.expected_packing_fraction = plan.expected_count * mean_volume / volume_of(plan.domain);
  plan.expected_memory_bytes = plan.expected_count * bytes_a_relaxed_sphere;
}

}  // namespace

Plan build(const Scene& scene) {
  Plan plan;
  plan.scene = scene;
  require_possible(scene);
  plan.domain = domain_of(scene, &plan.container_notes);
  plan.radii = radii_of(scene);
  if (scene.is_periodic()) {
    expect_in_periodic_box(plan);
  } else {
    expect_in_container(plan);
    require_convex_for_growth(plan);
  }

  for (const Spec& stage : scene.stages) {
    const StageEntry& entry = find_entry(stage_catalogue(), stage);
    const auto all = entry.effects_in(scene);
    for (const PlanItem& item : entry.chosen_effects ? entry.chosen_effects(stage, plan)
                                                     : std::vector<PlanItem>(all.begin(), all.end())) {
      const auto same = [&](const PlanItem& other) { return other.name == item.name; };
      if (std::ranges::none_of(plan.items, same)) plan.items.push_back(item);
    }
  }
  for (const StageEntry& stage : stage_catalogue()) {
    for (const PlanItem& item : stage.effects_in(scene)) {
      const auto same = [&](const PlanItem& other) { return other.name == item.name; };
      const bool runs = std::ranges::any_of(plan.items, same);
      if (!runs && std::ranges::find(plan.absent, item.name) == plan.absent.end())
        plan.absent.push_back(item.name);
    }
  }
  return plan;
}

}  // namespace bernal

#include "run/catalogue.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/cad/read_mesh.hpp"
#include "bernal/core/dimension.hpp"
#include "bernal/core/unit.hpp"
#include "fly/fly.hpp"
#include "hard/grow.hpp"
#include "hard/grow_in_container.hpp"
#include "settle/compress.hpp"
#include "settle/insert.hpp"
#include "settle/refill.hpp"
#include "settle/shake.hpp"
#include "soft/relax.hpp"
#include "soft/relax_in_container.hpp"

namespace bernal {
namespace {

Vector<3> vector_of(const Spec& spec, std::string_view key) {
  const std::vector<double>& v = spec.numbers(key);
  return {v.at(0), v.at(1), v.at(2)};
}

// ---- containers

Domain make_box(const Scene& scene, std::string&) {
  return Box{vector_of(scene.container, "corner"), vector_of(scene.container, "size")};
}

Domain make_cylinder(const Scene& scene, std::string&) {
  const Spec& c = scene.container;
  Cylinder cylinder{vector_of(c, "base"), vector_of(c, "axis"), c.number("radius"), c.number("height"),
                    c.flag("periodic")};
  if (cylinder.periodic && cylinder.coordinate_axis() < 0)
    throw Error(ErrorCode::bad_scene, "a cylinder that repeats itself has its axis along x, y or z",
                c.location("axis"));
  return cylinder;
}

Domain make_sphere(const Scene& scene, std::string&) {
  return Sphere{vector_of(scene.container, "center"), scene.container.number("radius")};
}

Domain make_mesh(const Scene& scene, std::string& notes) {
  const Spec& c = scene.container;
  const std::string& unit = c.has("unit") ? c.text("unit") : scene.unit;
  ImportedMesh imported = read_container_mesh(c.text("file"), conversion_factor(unit, scene.unit));
  notes =
      fmt::format("{} faces; {}; coordinates are {}", imported.report.faces, imported.report.reader, unit);
  if (!imported.report.repairs.empty())
    notes += fmt::format("; {}", fmt::join(imported.report.repairs, ", "));
  return std::move(imported.mesh);
}

/// The unit cube where the scene gives no size.
Domain make_periodic(const Scene& scene, std::string&) {
  const Spec& c = scene.container;
  Vector<dynamic> edges =
      Vector<dynamic>::Constant(scene.dimension(), c.has("edge") ? c.number("edge") : 1.0);
  if (c.has("size")) edges = Eigen::Map<const Eigen::VectorXd>(c.numbers("size").data(), scene.dimension());
  std::vector<bool> walls(static_cast<std::size_t>(scene.dimension()), false);
  if (c.has("walls"))
    for (const double axis : c.numbers("walls")) walls.at(static_cast<std::size_t>(axis)) = true;
  return periodic_box(edges, walls);
}

constexpr ContainerEntry containers[] = {{"box", make_box},
                                         {"cylinder", make_cylinder},
                                         {"sphere", make_sphere},
                                         {"mesh", make_mesh},
                                         {"periodic", make_periodic}};

// ---- stages

CompressOptions compress_options(const Spec& s) {
  return {.direction = vector_of(s, "direction").normalized(),
          .tilt = s.number("tilt"),
          .tolerance = s.number("tolerance"),
          .max_iterations = static_cast<int>(s.integer("max_iterations")),
          .buffer = s.number("buffer")};
}

StageEnd run_insert(const Spec& s, Work& work) {
  return insert(work, {.attempts = static_cast<int>(s.integer("attempts")),
                       .packing_fraction = s.number("packing_fraction")});
}

StageEnd run_compress(const Spec& s, Work& work) { return compress(work, compress_options(s)); }

StageEnd run_shake(const Spec& s, Work& work) {
  return shake(work, {.rounds = static_cast<int>(s.integer("rounds")),
                      .amplitude = s.number("amplitude"),
                      .compress = compress_options(s)});
}

StageEnd run_refill(const Spec& s, Work& work) {
  return refill(work, {.max_rounds = static_cast<int>(s.integer("max_rounds")),
                       .probes = s.number("probes"),
                       .patience = s.number("patience"),
                       .shake = {.rounds = static_cast<int>(s.integer("shakes")),
                                 .amplitude = s.number("amplitude"),
                                 .compress = compress_options(s)}});
}

const PlanItem insertion[] = {{"insertion", "random places, one sphere after the other", "O(1) a trial"}};
const PlanItem compression[] = {
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"compression", "to first touch along the global and local directions",
     "about 0.5 µs a sphere and sweep"}};
const PlanItem shaking[] = {
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"shaking", "local directions across the global one", "about 0.5 µs a sphere and sweep"},
    {"compression", "after each round", "about 0.5 µs a sphere and sweep"}};
const PlanItem refilling[] = {
    {"refilling", "random probes of the free space", "O(1) a probe"},
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"compression", "after each refilling", "about 0.5 µs a sphere and sweep"},
    {"shaking", "after each refilling", "about 0.5 µs a sphere and sweep"}};

StageEnd run_relax_in_container(const Spec& s, Work& work) {
  return relax_in_container(
      work, {.patience = s.number("patience"), .sweeps = s.number("sweeps"), .seconds = s.number("seconds")});
}

StageEnd run_relax(const Spec& s, Work& work) {
  return relax(work, {.alpha = s.number("alpha"),
                      .beta = s.number("beta"),
                      .phi0 = s.number("phi0"),
                      .stop = s.number("stop"),
                      .polish = s.number("polish"),
                      .reference = s.text("method") == "reference",
                      .settle = s.flag("settle")});
}

GrowOptions grow_options(const Spec& s) {
  GrowOptions options{
      .phi_init = s.number("phi_init"), .rate = s.number("rate"), .pressure = s.number("pressure")};
  if (s.has("delta")) options.delta = s.number("delta");
  if (s.text("masses") == "volume") options.masses = Masses::by_volume;
  return options;
}

StageEnd run_grow_in_container(const Spec& s, Work& work) { return grow_in_container(work, grow_options(s)); }

StageEnd run_grow(const Spec& s, Work& work) {
  GrowOptions options = grow_options(s);
  options.polish = s.number("polish");
  return grow(work, options);
}

StageEnd run_fly(const Spec& s, Work& work) {
  const FillChoice choice = choose_filling(s.text("method"), work.fill_task);
  const double dt = choice.method == FillMethod::patent ? 0.01 : 0.25;
  return fly(work, choice,
             {.batch = static_cast<int>(s.integer("batch")),
              .dt = s.has("dt") ? s.number("dt") : dt,
              .patience = s.number("patience"),
              .sweeps = s.number("sweeps")});
}

const PlanItem flying[] = {
    {"flight", "new spheres at random places, from large to small, while those that are there fly",
     "O(N) a batch"},
    {"collisions", "elastic, between spheres and at walls", "O(log N) each"},
    {"insertion", "from large to small, between those that are there", "O(1) a trial"},
    {"trial places", "random, and pushed out of what they overlap", "O(1) each"},
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"relaxation", "overlapping spheres push each other apart; what is stuck is stirred",
     "some 1,000 sweeps of O(N)"}};

/// The method and why it, at the first of its effects.
std::vector<PlanItem> chosen_effects_of_fly(const Spec& stage, const Plan& plan) {
  FillChoice choice;
  try {
    choice = choose_filling(stage.text("method"), fill_task_of(plan));
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_scene, error.what(), stage.location("method"));
  }
  std::vector<PlanItem> items;
  if (choice.method == FillMethod::patent || choice.method == FillMethod::flight)
    items.assign(flying, flying + 2);
  else
    items.assign(flying + (choice.method == FillMethod::classes ? 2 : 4), std::end(flying));
  if (choice.method == FillMethod::patent) items[1].cost = "O(N) each";
  items.insert(items.begin(), {"fly", fmt::format("by {}, {}", name_of(choice.method), choice.reason), ""});
  return items;
}

const PlanItem relaxing_in_container[] = {
    {"insertion", "random places, where so few are asked for that these are enough", "O(1) a trial"},
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"relaxation", "overlapping spheres and walls push; what is stuck is stirred or put into holes",
     "some 1,000 sweeps of O(N)"}};
const PlanItem relaxing[] = {
    {"neighbour lists", "of all spheres together, from the background grid", "O(N) an iteration"},
    {"relaxation", "overlapping spheres push each other apart while the box grows",
     "some 1,000 sweeps of O(N)"}};

const PlanItem growing[] = {{"insertion", "random places at the start, the largest first", "O(1) a trial"},
                            {"neighbour shells", "each sphere renews its own list", "about 1 µs"},
                            {"collisions", "of growing spheres, from a calendar of events", "0.5 to 0.8 µs"},
                            {"reflections", "of growing spheres from the walls", "0.5 to 0.8 µs"},
                            {"growth", "until the spheres jam", "some 2,000 collisions a sphere"}};

const PlanItem growing_in_container[] = {
    {"insertion", "random places at the start, the largest first", "O(1) a trial"},
    {"neighbour shells", "each sphere renews its own list, and that of its walls", "about 1 µs"},
    {"collisions", "of growing spheres, from a calendar of events", "0.5 to 0.8 µs"},
    {"reflections", "of growing spheres from the walls, from the same calendar", "0.5 to 0.8 µs"},
    {"growth", "until the spheres have their radii; what jams before loses the last of the drawn sequence",
     "some 2,000 collisions a sphere"}};

/// In a periodic box there are reflections only if it ends at walls along some axis.
std::vector<PlanItem> chosen_effects_of_grow(const Spec&, const Plan& plan) {
  if (!plan.scene.is_periodic()) return {std::begin(growing_in_container), std::end(growing_in_container)};
  std::vector<PlanItem> items(std::begin(growing), std::end(growing));
  if (!has_walls(plan.domain))
    std::erase_if(items, [](const PlanItem& item) { return item.name == "reflections"; });
  return items;
}

const StageEntry stages[] = {
    {"insert", run_insert, nullptr, insertion},
    {"compress", run_compress, nullptr, compression},
    {"shake", run_shake, nullptr, shaking},
    {"refill", run_refill, nullptr, refilling},
    {"relax", run_relax_in_container, run_relax, relaxing_in_container, relaxing, nullptr, true, true},
    {"grow", run_grow_in_container, run_grow, growing_in_container, growing, chosen_effects_of_grow, true},
    {"fly", nullptr, run_fly, {}, flying, chosen_effects_of_fly}};

}  // namespace

bool works_in_bed(const Spec& stage, const Plan& plan) {
  if (!plan.scene.is_periodic()) return true;
  const StageEntry& entry = find_entry(stage_catalogue(), stage);
  const bool fixed_walls = has_walls(plan.domain) && dimension_of(plan.domain) == 3 && !plan.box_follows;
  return entry.run && fixed_walls && (!entry.run_periodic || entry.prefers_bed);
}

FillTask fill_task_of(const Plan& plan) {
  constexpr double rare = 1e-4;
  const int dimension = plan.scene.dimension();
  const Target& target = plan.scene.target;
  FillTask task{.dimension = dimension,
                .attainable = plan.attainable_packing_fraction,
                .size_ratio = plan.radii->quantile(1 - rare) / plan.radii->quantile(rare),
                .has_walls = has_walls(plan.domain)};
  if (target.packing_fraction)
    task.packing_fraction = *target.packing_fraction;
  else if (target.count)
    task.packing_fraction = static_cast<double>(*target.count) * ball_volume(dimension, 1) *
                            plan.radii->moment(dimension) / volume_of(plan.domain);
  return task;
}

std::span<const ContainerEntry> container_catalogue() { return containers; }
std::span<const StageEntry> stage_catalogue() { return stages; }

}  // namespace bernal

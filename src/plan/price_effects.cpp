#include "plan/price_effects.hpp"
#include "plan/plan_insides.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/dimension.hpp"
#include "engine/engine_plan.hpp"
#include "measure/weighted_cells.hpp"
#include "plan/estimate.hpp"
#include "plan/few_large.hpp"
#include "plan/stages.hpp"
#include "work/bed.hpp"

// What a run costs beside its stages, and the sum over these. Times in seconds of one core, memory in bytes;
// the constants are measured, see tests/bench/estimates_table.
namespace bernal {
namespace {

/// The program itself, its libraries and their threads; the tables that predict packing fractions; what reads
/// meshes.
constexpr double program = 15e6, tables = 7e6, mesh_reader = 8e6;
/// A sphere as it is kept while stages run, and as it is written, certified and measured after them, of which
/// less is there at once where they are very many.
constexpr double bytes_kept = 40, bytes_written = 160, bytes_written_an_axis = 30, bytes_of_very_many = 150,
                 very_many = 4e6;
/// A triangle of a mesh, in its tree, in the certificate's and in the file.
constexpr double bytes_a_face = 1500;
/// A question to the walls of a box, cylinder or sphere; to a mesh of 1,000 faces, and how that grows with
/// their number; and how many times as much it takes exactly.
constexpr double analytic_query = 30e-9, mesh_query = 0.5e-6, growth_with_faces = 0.35, exact_query = 280;

/// Where walls are near everywhere: a question finds so many more facets, and so many times as many are
/// asked, as it is tried to place what was only guessed to fit. Of a Menger sponge whose walls are 1.25 times
/// as thick as its 659 spheres: 336 questions a sphere of 9 µs each.
constexpr double facets_everywhere = 10, questions_everywhere = 57;

double wall_query(const Scene& scene, const Domain& domain) {
  double seconds = analytic_query;
  if (const Mesh* mesh = std::get_if<Mesh>(&domain))
    seconds = mesh_query *
              std::pow(std::max(1.0, static_cast<double>(mesh->triangles.size()) / 1000), growth_with_faces);
  return scene.walls == WallArithmetic::exact ? exact_query * seconds : seconds;
}

double spread_of(const Plan& plan) {
  const double ratio = plan.radii->moment(3) / std::pow(plan.radii->moment(1), 3);
  return std::clamp(ratio, 1.0, 30.0);  // what is wider is cut where it does not fit
}

/// Share of the spheres that are no farther from a wall than their diameter.
double share_at_walls(const Plan& plan) {
  const double mean_diameter = 2 * plan.radii->quantile(0.5);
  return std::min(1.0, area_of(plan.domain) * mean_diameter / volume_of(plan.domain));
}

std::vector<PlanItem> effects_of(const Stage& stage, const Outlook& outlook) {
  const StageEntry& entry = entry_of(stage);
  try {
    return entry.effects(entry.table.options(stage), outlook);
  } catch (const Error& error) {
    throw Error(ErrorCode::bad_scene, error.what(), stage.locations.of("method"));
  }
}

/// The same effect in several stages is one line.
void add(std::vector<PlanItem>& items, const PlanItem& more) {
  const auto same = std::ranges::find(items, more.name, &PlanItem::name);
  if (same == items.end()) {
    items.push_back(more);
    return;
  }
  same->seconds += more.seconds;
  same->bytes = std::max(same->bytes, more.bytes);
  same->if_needed = same->if_needed && more.if_needed;
}

/// Of what the questions to the walls are expected to take all but what they take in doubles.
void add_exact_walls(std::vector<PlanItem>& items) {
  const auto walls = std::ranges::find(items, "walls", &PlanItem::name);
  const double exact = walls->seconds * (1 - 1 / exact_query);
  walls->seconds -= exact;
  items.insert(walls + 1, {.name = std::string(exact_walls_effect),
                           .what = "of every place and every move limit at a wall",
                           .cost = "2 to 100 µs a decision",
                           .seconds = exact,
                           .part = true});
}

}  // namespace

void price_effects(Plan& plan) {
  const Scene& scene = plan.scene;
  Outlook outlook{.task = fill_task_of(plan),
                  .spheres = plan.expected_count,
                  .aim = plan.expected_packing_fraction,
                  .gain = gain_of_stages(scene, plan.domain, *plan.radii),
                  .spread = spread_of(plan),
                  .is_filled = scene.target.fill || is_guess(plan)};
  outlook.size = bounds_of<dynamic>(plan.domain).size() / (2 * plan.radii->moment(1));
  // Those of the start have places, and fill their share.
  const auto there = static_cast<double>(plan.start.spheres.size());
  outlook.placed = there > 0 && there >= plan.expected_count;
  outlook.filled = there > 0 ? outlook.aim * std::min(1.0, there / plan.expected_count) : 0;
  const bool asks_walls = any_in_bed(scene);
  if (asks_walls) {
    const double bytes =
        std::holds_alternative<Mesh>(plan.domain)
            ? mesh_reader + bytes_a_face * static_cast<double>(std::get<Mesh>(plan.domain).triangles.size())
            : 0;
    plan.items.push_back({.name = "walls",
                          .what = fmt::format("{}, {}", kind_of(plan.domain), name_of(scene.walls)),
                          .cost = is_faceted(plan.domain) ? "O(log faces) a query" : "O(1) a query",
                          .bytes = bytes,
                          .part = true});
    outlook.wall_query = wall_query(scene, plan.domain);
    if (is_guess(plan)) outlook.wall_query *= facets_everywhere * questions_everywhere;
    outlook.at_walls = share_at_walls(plan);
  }
  if (scene.engine) plan.items.push_back(engine::planned_engine(scene, plan.expected_count));
  double before_stages = 0, of_stages = 0;
  for (const PlanItem& item : plan.items) before_stages += item.bytes;
  for (const Stage& stage : scene.stages) {
    const StageEntry& entry = entry_of(stage);
    outlook.in_bed = entry.table.traits.stands_in_bed(scene);
    double bytes = 0;
    for (const PlanItem& item : effects_of(stage, outlook)) {
      add(plan.items, item);
      bytes += item.bytes;
    }
    of_stages = std::max(of_stages, bytes_kept * plan.expected_count + bytes);
    if (entry.table.traits.only_moves) continue;
    outlook.placed = true;
    outlook.filled =
        entry.reached ? std::min(outlook.aim, entry.reached(entry.table.options(stage))) : outlook.aim;
  }

  if (const std::optional<PlanItem> search = search_for_few(plan)) add(plan.items, *search);
  if (scene.walls == WallArithmetic::exact) add_exact_walls(plan.items);

  const auto is_planned = [&](const std::string& name) {
    return std::ranges::find(plan.items, name, &PlanItem::name) != plan.items.end();
  };
  std::vector<std::string> all = {"start", "walls", std::string(exact_walls_effect), cells_effect,
                                  inside_effect};
  for (const StageEntry* stage : stage_entries())
    all.insert(all.end(), stage->may_bring.begin(), stage->may_bring.end());
  for (const std::string& name : all)
    if (!is_planned(name) && std::ranges::find(plan.absent, name) == plan.absent.end())
      plan.absent.push_back(name);

  const double written = plan.expected_count < very_many
                             ? bytes_written + bytes_written_an_axis * scene.dimension()
                             : bytes_of_very_many;
  // Of slabs one is held, with what is around it.
  constexpr double with_surroundings = 1.5;
  const int slabs = scene.engine ? scene.engine->process().slabs : 1;
  const double held = slabs > 1 ? std::min(1.0, with_surroundings / slabs) : 1;
  plan.expected_memory_bytes = program + (scene.dimension() == 3 ? tables : 0) + before_stages +
                               held * std::max(of_stages, written * plan.expected_count);
  for (const PlanItem& item : plan.items)
    if (!item.part) plan.expected_seconds += item.seconds;
}

}  // namespace bernal

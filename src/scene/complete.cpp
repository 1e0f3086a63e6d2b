#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "scene/cells_entry.hpp"
#include "scene/complete_sizes.hpp"
#include "scene/insides.hpp"
#include "scene/known_words.hpp"
#include "scene/layers_of_scene.hpp"
#include "scene/output_table.hpp"
#include "scene/porosity.hpp"
#include "scene/repetition.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

using schema::check;
using schema::Entry;
using schema::Key;
using schema::Section;
using schema::Type;

void check_sizes(const SceneSizes& sizes, const std::string& name, bool are_diameters) {
  const Entry& entry = schema::entry_of(sizes);
  const void* options = schema::options_of(sizes);
  const Section section{name, sizes.locations};
  check(entry, options, section);
  for (const Key& key : entry.keys)
    if (key.is_diameter && !are_diameters && key.of(options))
      section.fail(key.name, fmt::format("\"{}\" is a diameter; write diameter = {{…}}, not {}", key.name,
                                         name.substr(0, name.find(' '))));
  if (const auto* mixture = std::get_if<Mixture>(&sizes))
    for (std::size_t i = 0; i < mixture->of.size(); ++i)
      check_sizes(mixture->of[i], fmt::format("part {} of {}", i + 1, name), are_diameters);
}

bool is_start_alone(const Scene& scene) { return scene.start.file && !scene.draws(); }

/// What the target and a periodic box demand of each other.
void check_target(const Scene& scene) {
  const Target& target = scene.target;
  const auto fail = [&](const char* message) { throw Error(ErrorCode::bad_scene, message, target.where); };
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  const bool scalable = box && box->scalable, all_are_there = is_start_alone(scene);
  if (all_are_there && (target.fill || (target.has_packing_fraction() && !scalable)))
    fail(
        "there are no sizes to draw more spheres from than the start has: give \"diameter\" or \"radius\" in "
        "[spheres] too, or ask for no more");
  if (all_are_there && target.bed.gives_height())
    fail(
        "a bed of given height needs sizes to draw spheres from: give \"diameter\" or \"radius\" in "
        "[spheres] too");
  if (all_are_there && target.mass)
    fail("a \"mass\" needs sizes to draw spheres from: give \"diameter\" or \"radius\" in [spheres] too");
  if (target.mass && scene.dimension() != 3)
    throw Error(ErrorCode::bad_scene,
                fmt::format("a \"mass\" is of spheres in three dimensions, not in {}: give a \"count\"",
                            scene.dimension()),
                target.where);
  if (target.bed.gives_height() && (target.has_count() || target.has_packing_fraction() || target.fill))
    fail(
        "the height of a bed in [spheres] says how many spheres there are: leave \"count\", "
        "\"packing_fraction\" and \"fill\" out");
  if (target.has_count() && target.has_packing_fraction() && !scalable)
    fail(target.mass ? "\"mass\" and a packing fraction in [spheres] exclude each other; give one of them"
                     : "\"count\" and \"packing_fraction\" in [spheres] exclude each other, as the sizes are "
                       "given too: give one of them, and let \"scale\" make the sizes what meets the other "
                       "(both go together only in a periodic box without size)");
  if (scalable && !target.has_count() && !all_are_there)
    fail("a periodic box without size needs a \"count\" in [spheres]; or give it \"size\" or \"edge\"");
}

/// The stage that packs any scene, or makes the bed that is asked for; in a container of two dimensions those
/// that settle discs, one after the other.
void take_default_stages(Scene& scene) {
  scene.stages_are_default = true;
  if (const auto* box = std::get_if<PeriodicBox>(&scene.container);
      box && scene.target.bed.is_asked() && !has_fixed_walls(*box))
    throw Error(ErrorCode::bad_scene,
                "a bed lies on a floor, which this periodic box has not: give it walls = [2] and a size, or "
                "take another container",
                scene.target.where);
  const bool in_plane = !scene.is_periodic() && scene.dimension() == 2, bed = scene.target.bed.is_asked();
  for (const StageTable* table : stage_tables())
    if (in_plane ? table->traits.is_default_in_plane
        : bed    ? table->traits.makes_bed
                 : table->traits.is_default) {
      scene.stages.push_back(table->make());
      scene.stages.back().locations.whole.file = scene.file.string();
    }
}

std::string_view name_of_domain(const Scene& scene) {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (schema::is_repeated_mesh(scene)) return "mesh that repeats itself";
  if (!box) return scene.dimension() == 2 ? "container of two dimensions" : "container with walls";
  if (schema::is_tilted(scene)) return "tilted periodic box";
  return box->walls.empty() ? "periodic box" : "periodic box that ends at walls along some axes";
}

/// The stages that can work in the scene's domain, for people.
std::string stages_for(const Scene& scene) {
  std::vector<std::string_view> names;
  for (const StageTable* table : stage_tables())
    if (table->traits.works_in(scene)) names.push_back(table->name());
  return fmt::format("there, the stages are \"{}\"", fmt::join(names, "\", \""));
}

/// Throws where a stage cannot work in the scene's domain.
void require_possible(const Scene& scene, const Stage& stage) {
  const StageTable& table = table_of(stage);
  const StageTraits& traits = table.traits;
  const auto fail = [&](const std::string& why) {
    throw Error(ErrorCode::bad_scene, fmt::format("\"{}\" {}", table.name(), why), stage.locations.whole);
  };
  if (!traits.works_in(scene))
    fail(fmt::format("cannot work in a {}; {}", name_of_domain(scene), stages_for(scene)));
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (!box || traits.stands_in_bed(scene)) return;
  if (box->dimension < traits.least_dimension || box->dimension > traits.most_dimensions)
    fail(fmt::format("works in {} to {} dimensions, not in {}", traits.least_dimension,
                     traits.most_dimensions, box->dimension));
}

/// Once the stages have said what they fill the box to.
void require_end(const Scene& scene) {
  const Target& target = scene.target;
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  for (const Stage& stage : scene.stages)
    if (const StageTable& table = table_of(stage);
        table.traits.fills_given_box && !target.has_packing_fraction() &&
        ((!target.has_count() && !is_start_alone(scene)) || (box && box->scalable)))
      throw Error(ErrorCode::bad_scene,
                  fmt::format("\"{}\" fills a box of given size to a given end: give \"packing_fraction\" in "
                              "[spheres], or \"count\" and the size of the box",
                              table.name()),
                  target.where);
}

/// What is pushed is pushed down where nothing is said of it, along the last axis that there is.
void complete_pushes(const Entry& entry, void* options, const Scene& scene, const Section& section) {
  const auto dimension = static_cast<std::size_t>(scene.dimension());
  for (const Key& key : entry.keys) {
    if (key.type != Type::push) continue;
    const auto value = std::get<std::vector<double>>(*key.of(options));
    if (value.size() == dimension) continue;
    if (section.locations.keys.contains(key.name) ||
        toml_text(value) != toml_text(*key.of(entry.defaults.get())))
      section.refuse(key.name, fmt::format("must have a component for each of {} dimensions, but it has {}",
                                           dimension, value.size()));
    std::vector<double> down(dimension - 1, 0.0);
    down.push_back(-1);
    key.member.set(options, down);
  }
}

/// Whether any stage that settles spheres makes it, by a count.
bool is_plain(const BedTarget& bed) {
  return !bed.asks_for_density() && !bed.gives_height() &&
         bed.top.value_or(BedTarget::Top::free) == BedTarget::Top::free;
}

/// Throws where the scene says what a bed is to be like, and no stage would make it so.
void require_bed(const Scene& scene) {
  const BedTarget& bed = scene.target.bed;
  if (bed == BedTarget{}) return;
  const auto fail = [&](std::string_view why) {
    throw Error(ErrorCode::bad_scene, std::string(why), scene.target.where);
  };
  const auto makes_bed = [&](const Stage& stage) {
    const StageTraits& traits = table_of(stage).traits;
    return traits.makes_bed || (is_plain(bed) && traits.reaches == Reaches::settled);
  };
  if (bed.asks_for_density() && scene.target.fill)
    fail("\"fill\" and a bed of given density exclude each other: leave one of them out of [spheres]");
  if (bed.top == BedTarget::Top::heap && scene.target.is_open() && !bed.gives_height())
    fail("a heap needs the \"height\" of its tip, or a \"count\"");
  if (std::ranges::any_of(scene.stages, makes_bed)) {
    if (is_plain(bed) || table_of(scene.stages.back()).traits.makes_bed) return;
    throw Error(ErrorCode::bad_scene,
                "this stage would make something else of the bed that [spheres] asks for: leave it out",
                scene.stages.back().locations.whole);
  }
  if (!scene.is_periodic() && scene.dimension() == 2)
    fail(
        "a bed of discs takes a \"count\", and its density and its top are as they come: leave porosity, "
        "height "
        "and the like out of [spheres]");
  fail("a bed is asked for in [spheres], and no stage makes one: name \"settle\", or no stage");
}

void complete_stages(Scene& scene) {
  if (scene.stages.empty()) take_default_stages(scene);
  bool keeps_sizes = false;  // in a bed
  for (Stage& stage : scene.stages) {
    const StageTable& table = table_of(stage);
    const Section section = section_of(stage, table);
    require_possible(scene, stage);
    check(table.keys, table.options(stage), section, table.traits.stands_in_bed(scene));
    if (table.traits.stands_in_bed(scene))
      complete_pushes(table.keys, table.options_of(stage), scene, section);
    if (table.keys.complete) table.keys.complete(table.options_of(stage), scene, section);
    keeps_sizes = keeps_sizes || (table.traits.keeps_sizes && table.traits.stands_in_bed(scene));
  }
  require_end(scene);
  require_bed(scene);
  const auto* classes = std::get_if<Classes>(&scene.sizes);  // weighed out, and so met to a sphere
  const bool is_weighed = classes && classes->basis == Basis::mass;
  if (!scene.draw && (keeps_sizes || is_weighed)) scene.draw = Draw::quantiles;
}

}  // namespace

bool StageTraits::stands_in_bed(const Scene& scene) const {
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (!box) return true;
  return in_bed && has_fixed_walls(*box) && (!in_box || prefers_bed);
}

bool StageTraits::works_in(const Scene& scene) const {
  if (stands_in_bed(scene))
    return in_bed && (in_plane || scene.dimension() == 3) &&
           (in_repeated_mesh || !schema::is_repeated_mesh(scene));
  const auto& box = std::get<PeriodicBox>(scene.container);
  return in_box && (box_between_walls || box.walls.empty()) && (in_tilted_box || !schema::is_tilted(scene));
}

/// Of an obstacle, or of a container what it has in common with these.
static void check_solid(const SceneContainer& solid, const std::string& name, bool is_obstacle) {
  const Section section{name, solid.locations};
  const Entry& entry = schema::entry_of(solid);
  const auto* box = std::get_if<Box>(&solid);
  const auto* cylinder = std::get_if<Cylinder>(&solid);
  const bool is_bounded = (!box || box->dimension() == 3) && (!cylinder || !cylinder->periodic);
  if ((is_obstacle || !solid.obstacles.empty()) && !(is_bounded && entry.find("obstacles")))
    section.fail("obstacles", name + ": what has obstacles, or is one, has three dimensions and no periods");
  if (is_obstacle) check(entry, schema::options_of(solid), section);
  if (solid.rounding == 0) return;
  if (is_obstacle || !is_bounded || !entry.find("rounding"))
    section.refuse("rounding",
                   "is for boxes of three dimensions and cylinders without periods; leave it out");
  const double most = box ? 0.5 * box->size.minCoeff() : std::min(cylinder->radius, 0.5 * cylinder->height);
  if (!(solid.rounding > 0 && solid.rounding <= most))
    section.refuse("rounding", fmt::format("must be above 0 and at most {}, with which nothing straight is "
                                           "left of an edge, not {}",
                                           most, solid.rounding));
}

void complete(Scene& scene) {
  complete_density(scene);
  for (const Entry* entry : schema::own_entries())
    check(*entry, &scene,
          {entry->name == "scene" ? "the scene" : fmt::format("[{}]", entry->name), scene.locations});
  const Entry& container = schema::entry_of(scene.container);
  const Section section{"[container]", scene.container.locations};
  check(container, schema::options_of(std::as_const(scene.container)), section);
  if (container.complete) container.complete(schema::options_of(scene.container), scene, section);
  for (std::size_t k = 0; k < scene.container.obstacles.size(); ++k)
    check_solid(scene.container.obstacles[k], fmt::format("solid {} of obstacles of [container]", k + 1),
                true);
  check_solid(scene.container, "[container]", false);
  take_porosity(scene);
  complete_list(scene);
  check_target(scene);
  if (const auto& cells = scene.cells) {
    schema::require_cells(scene);
    check_sizes(cells->sizes(), fmt::format("{} of cells", cells->diameter ? "diameter" : "volume"),
                cells->diameter.has_value());
  } else if (!is_start_alone(scene) && (scene.draws() || scene.zones.empty())) {
    check_sizes(scene.sizes, scene.sizes_are_diameters ? "diameter of [spheres]" : "radius of [spheres]",
                scene.sizes_are_diameters);
  }
  require_layers(scene);
  complete_stages(scene);
  complete_zones(scene);
  check_insides(scene);
  schema::require_repetition_known(scene);
  if (scene.engine)
    check(schema::entry_of(*scene.engine), schema::options_of(std::as_const(*scene.engine)),
          {"[engine]", scene.engine->locations});
  for (Output& output : scene.outputs) complete_output(output, scene);
  require_names(scene);
}

const StageTable& table_of(const Stage& stage) {
  for (const StageTable* table : stage_tables())
    if (table->options(stage)) return *table;
  throw Error(ErrorCode::bad_scene, "these are the options of no stage", stage.locations.whole);
}

std::string_view Stage::name() const { return table_of(*this).name(); }

Stage stage_named(std::string_view name) {
  for (const StageTable* table : stage_tables())
    if (table->name() == name) return table->make();
  throw Error(ErrorCode::bad_argument, fmt::format("unknown stage {}{}", toml_string(name),
                                                   remedy_of_word(name, known_words_in(stage_tables()))));
}

}  // namespace bernal

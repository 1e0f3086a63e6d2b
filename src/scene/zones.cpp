#include "scene/zones.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/sphere_classes.hpp"
#include "scene/complete_sizes.hpp"
#include "scene/scene_entries.hpp"
#include "scene/size_kinds.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// What the spheres of a zone are made of, and their density: where it says neither that of the whole.
std::pair<std::string, std::optional<double>> material_in(const Scene& whole, const Scene& of) {
  const bool says_nothing = of.material.empty() && !of.material_density;
  return {says_nothing ? whole.material : of.material,
          of.material_density ? of.material_density : whole.material_density};
}

/// What all spheres of a scene have in common.
void take_from_whole(Scene& of, const Scene& whole) {
  of.file = whole.file;
  of.unit = whole.unit;
  of.seed = whole.seed;
  of.container = whole.container;
  of.gap = whole.gap;
  of.wall_gap = whole.wall_gap;
  of.walls = whole.walls;
  of.overlap = whole.overlap;
  of.stages = whole.stages;
  of.stages_are_default = whole.stages_are_default;
  for (const char* key : {"unit", "seed", "gap", "wall_gap", "walls", "overlap"})
    if (const auto said = whole.locations.keys.find(key); said != whole.locations.keys.end())
      of.locations.keys.insert(*said);
  std::tie(of.material, of.material_density) = material_in(whole, of);
  // A bed as dense as the whole, where it says nothing; how high it is, and its top, are the last one's.
  BedTarget& bed = of.target.bed;
  if (bed.porosity || of.target.bulk_density) return;
  bed.density = whole.target.bed.density;
  bed.porosity = whole.target.bed.porosity;
}

[[noreturn]] void fail(const Zone& zone, std::string_view key, const std::string& why) {
  throw Error(ErrorCode::bad_scene, why, zone.locations.of(key));
}

/// What cannot be said of a packing of several zones.
void require_plain_scene(const Scene& scene) {
  const auto refuse = [&](bool is_there, std::string_view what, const Location& at) {
    if (!is_there) return;
    throw Error(ErrorCode::bad_scene,
                fmt::format("{} and [[zone]] exclude each other; leave one of them out", what), at);
  };
  refuse(scene.largest, "\"largest\"", scene.target.where);
  refuse(scene.start.file.has_value(), "a \"start\"", scene.locations.of("start"));
  refuse(scene.engine.has_value(), "[engine]", scene.engine ? scene.engine->locations.whole : Location());
  const auto* box = std::get_if<PeriodicBox>(&scene.container);
  if (box && (box->scalable || box->dimension != 3))
    throw Error(ErrorCode::bad_scene,
                "zones are parts of a container of given size in three dimensions: give the periodic box its "
                "\"size\" or \"edge\"",
                scene.container.locations.whole);
  if (!box && scene.dimension() != 3)
    throw Error(ErrorCode::bad_scene, "zones are parts of a container of three dimensions, not of two",
                scene.zones.front().locations.whole);
  if (!scene.draws() && scene.scale != 1)
    throw Error(ErrorCode::bad_scene,
                "\"scale\" in [spheres] is of the sizes there, and there are none: leave it out",
                scene.locations.of("scale"));
  const auto refuse_names = [](const SceneSizes& sizes) {
    const auto* classes = std::get_if<Classes>(&sizes);
    if (classes && !classes->layers.empty())
      throw Error(ErrorCode::bad_scene,
                  "\"layers\" of classes and [[zone]] exclude each other: give the \"layers\" of all spheres "
                  "of a zone, in [[zone]]",
                  sizes.locations.of("layers"));
    if (classes && !classes->names.empty())
      throw Error(
          ErrorCode::bad_scene,
          "\"names\" of classes and [[zone]] exclude each other: the zones are what a result tells apart",
          sizes.locations.of("names"));
  };
  refuse_names(scene.sizes);
  for (const Zone& zone : scene.zones) refuse_names(zone.spheres.sizes);
  if (!scene.draws() && (!scene.target.is_open() || scene.target.fill))
    throw Error(ErrorCode::bad_scene,
                "an amount in [spheres] is of the sizes there, which lie in no zone: give \"diameter\" or "
                "\"radius\" in [spheres] too, or the amount in [[zone]]",
                scene.target.where);
}

}  // namespace

std::string section_name_of_zone(std::size_t number) { return fmt::format("[[zone]] {}", number); }

std::string name_of_zone(const Scene& scene, std::size_t k) {
  const Zone& zone = scene.zones[k];
  if (!zone.name.empty()) return zone.name;
  const std::string& material = zone.spheres.material;
  const auto has_it = [&](const Zone& other) {
    return other.name == material || other.spheres.material == material;
  };
  const bool is_unique =
      !material.empty() && std::ranges::count_if(scene.zones, has_it) == 1 && material != scene.material;
  return is_unique ? material : fmt::format("zone {}", k + 1);
}

bool lays_zones(const Scene& scene) {
  return std::ranges::any_of(scene.stages,
                             [](const Stage& stage) { return table_of(stage).traits.makes_bed; });
}

Scene scene_of_zone(const Scene& whole, const Zone& zone) {
  Scene of = zone.spheres;
  take_from_whole(of, whole);
  return of;
}

Scene scene_of_rest(const Scene& whole) {
  Scene of = whole;
  of.zones.clear();
  of.outputs.clear();
  of.inside.clear();
  return of;
}

/// Throws Error{bad_scene} where zones contradict each other or the scene around them.
static void require_zones(const Scene& scene) {
  require_plain_scene(scene);
  const bool laid = lays_zones(scene);
  std::set<std::string, std::less<>> names;
  for (std::size_t k = 0; k < scene.zones.size(); ++k) {
    const Zone& zone = scene.zones[k];
    const Target& target = zone.spheres.target;
    if (const std::string name = name_of_zone(scene, k); !names.insert(name).second)
      fail(zone, "name", fmt::format("two zones have the name {}; give each its own", toml_string(name)));
    const bool is_mesh = std::holds_alternative<MeshFile>(scene.container);
    if (!zone.solids.empty() && !is_mesh)
      fail(zone, "solid", "a \"solid\" is one of a CAD file, and this container has none: give a \"place\"");
    if (!zone.solids.empty() && scene.draws())
      fail(zone, "solid",
           "where a zone is a \"solid\" each solid is a zone: leave \"diameter\" and \"radius\" out of "
           "[spheres], and give the others a [[zone]]");
    const bool has_walls = !zone.solids.empty() || zone.chamber || zone.mesh;
    const bool has_place = !zone.place.empty() || has_walls;
    if (!has_place && !laid)
      fail(zone, "",
           fmt::format("{} needs exactly one of \"place\", \"solid\", \"chamber\", \"mesh\"; only spheres "
                       "that settle, with bed = \"poured\" in [spheres], lie on others without",
                       section_name_of_zone(k + 1)));
    if (laid && (target.fill || target.packing_fraction))
      fail(zone, target.fill ? "fill" : "packing_fraction",
           "a layer of a bed is as high as its \"place\", or has a \"count\" or a \"mass\"");
    const bool has_amount = target.has_count() || each_once(zone.spheres.sizes);
    if (laid && !has_place && !has_amount)
      fail(zone, "",
           fmt::format("{} has no end: give a \"place\" such as \"z < 20\", a \"count\" or a \"mass\"",
                       section_name_of_zone(k + 1)));
    if (laid && !zone.place.empty() && has_amount)
      fail(zone, "place", "a layer of a bed ends by its \"place\" or by its amount; leave one of them out");
    if ((zone.mesh || (!zone.place.empty() && !laid)) && scene.gap > 2 * scene.wall_gap)
      fail(
          zone, zone.mesh ? "mesh" : "place",
          fmt::format("spheres on both sides of its border would be nearer than \"gap\": give a \"wall_gap\" "
                      "of {:g}, half of it, in [spheres]",
                      scene.gap / 2));
  }
}

void complete_zones(Scene& scene) {
  for (std::size_t k = 0; k < scene.zones.size(); ++k) {
    Zone& zone = scene.zones[k];
    const std::string name = section_name_of_zone(k + 1);
    schema::check(schema::zone_entry(), &zone, {name, zone.locations});
    schema::check(schema::spheres_of_zone_entry(), &zone.spheres, {name, zone.spheres.locations});
    complete_density(zone.spheres);
  }
  if (scene.zones.empty()) return;
  require_zones(scene);
  for (Zone& zone : scene.zones) {
    Scene of = scene_of_zone(scene, zone);
    complete(of);
    zone.spheres.draw = of.draw;
  }
}

std::vector<SphereClass> classes_of(const Scene& scene) {
  std::vector<SphereClass> classes;
  for (std::size_t k = 0; k < scene.zones.size(); ++k) {
    auto [material, density] = material_in(scene, scene.zones[k].spheres);
    classes.push_back({name_of_zone(scene, k), std::move(material), density});
  }
  const bool has_layers = scene.zones.empty() && !scene.layers.empty();
  if (!scene.draws() && !has_layers) return classes;
  if (const auto* sizes = std::get_if<Classes>(&scene.sizes);
      scene.zones.empty() && sizes && !(sizes->names.empty() && sizes->layers.empty())) {
    const schema::Key plain{.name = "name", .type = schema::Type::text};
    for (std::size_t k = 0; k < sizes->values.size(); ++k) {
      const std::string name = sizes->names.empty() ? std::string() : sizes->names[k];
      const bool is_own = schema::accepts(plain, name) && std::ranges::count(sizes->names, name) == 1;
      const std::string word = is_own ? name : fmt::format("class {}", k + 1);
      classes.push_back(
          {word, word,
           sizes->material_densities.empty() ? scene.material_density : sizes->material_densities[k]});
    }
  } else if (!scene.zones.empty() || !scene.material.empty() || has_layers) {
    const bool is_plain =
        std::ranges::none_of(classes, [&](const SphereClass& other) { return other.name == scene.material; });
    const bool is_alone = scene.zones.empty() && scene.material.empty();
    classes.push_back({is_alone                              ? "spheres"
                       : scene.material.empty() || !is_plain ? "rest"
                                                             : scene.material,
                       scene.material, scene.material_density});
  }
  return classes;
}

std::vector<std::uint32_t> classes_by_size(const Packing& packing) {
  const Scene& scene = packing.scene;
  const std::size_t n = classes_of(scene).size();
  if (!scene.zones.empty() || n == 0) return {};
  std::vector<std::uint32_t> of(packing.spheres.size(), 0);
  const auto* sizes = std::get_if<Classes>(&scene.sizes);
  if (n < 2 || !sizes) return of;
  const double to_size = (scene.sizes_are_diameters ? 2.0 : 1.0) / (scene.scale * packing.size_scale);
  for (std::size_t i = 0; i < of.size(); ++i) {
    const std::optional<std::size_t> k = class_of(*sizes, to_size * packing.spheres.r[i]);
    if (!k) return {};
    of[i] = static_cast<std::uint32_t>(*k);
  }
  return of;
}

}  // namespace bernal

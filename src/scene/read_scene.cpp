#include "bernal/scene/read_scene.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "bernal/core/text.hpp"
#include "scene/insides.hpp"
#include "scene/output_table.hpp"
#include "scene/read_value.hpp"
#include "scene/scene_entries.hpp"
#include "scene/scene_of_table.hpp"
#include "scene/stage_table.hpp"
#include "scene/table_reader.hpp"
#include "scene/toml_file.hpp"
#include "scene/toml_text.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

using schema::Entry;

/// Reads a scene's file, table by table.
class Reader : private TableReader {
 public:
  explicit Reader(const std::filesystem::path& file, const std::optional<BallOfSphere>& ball = {})
      : TableReader(file), ball_(ball) {}

  Scene read_all(const toml::table& root) {
    Scene scene;
    scene.file = path_;
    check_tables(root);
    read_own(root, schema::scene_entry(), "the scene", scene);
    unit_ = scene.unit;
    read_container(root, scene);
    read_spheres(root, scene);
    read_zones(root, scene);
    if (root.contains("accuracy"))
      read_own(table_in(root, "accuracy"), schema::accuracy_entry(), "[accuracy]", scene);
    read_engine(root, scene);
    read_stages(root, scene);
    read_outputs(root, scene);
    try {
      complete(scene);
    } catch (const Error& error) {
      in_phi_.explain(error);
      throw;
    }
    return scene;
  }

  /// Of the container that gave way to a ball.
  const std::optional<double>& asked_radius() const { return asked_radius_; }

 private:
  /// A misspelt table is reported as such, before anything is missed for it.
  void check_tables(const toml::table& root) const {
    check_names(root, schema::scene_entry(), {tables.begin(), tables.end()}, "the scene");
    for (const std::string_view name : tables)
      if (const toml::node* node = root.get(name);
          node && name != "stage" && name != "output" && name != "zone" && !node->is_table())
        fail(node->source(), "\"{0}\" must be a table [{0}], not {1}", name, written(*node));
  }

  const toml::table& table_in(const toml::table& root, std::string_view name) const {
    const toml::node* node = root.get(name);
    if (!node) throw Error(ErrorCode::bad_scene, fmt::format("the scene has no [{}]", name), {file_});
    return *node->as_table();
  }

  /// A table whose keys are of the scene itself.
  void read_own(const toml::table& table, const Entry& entry, const std::string& name, Scene& scene) const {
    read(table, entry, {}, name, &scene, scene.locations);
    scene.locations.whole = {file_};
  }

  void read_container(const toml::table& root, Scene& scene) {
    if (ball_ && !root.contains("container")) {
      put_into_ball(scene, *ball_);
      return;
    }
    const toml::table& table = table_in(root, "container");
    read_solid(table, known_words_in(schema::container_entries()), "[container]", scene.container);
    if (!scene.container.meshes().empty()) require_unit(root, table);
    if (ball_) asked_radius_ = put_into_ball(scene, *ball_);
  }
  void require_unit(const toml::table& root, const toml::table& of_mesh) const {
    if (!root.contains("unit"))
      fail(of_mesh.source(),
           "a scene with a mesh needs a unit, such as unit = \"mm\", before its first table");
  }

  /// A container or an obstacle; `kinds` may stand there.
  void read_solid(const toml::table& table, const std::vector<KnownWord>& kinds, const std::string& where,
                  SceneContainer& solid) const {
    const auto& entries = schema::container_entries();
    const std::size_t kind = choose(table, "kind", kinds, where);
    const auto of_kind = std::ranges::find(entries, kinds[kind].name, &Entry::name);
    schema::hold(solid, static_cast<std::size_t>(of_kind - entries.begin()));
    read(table, *of_kind, {"kind"}, where, schema::options_of(solid), solid.locations);
    if (auto* mesh = std::get_if<MeshFile>(&solid))
      mesh->file = beside(solid.locations.of("file"), mesh->file);
    if (const toml::node* rounding = table.get("rounding"))
      solid.rounding = std::get<double>(read_value(*rounding, schema::rounding_key(), where));
    if (const toml::node* obstacles = table.get("obstacles")) read_obstacles(*obstacles, where, solid);
  }

  /// A file, or an array of files and tables.
  void read_obstacles(const toml::node& given, const std::string& where, SceneContainer& container) const {
    const auto refuse = [&](const toml::node& node) {
      fail(node.source(), "\"obstacles\" in {} must be {}, not {}", where,
           schema::expectation(schema::obstacles_key()), written(node));
    };
    const toml::array* array = given.as_array();
    if (array ? array->empty() : !given.is_string()) refuse(given);
    for (std::size_t k = 0; k < (array ? array->size() : 1); ++k) {
      const toml::node& node = array ? (*array)[k] : given;
      if (const toml::table* table = node.as_table()) {
        const std::string name = fmt::format("solid {} of obstacles of {}", k + 1, where);
        read_solid(*table, schema::kinds_of_solids(), name, container.obstacles.emplace_back());
        if (table->contains("obstacles")) fail(table->source(), "{} cannot have obstacles of its own", name);
        continue;
      }
      const auto name = node.value<std::string>();
      if (!name || !schema::accepts(schema::obstacles_key(), *name)) refuse(node);
      const std::filesystem::path file = beside(container.locations.of("obstacles"), *name);
      if (auto* mesh = std::get_if<MeshFile>(&container)) {
        mesh->obstacles.push_back(file);
      } else {
        container.obstacles.emplace_back(MeshFile{.file = file});
        container.obstacles.back().locations = {at(node.source()), {{"file", at(node.source())}}};
      }
    }
  }

  void read_engine(const toml::table& root, Scene& scene) const {
    if (!root.contains("engine")) return;
    const toml::table& table = table_in(root, "engine");
    SceneEngine& engine = scene.engine.emplace();
    schema::hold(engine, choose(table, "kind", known_words_in(schema::engine_entries()), "[engine]"));
    engine.locations.keys["kind"] = at(table.find("kind")->first.source());
    read(table, schema::entry_of(engine), {"kind"}, "[engine]", schema::options_of(engine), engine.locations);
  }

  /// Zones need no others beside theirs.
  void read_spheres(const toml::table& root, Scene& scene) {
    const bool has_zones = root.contains("zone");
    if (has_zones && !root.contains("spheres")) return;
    const toml::table& table = table_in(root, "spheres");
    sizes_are_diameters_ = table.contains("diameter");
    read_own(table, schema::spheres_entry(), "[spheres]", scene);
    if (!table.contains("radius") && !table.contains("diameter") && !table.contains("cells") &&
        !table.contains("start") && !has_zones)
      fail(table.source(), "[spheres] needs exactly one of \"radius\", \"diameter\"");
    if (scene.start.file) scene.start.file = beside(scene.locations.of("start"), *scene.start.file);
    for (Inside& inside : scene.inside) inside.scene = beside(inside.locations.of("scene"), inside.scene);
    scene.target.where = at(table.source());
    for (const char* key : {"bed", "top", "height", "bed_layers", "porosity", "bulk_density", "count", "mass",
                            "packing_fraction", "fill"})
      if (table.contains(key)) scene.target.where = scene.locations.of(key);
  }

  void read_zones(const toml::table& root, Scene& scene) {
    for (const toml::table* table : tables_in(root, "zone")) {
      Zone& zone = scene.zones.emplace_back();
      Scene& spheres = zone.spheres;
      const std::string where = section_name_of_zone(scene.zones.size());
      sizes_are_diameters_ = table->contains("diameter");
      read(*table, schema::zone_entry(), names_of(schema::spheres_of_zone_entry().keys), where, &zone,
           zone.locations);
      if (zone.mesh) {
        zone.mesh->file = beside(zone.locations.of("mesh"), zone.mesh->file);
        require_unit(root, *table);
      }
      spheres.file = path_;
      read(*table, schema::spheres_of_zone_entry(), names_of(schema::zone_entry().keys), where, &spheres,
           spheres.locations);
      spheres.target.where = spheres.locations.whole;
    }
  }

  /// All tables [[name]].
  std::vector<const toml::table*> tables_in(const toml::table& root, std::string_view name) const {
    std::vector<const toml::table*> all;
    const toml::node* node = root.get(name);
    if (!node) return all;
    if (const toml::array* array = node->as_array(); !array || array->empty() || !array->is_array_of_tables())
      fail(node->source(), "\"{0}\" must be one table [[{0}]] {1} {0}, not {2}", name,
           name == "output" ? "an" : "a", written(*node));
    for (const toml::node& item : *node->as_array()) all.push_back(item.as_table());
    return all;
  }

  void read_stages(const toml::table& root, Scene& scene) const {
    for (const toml::table* table : tables_in(root, "stage")) {
      const StageTable& stage =
          *stage_tables()[choose(*table, "do", known_words_in(stage_tables()), "[[stage]]")];
      Stage& made = scene.stages.emplace_back(stage.make());
      read(*table, stage.keys, {"do"}, fmt::format("[[stage]] {}", stage.name()), stage.options_of(made),
           made.locations);
    }
  }

  void read_outputs(const toml::table& root, Scene& scene) const {
    for (const toml::table* table : tables_in(root, "output")) {
      const OutputTable& format =
          *output_tables()[choose(*table, "format", known_words_in(output_tables()), "[[output]]")];
      Output& made = scene.outputs.emplace_back(Output{.format = std::string(format.name())});
      read(*table, format.keys, {"format"}, fmt::format("[[output]] {}", format.name()), &made,
           made.locations);
    }
  }

  static constexpr std::array<std::string_view, 7> tables = {"container", "spheres", "zone",  "accuracy",
                                                             "engine",    "stage",   "output"};

  std::optional<BallOfSphere> ball_;  ///< that takes the place of the container
  std::optional<double> asked_radius_;
};

std::string read_text_of_scene(const std::filesystem::path& file) {
  constexpr std::streamsize largest = 1 << 20;
  return read_toml_text(file, "scene", largest, "no scene is; is it the mesh?");
}

}  // namespace

SceneInside read_scene_inside(const std::filesystem::path& file, const BallOfSphere& ball) {
  const std::string text = read_text_of_scene(file);
  if (is_blank(text))
    throw Error(ErrorCode::bad_scene, "the scene is empty; it needs at least [spheres]", {file.string()});
  Reader reader(file, ball);
  SceneInside read{reader.read_all(parse_toml(text, file))};
  read.asked_radius = reader.asked_radius();
  return read;
}

Scene scene_of_table(const toml::table& root, const std::filesystem::path& file) {
  return Reader(file).read_all(root);
}

Scene parse_scene(std::string_view toml, const std::filesystem::path& name) {
  if (is_blank(toml))
    throw Error(ErrorCode::bad_scene, "the scene is empty; it needs at least [container] and [spheres]",
                {name.string()});
  return scene_of_table(parse_toml(toml, name), name);
}

Scene read_scene(const std::filesystem::path& file) { return parse_scene(read_text_of_scene(file), file); }

}  // namespace bernal

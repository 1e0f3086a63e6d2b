#include "bernal/scene/read_scene.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "bernal/core/text.hpp"
#include "scene/insides.hpp"
#include "scene/keys_from_columns.hpp"
#include "scene/known_words.hpp"
#include "scene/output_table.hpp"
#include "scene/read_value.hpp"
#include "scene/said_in_phi.hpp"
#include "scene/scene_entries.hpp"
#include "scene/scene_of_table.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_file.hpp"
#include "scene/toml_text.hpp"
#include "scene/zones.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;
using schema::Type;
using schema::Value;
using Names = std::vector<std::string_view>;

Names names_of(const auto& entries) {
  Names names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

/// Reads tables of a scene's file into the structs of their entries. Every error is an Error{bad_scene} with
/// the file, the line and the remedy; `where` is what it calls the table: "[container]".
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file, const std::optional<BallOfSphere>& ball = {})
      : path_(file), file_(file.string()), ball_(ball) {}

  Scene read(const toml::table& root) {
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

  void read_container(const toml::table& root, Scene& scene) const {
    if (ball_ && !root.contains("container")) {
      put_into_ball(scene, *ball_);
      return;
    }
    const toml::table& table = table_in(root, "container");
    read_solid(table, known_words_in(schema::container_entries()), "[container]", scene.container);
    if (!scene.container.meshes().empty() && !root.contains("unit"))
      fail(table.source(), "a scene with a mesh needs a unit, such as unit = \"mm\", before its first table");
    if (ball_) put_into_ball(scene, *ball_);
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
    if (!table.contains("radius") && !table.contains("diameter") && !table.contains("start") && !has_zones)
      fail(table.source(), "[spheres] needs exactly one of \"radius\", \"diameter\"");
    if (scene.start.file) scene.start.file = beside(scene.locations.of("start"), *scene.start.file);
    if (const toml::node* inside = table.get("inside")) read_insides(*inside, scene);
    scene.target.where = at(table.source());
    for (const char* key : {"bed", "top", "height", "bed_layers", "porosity", "bulk_density", "count", "mass",
                            "packing_fraction", "fill"})
      if (table.contains(key)) scene.target.where = scene.locations.of(key);
  }

  /// A table, or an array of them.
  void read_insides(const toml::node& given, Scene& scene) const {
    const toml::array* array = given.as_array();
    const auto refuse = [&](const toml::node& node) {
      fail(node.source(), "\"inside\" in [spheres] must be {}, not {}",
           schema::expectation(schema::insides_key()), written(node));
    };
    if (array ? array->empty() : !given.is_table()) refuse(given);
    for (std::size_t k = 0; k < (array ? array->size() : 1); ++k) {
      const toml::node& node = array ? (*array)[k] : given;
      if (!node.is_table()) refuse(node);
      Inside& made = scene.inside.emplace_back();
      const std::string where = section_name_of_inside(scene, k);
      read(*node.as_table(), schema::inside_entry(), {}, where, &made, made.locations);
      if (made.scene.empty())
        fail(node.source(), "missing \"scene\" in {}; it names the scene of what lies inside", where);
      made.scene = beside(made.locations.of("scene"), made.scene);
    }
  }

  void read_zones(const toml::table& root, Scene& scene) {
    for (const toml::table* table : tables_in(root, "zone")) {
      Zone& zone = scene.zones.emplace_back();
      Scene& spheres = zone.spheres;
      const std::string where = section_name_of_zone(scene.zones.size());
      sizes_are_diameters_ = table->contains("diameter");
      read(*table, schema::zone_entry(), names_of(schema::spheres_of_zone_entry().keys), where, &zone,
           zone.locations);
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

  Location at(const toml::source_region& where) const { return location_of(where, file_); }

  /// Reports the first key, in the order of the file, that is neither one of the entry's nor one of `others`.
  void check_names(const toml::table& table, const Entry& entry, const Names& others,
                   std::string_view where) const {
    Names known = names_of(entry.keys);
    known.insert(known.end(), others.begin(), others.end());
    const toml::key* unknown = nullptr;
    for (const auto& [key, node] : table) {
      if (std::ranges::find(known, key.str()) != known.end()) continue;
      if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
    }
    if (!unknown) return;
    const auto number = [&](std::string_view key) { return table[key].value<double>(); };
    const std::string instead = schema::instead_of(entry, unknown->str(), number);
    fail(unknown->source(), "unknown key {} in {}{}", toml_string(unknown->str()), where,
         instead.empty() ? remedy(unknown->str(), known) : instead);
  }

  /// Which of several words a table has under `selector`, by its place among them.
  std::size_t choose(const toml::table& table, std::string_view selector, const std::vector<KnownWord>& known,
                     std::string_view where) const {
    const toml::node* node = table.get(selector);
    const Names names = names_of(known);
    if (!node)
      fail(table.source(), "missing \"{}\" in {}; it is one of \"{}\"", selector, where,
           fmt::join(names, "\", \""));
    const auto* word = node->as_string();
    if (!word)
      fail(node->source(), "\"{}\" in {} must be one of \"{}\", not {}", selector, where,
           fmt::join(names, "\", \""), written(*node));
    const auto found = std::ranges::find(names, word->get());
    if (found == names.end())
      fail(node->source(), "unknown {} {} in {}{}", selector == "do" ? "stage" : selector, written(*node),
           where, remedy_of_word(word->get(), known));
    return static_cast<std::size_t>(found - names.begin());
  }

  /// The node as a value, whatever the key accepts. Refuses text that is no number with its unit where one is
  /// meant.
  std::optional<Value> value_of(const toml::node& node, const Key& key, const std::string& where) const {
    Measured measured{key.measured(), unit_};
    if (measured.quantity == Quantity::diameter && !sizes_are_diameters_)
      measured.quantity = Quantity::length;
    const bool line = key.type == Type::points;
    try {
      if (measured.quantity == Quantity::diameter) in_phi_.note(node, key.name, at(node.source()).line);
      return line || key.type == Type::lines ? lines_in(node, line, measured)
             : key.type == Type::names       ? names_in(node, measured)
                                             : value_in(node, key.type != Type::integer, measured, key.words);
    } catch (const Error& error) {
      fail(node.source(), "\"{}\" in {} must be {}, not {}: {}", key.name, where, schema::expectation(key),
           written(node), error.what());
    }
  }

  Value read_value(const toml::node& node, const Key& key, const std::string& where) const {
    if (key.type == Type::distribution) return std::vector{read_sizes(node, key, where)};
    if (key.type == Type::parts) return read_parts(node, key, where);
    const std::optional<Value> value = value_of(node, key, where);
    if (value && schema::accepts(key, *value)) return *value;
    if (const auto k = key.type == Type::points ? first_that_is_no_point(node) : std::nullopt)
      fail(node.as_array()->get(*k)->source(), "point {} of \"{}\" in {} must be two numbers {}, not {}",
           *k + 1, key.name, where, key.name == "profile" ? "[r, z]" : "[x, y]",
           written(*node.as_array()->get(*k)));
    if (key.type == Type::word && node.is_string())
      fail(node.source(), "\"{}\" in {} is not {}{}", key.name, where, written(node),
           remedy_of_word(std::get<std::string>(*value), {key.words.begin(), key.words.end()}));
    fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
         written(node));
  }

  /// All keys of an entry that the table has, besides `others`; what is missing, `complete` finds. Refuses
  /// unknown ones, except at the top of the file, where the tables stand between the keys: there
  /// `check_names` does.
  void read(const toml::table& table, const Entry& entry, const Names& others, const std::string& where,
            void* options, Locations& locations) const {
    if (&entry != &schema::scene_entry()) check_names(table, entry, others, where);
    if (locations.whole.file.empty()) locations.whole = at(table.source());
    for (const Key& key : entry.keys) {
      const auto found = table.find(key.name);
      if (found == table.end()) continue;
      locations.keys[std::string(key.name)] = at(found->first.source());
      if (!key.member.set && key.type != Type::file) continue;  // see `read_solid`
      if (key.member.set) {
        key.member.set(options, read_value(found->second, key, where));
        continue;
      }
      for (const Key& other : entry.keys)
        if (comes_from_file(entry, other) && table.contains(other.name))
          fail(found->first.source(), "\"{}\" and \"{}\" in {} exclude each other; give one of them",
               other.name, key.name, where);
      take_columns(found->second, entry, where, options, locations);
    }
  }

  /// Puts what stands in the file in its place, so that the scene is whole without the file.
  void take_columns(const toml::node& node, const Entry& entry, const std::string& where, void* options,
                    Locations& locations) const {
    const std::string file = std::get<std::string>(read_value(node, *entry.find("file"), where));
    const Location at_file = locations.of("file");
    try {
      for (const Key* key : keys_from_columns(beside(at_file, file), entry, unit_, options))
        locations.keys[std::string(key->name)] = at_file;
    } catch (const Error& error) {
      if (!error.location().file.empty()) throw;
      throw Error(error.code(), fmt::format("\"file\" in {}: {}", where, error.what()), at_file);
    }
  }

  /// A plain length, whose key says what it must be, is a constant distribution.
  SceneSizes read_sizes(const toml::node& node, const Key& key, const std::string& where) const {
    SceneSizes sizes;
    if (const toml::table* table = node.as_table()) {
      const std::string named = fmt::format("{} of {}", key.name, where);
      const auto& entries = schema::size_entries();
      const std::size_t n = choose(*table, "distribution", known_words_in(entries), named);
      schema::hold(sizes, n);
      read(*table, entries[n], {"distribution"}, named, schema::options_of(sizes), sizes.locations);
      return sizes;
    }
    if (const auto* word = node.as_string();
        word && std::ranges::find(key.words, word->get()) != key.words.end()) {
      sizes = Constant{std::numeric_limits<double>::infinity()};  // as its member takes it
      sizes.locations.whole = sizes.locations.keys["value"] = at(node.source());
      return sizes;
    }
    const Key length = {.name = key.name, .type = Type::length};
    const auto value = value_of(node, schema::of_quantity(Quantity::diameter, key), where);
    if (!value || !schema::accepts(length, *value))
      fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
           written(node));
    sizes = Constant{std::get<double>(*value)};
    sizes.locations.whole = sizes.locations.keys["value"] = at(node.source());
    return sizes;
  }

  std::vector<SceneSizes> read_parts(const toml::node& node, const Key& key, const std::string& where) const {
    const toml::array* array = node.as_array();
    if (!array || array->empty())
      fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key),
           written(node));
    std::vector<SceneSizes> parts;
    for (const toml::node& item : *array) {
      const std::string name = fmt::format("part {}", parts.size() + 1);
      parts.push_back(read_sizes(item, {.name = name, .type = Type::distribution}, where));
    }
    return parts;
  }

  template <class... Args>
  [[noreturn]] void fail(const toml::source_region& where, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw Error(ErrorCode::bad_scene, fmt::format(format, std::forward<Args>(args)...), at(where));
  }

  static constexpr std::array<std::string_view, 7> tables = {"container", "spheres", "zone",  "accuracy",
                                                             "engine",    "stage",   "output"};

  std::filesystem::path path_;
  std::string file_;
  std::optional<BallOfSphere> ball_;  ///< that takes the place of its container
  Unit unit_ = {};                    ///< of the scene, once it is read
  bool sizes_are_diameters_ = false;
  mutable SaidInPhi in_phi_;
};

std::string read_text_of_scene(const std::filesystem::path& file) {
  constexpr std::streamsize largest = 1 << 20;
  return read_toml_text(file, "scene", largest, "no scene is; is it the mesh?");
}

}  // namespace

Scene read_scene_inside(const std::filesystem::path& file, const BallOfSphere& ball) {
  const std::string text = read_text_of_scene(file);
  if (is_blank(text))
    throw Error(ErrorCode::bad_scene, "the scene is empty; it needs at least [spheres]", {file.string()});
  return Reader(file, ball).read(parse_toml(text, file));
}

Scene scene_of_table(const toml::table& root, const std::filesystem::path& file) {
  return Reader(file).read(root);
}

Scene parse_scene(std::string_view toml, const std::filesystem::path& name) {
  if (is_blank(toml))
    throw Error(ErrorCode::bad_scene, "the scene is empty; it needs at least [container] and [spheres]",
                {name.string()});
  return scene_of_table(parse_toml(toml, name), name);
}

Scene read_scene(const std::filesystem::path& file) { return parse_scene(read_text_of_scene(file), file); }

}  // namespace bernal

#include "bernal/scene/read_scene.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "scene/read_columns.hpp"
#include "scene/schema.hpp"
#include "scene/toml_text.hpp"
#include "scene/toml_values.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;
using schema::Type;
using Names = std::vector<std::string_view>;

Names names_of(const std::vector<Entry>& entries) {
  Names names;
  for (const Entry& entry : entries) names.push_back(entry.name);
  return names;
}

Names names_of(const std::vector<Key>& keys) {
  Names names;
  for (const Key& key : keys) names.push_back(key.name);
  return names;
}

/// `; did you mean "diameter"?` or, where nothing is near, `; known: "count", "radius"`.
std::string remedy(std::string_view name, const Names& candidates) {
  if (const std::string_view near = nearest_name(name, candidates); !near.empty())
    return fmt::format("; did you mean \"{}\"?", near);
  return fmt::format("; known: \"{}\"", fmt::join(candidates, "\", \""));
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : path_(file), file_(file.string()) {}

  Scene read(std::string_view text) const {
    const toml::table root = parse(text);
    Scene scene;
    scene.file = path_;
    check_tables(root);
    const Spec top = read_keys(root, all_.scene, {}, "the scene");
    scene.unit = top.text("unit");
    scene.seed = static_cast<std::uint64_t>(top.integer("seed"));
    read_container(root, scene);
    read_spheres(table_in(root, "spheres"), scene);
    read_accuracy(root, scene);
    read_stages(root, scene);
    take_target_of_fly(scene);
    if (scene.draw.empty()) scene.draw = default_draw(scene);
    return scene;
  }

 private:
  template <class... Args>
  [[noreturn]] void fail(const toml::source_region& where, fmt::format_string<Args...> format,
                         Args&&... args) const {
    throw Error(ErrorCode::bad_scene, fmt::format(format, std::forward<Args>(args)...), at(where));
  }

  Location at(const toml::source_region& where) const {
    return {file_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column)};
  }

  toml::table parse(std::string_view text) const {
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
    if (std::ranges::all_of(text, blank))
      throw Error(ErrorCode::bad_scene, "the scene is empty; it needs at least [container] and [spheres]",
                  {file_});
    try {
      return toml::parse(text, file_);
    } catch (const toml::parse_error& error) {
      std::string what(error.description());
      std::ranges::replace_if(
          what, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
      fail(error.source(), "this is not TOML: {}", what);
    }
  }

  /// A misspelt table is reported as such, before anything is missed for it.
  void check_tables(const toml::table& root) const {
    Names known = names_of(all_.scene.keys);
    known.insert(known.end(), tables.begin(), tables.end());
    check_names(root, known, "the scene");
    for (const std::string_view name : tables)
      if (const toml::node* node = root.get(name); node && name != "stage" && !node->is_table())
        fail(node->source(), "\"{0}\" must be a table [{0}], not {1}", name, written(*node));
  }

  /// Reports the first unknown key in the order of the file.
  void check_names(const toml::table& table, const Names& known, std::string_view where) const {
    const toml::key* unknown = nullptr;
    for (const auto& [key, node] : table) {
      if (std::ranges::find(known, key.str()) != known.end()) continue;
      if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
    }
    if (unknown)
      fail(unknown->source(), "unknown key {} in {}{}", toml_string(unknown->str()), where,
           remedy(unknown->str(), known));
  }

  const toml::table& table_in(const toml::table& root, std::string_view name) const {
    const toml::node* node = root.get(name);
    if (!node) throw Error(ErrorCode::bad_scene, fmt::format("the scene has no [{}]", name), {file_});
    return *node->as_table();
  }

  /// Which of several entries a table is, by the word under `selector`.
  const Entry& choose(const toml::table& table, std::string_view selector, const std::vector<Entry>& entries,
                      std::string_view where) const {
    const Names names = names_of(entries);
    const toml::node* node = table.get(selector);
    if (!node)
      fail(table.source(), "missing \"{}\" in {}; it is one of \"{}\"", selector, where,
           fmt::join(names, "\", \""));
    const auto* word = node->as_string();
    if (!word)
      fail(node->source(), "\"{}\" in {} must be one of \"{}\", not {}", selector, where,
           fmt::join(names, "\", \""), written(*node));
    const Entry* entry = schema::Schema::find(entries, word->get());
    if (!entry)
      fail(node->source(), "unknown {} {} in {}{}", selector == "do" ? "stage" : selector, written(*node),
           where, remedy(word->get(), names));
    return *entry;
  }

  /// The keys that the choices of an entry leave out of this table. Throws where two sets are mixed or none
  /// is given that is needed.
  Names left_out(const toml::table& table, const Entry& entry, std::string_view where) const {
    Names out;
    for (const schema::Choice& choice : entry.choices) {
      const auto needs_nothing = [&](const Names& set) {
        return std::ranges::all_of(set,
                                   [&](std::string_view key) { return bool(entry.find(key)->otherwise); });
      };
      const auto holds = [](const Names& set, std::string_view key) {
        return std::ranges::find(set, key) != set.end();
      };
      Names given;
      std::vector<std::string> sets;
      for (const Names& set : choice) {
        if (!set.empty()) sets.push_back(fmt::format("\"{}\"", fmt::join(set, "\" and \"")));
        for (const std::string_view key : set)
          if (table.contains(key) && !holds(given, key)) given.push_back(key);
      }
      const auto chosen = std::ranges::find_if(choice, [&](const Names& set) {
        return given.empty()
                   ? needs_nothing(set)
                   : std::ranges::all_of(given, [&](std::string_view key) { return holds(set, key); });
      });
      if (chosen == choice.end() && given.empty())
        fail(table.source(), "{} needs exactly one of {}", where, fmt::join(sets, ", "));
      if (chosen == choice.end()) {
        const auto first =
            std::ranges::find_if(choice, [&](const Names& set) { return holds(set, given[0]); });
        const auto other =
            std::ranges::find_if(given, [&](std::string_view key) { return !holds(*first, key); });
        fail(table.find(*other)->first.source(),
             "\"{}\" and \"{}\" in {} exclude each other; give one of them", given[0], *other, where);
      }
      for (const Names& set : choice)
        for (const std::string_view key : set)
          if (!holds(*chosen, key)) out.push_back(key);
    }
    return out;
  }

  /// Reads and checks one key.
  Value read_value(const toml::node& node, const Key& key, std::string_view where) const {
    const bool is_word = key.type == Type::number && !key.words.empty() && node.is_string();
    const std::optional<Value> value = value_in(node, is_word ? Type::word : key.type);
    if (value && schema::accepts(key, *value)) return *value;
    if (value && (key.type == Type::unit || key.type == Type::word)) {
      Names words = key.words;
      if (key.type == Type::unit)
        for (const Unit& unit : units()) words.push_back(unit.name);
      const std::string& word = std::get<std::string>(*value);
      fail(node.source(), "\"{}\" in {} is not {}{}", key.name, where, written(node), remedy(word, words));
    }
    fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
         written(node));
  }

  /// All keys of an entry but its radius or diameter, with defaults filled in.
  Spec read_keys(const toml::table& table, const Entry& entry, std::string_view selector,
                 const std::string& where) const {
    Names known = names_of(entry.keys);
    if (!selector.empty()) known.push_back(selector);
    if (&entry != &all_.scene) check_names(table, known, where);
    const Names absent = left_out(table, entry, where);

    Spec spec{std::string(entry.name), {}, at(table.source())};
    for (const Key& key : entry.keys) {
      const auto found = table.find(key.name);
      const bool given = found != table.end();
      if (key.type == Type::distribution || std::ranges::find(absent, key.name) != absent.end()) continue;
      if (!given && !key.otherwise && !key.optional)
        fail(table.source(), "missing \"{}\" in {}: {}, {}", key.name, where, schema::expectation(key),
             key.help);
      if (key.type == Type::parts)
        spec.parts = read_parts(found->second, key, where);
      else if (given)
        spec.parameters[std::string(key.name)] = {read_value(found->second, key, where),
                                                  at(found->first.source())};
      else if (key.otherwise)
        spec.parameters[std::string(key.name)] = {*key.otherwise, {file_}};
    }
    if (!entry.columns.empty() && spec.has("file")) take_columns(spec, entry, where);
    if (entry.rule) entry.rule(spec, where);
    return spec;
  }

  /// Puts what stands in the spec's file in its place, so that the scene is whole without the file.
  void take_columns(Spec& spec, const Entry& entry, const std::string& where) const {
    const Location at_file = spec.location("file");
    const std::array keys = {entry.find(entry.columns.at(0)), entry.find(entry.columns.at(1))};
    try {
      const auto columns = read_columns(path_.parent_path() / spec.text("file"), keys);
      for (std::size_t k = 0; k < keys.size(); ++k)
        spec.parameters[std::string(keys[k]->name)] = {columns[k], at_file};
    } catch (const Error& error) {
      if (!error.location().file.empty()) throw;
      throw Error(error.code(), fmt::format("\"file\" in {}: {}", where, error.what()), at_file);
    }
    spec.parameters.erase("file");
  }

  void read_container(const toml::table& root, Scene& scene) const {
    const toml::table& table = table_in(root, "container");
    const Entry& entry = choose(table, "kind", all_.containers, "[container]");
    scene.container = read_keys(table, entry, "kind", "[container]");
    if (scene.is_periodic() && !scene.container.has("size") && !scene.container.has("edge"))
      scene.container.parameters["scalable"].value = true;
    if (entry.name != "mesh") return;
    if (!root.contains("unit"))
      fail(table.source(), "a scene with a mesh needs a unit, such as unit = \"mm\", before its first table");
    auto& parameters = scene.container.parameters;
    parameters.try_emplace("unit", Parameter{scene.unit, {file_}});
    std::filesystem::path mesh = scene.container.text("file");
    if (mesh.is_relative()) mesh = (path_.parent_path() / mesh).lexically_normal();
    parameters["file"].value = mesh.string();
  }

  void read_spheres(const toml::table& table, Scene& scene) const {
    const Spec spec = read_keys(table, all_.spheres, {}, "[spheres]");
    scene.target.where = spec.where;
    if (spec.has("count")) scene.target.count = spec.integer("count");
    if (spec.has("packing_fraction")) {
      scene.target.predicted =
          std::holds_alternative<std::string>(spec.parameters.at("packing_fraction").value);
      if (!scene.target.predicted) scene.target.packing_fraction = spec.number("packing_fraction");
    }
    scene.target.fill = spec.has("fill");
    if (scene.target.fill && !spec.flag("fill"))
      fail(table.get("fill")->source(),
           "\"fill\" in [spheres] can only be true; give \"count\" or \"packing_fraction\" instead");
    for (const std::string_view key : {"count", "packing_fraction", "fill"})
      if (spec.has(key) && spec.location(key).line > 0) scene.target.where = spec.location(key);

    check_target(scene);

    scene.sizes_are_diameters = table.contains("diameter");
    const std::string_view key = scene.sizes_are_diameters ? "diameter" : "radius";
    scene.sizes = read_distribution(*table.get(key), *all_.spheres.find(key), "[spheres]");
    if (!scene.sizes_are_diameters) refuse_diameters(scene.sizes);
    scene.draw = spec.has("draw") ? spec.text("draw") : "";
  }

  /// What the target and a periodic box demand of each other.
  void check_target(const Scene& scene) const {
    const Target& target = scene.target;
    const auto fail = [&](const char* message) { throw Error(ErrorCode::bad_scene, message, target.where); };
    const bool scalable = scene.is_periodic() && scene.container.flag("scalable");
    if (target.count && target.has_packing_fraction() && !scalable)
      fail(
          "\"count\" and \"packing_fraction\" in [spheres] exclude each other; give one of them (both go "
          "together only in a periodic box without size)");
    if (scalable && !target.count)
      fail("a periodic box without size needs a \"count\" in [spheres]; or give it \"size\" or \"edge\"");
  }

  /// A plain length, whose key says what it must be, is a constant distribution.
  Spec read_distribution(const toml::node& node, const Key& key, const std::string& where) const {
    const toml::table* table = node.as_table();
    if (!table)
      return {"constant", {{"value", {read_value(node, key, where), at(node.source())}}}, at(node.source())};
    const std::string named = fmt::format("{} of {}", key.name, where);
    return read_keys(*table, choose(*table, "distribution", all_.distributions, named), "distribution",
                     named);
  }

  std::vector<Spec> read_parts(const toml::node& node, const Key& key, const std::string& where) const {
    const toml::array* array = node.as_array();
    if (!array || array->empty())
      fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key),
           written(node));
    std::vector<Spec> parts;
    for (const toml::node& item : *array) {
      const std::string name = fmt::format("part {}", parts.size() + 1);
      parts.push_back(read_distribution(item, {.name = name, .type = Type::distribution, .help = {}}, where));
    }
    return parts;
  }

  /// A size that is a diameter by its name cannot be a radius.
  void refuse_diameters(const Spec& sizes) const {
    for (const Key& key : schema::Schema::find(all_.distributions, sizes.name)->keys)
      if (key.is_diameter && sizes.has(key.name))
        throw Error(ErrorCode::bad_scene,
                    fmt::format("\"{}\" is a diameter; write diameter = {{…}}, not radius", key.name),
                    sizes.location(key.name));
    for (const Spec& part : sizes.parts) refuse_diameters(part);
  }

  void read_accuracy(const toml::table& root, Scene& scene) const {
    const toml::table none;
    const Spec spec = read_keys(root.contains("accuracy") ? table_in(root, "accuracy") : none, all_.accuracy,
                                {}, "[accuracy]");
    scene.walls = spec.text("walls");
    scene.overlap = spec.number("overlap");
  }

  void read_stages(const toml::table& root, Scene& scene) const {
    const toml::node* node = root.get("stage");
    scene.stages_are_default = !node;
    if (!node) {
      for (const std::string_view name :
           schema::Schema::find(all_.containers, scene.container.name)->protocol)
        scene.stages.push_back(
            read_stage({}, *schema::Schema::find(all_.stages_for(scene), name), "[[stage]]", scene));
      return;
    }
    const toml::array* stages = node->as_array();
    if (!stages || stages->empty() || !stages->is_array_of_tables())
      fail(node->source(), "\"stage\" must be one table [[stage]] a stage, not {}", written(*node));
    for (const toml::node& item : *stages) {
      const toml::table& table = *item.as_table();
      const Entry& entry = choose(table, "do", all_.stages_for(scene), "[[stage]]");
      scene.stages.push_back(read_stage(table, entry, fmt::format("[[stage]] {}", entry.name), scene));
    }
  }

  /// What `fly` fills the box to is the scene's target.
  void take_target_of_fly(Scene& scene) const {
    Target& target = scene.target;
    for (Spec& stage : scene.stages) {
      if (stage.name != "fly" || !stage.has("packing_fraction")) continue;
      const bool scalable = scene.container.flag("scalable");
      if (target.packing_fraction || target.fill || (target.count && !scalable))
        throw Error(ErrorCode::bad_scene,
                    "\"packing_fraction\" in [[stage]] fly says again what [spheres] says; leave it out",
                    stage.location("packing_fraction"));
      target.packing_fraction = stage.number("packing_fraction");
      target.where = stage.location("packing_fraction");
      stage.parameters.erase("packing_fraction");
    }
  }

  /// Relaxation and growth in a container keep the sizes exactly as they are drawn: then these may as well be
  /// exact.
  static std::string default_draw(const Scene& scene) {
    const bool keeps_sizes = std::ranges::any_of(
        scene.stages, [](const Spec& stage) { return stage.name == "relax" || stage.name == "grow"; });
    return keeps_sizes && !scene.is_periodic() ? "quantiles" : "random";
  }

  Spec read_stage(const toml::table& table, const Entry& entry, const std::string& where,
                  const Scene& scene) const {
    Spec stage = read_keys(table, entry, "do", where);
    if (entry.complete) entry.complete(stage, scene);
    return stage;
  }

  static constexpr std::array<std::string_view, 4> tables = {"container", "spheres", "accuracy", "stage"};

  const schema::Schema& all_ = schema::schema();
  std::filesystem::path path_;
  std::string file_;
};

}  // namespace

Scene parse_scene(std::string_view toml, const std::filesystem::path& name) {
  return Reader(name).read(toml);
}

Scene read_scene(const std::filesystem::path& file) {
  constexpr std::streamsize largest = 1 << 20;
  const auto fail = [&](const std::string& why) { throw Error(ErrorCode::bad_scene, why, {file.string()}); };
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) fail("no such scene file");
  if (std::filesystem::is_directory(status)) fail("this is a folder, not a scene file");
  std::ifstream in(file, std::ios::binary);
  if (!in) fail("the scene file cannot be opened for reading");
  std::string text(largest + 1, '\0');
  in.read(text.data(), largest + 1);
  if (in.bad()) fail("the scene file cannot be read");
  if (in.gcount() > largest) fail("the file is larger than 1 MiB, which no scene is; is it the mesh?");
  text.resize(static_cast<std::size_t>(in.gcount()));
  return parse_scene(text, file);
}

}  // namespace bernal

#include "bernal/scene/read_scene.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/entry_reader.hpp"
#include "scene/schema.hpp"
#include "scene/toml_values.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : path_(file), file_(file.string()), entries_(file) {}

  Scene read(std::string_view text) const {
    const toml::table root = parse(text);
    Scene scene;
    scene.file = path_;
    check_tables(root);
    const Spec top = entries_.read(root, all_.scene, {}, "the scene");
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
      entries_.fail(error.source(), "this is not TOML: {}", what);
    }
  }

  /// A misspelt table is reported as such, before anything is missed for it.
  void check_tables(const toml::table& root) const {
    entries_.check_names(root, all_.scene, {tables.begin(), tables.end()}, "the scene");
    for (const std::string_view name : tables)
      if (const toml::node* node = root.get(name); node && name != "stage" && !node->is_table())
        entries_.fail(node->source(), "\"{0}\" must be a table [{0}], not {1}", name, written(*node));
  }

  const toml::table& table_in(const toml::table& root, std::string_view name) const {
    const toml::node* node = root.get(name);
    if (!node) throw Error(ErrorCode::bad_scene, fmt::format("the scene has no [{}]", name), {file_});
    return *node->as_table();
  }

  void read_container(const toml::table& root, Scene& scene) const {
    const toml::table& table = table_in(root, "container");
    const Entry& entry = entries_.choose(table, "kind", all_.containers, "[container]");
    scene.container = entries_.read(table, entry, "kind", "[container]");
    if (scene.is_periodic() && !scene.container.has("size") && !scene.container.has("edge"))
      scene.container.parameters["scalable"].value = true;
    if (entry.name != "mesh") return;
    if (!root.contains("unit"))
      entries_.fail(table.source(),
                    "a scene with a mesh needs a unit, such as unit = \"mm\", before its first table");
    auto& parameters = scene.container.parameters;
    parameters.try_emplace("unit", Parameter{scene.unit, {file_}});
    std::filesystem::path mesh = scene.container.text("file");
    if (mesh.is_relative()) mesh = (path_.parent_path() / mesh).lexically_normal();
    parameters["file"].value = mesh.string();
  }

  void read_spheres(const toml::table& table, Scene& scene) const {
    const Spec spec = entries_.read(table, all_.spheres, {}, "[spheres]");
    scene.target.where = spec.where;
    if (spec.has("count")) scene.target.count = spec.integer("count");
    if (spec.has("packing_fraction")) {
      scene.target.predicted =
          std::holds_alternative<std::string>(spec.parameters.at("packing_fraction").value);
      if (!scene.target.predicted) scene.target.packing_fraction = spec.number("packing_fraction");
    }
    scene.target.fill = spec.has("fill");
    if (scene.target.fill && !spec.flag("fill"))
      entries_.fail(table.get("fill")->source(),
                    "\"fill\" in [spheres] can only be true; give \"count\" or \"packing_fraction\" instead");
    for (const std::string_view key : {"count", "packing_fraction", "fill"})
      if (spec.has(key) && spec.location(key).line > 0) scene.target.where = spec.location(key);

    check_target(scene);

    scene.sizes_are_diameters = table.contains("diameter");
    const std::string_view key = scene.sizes_are_diameters ? "diameter" : "radius";
    scene.sizes = entries_.read_distribution(*table.get(key), *all_.spheres.find(key), "[spheres]");
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
    const Spec spec = entries_.read(root.contains("accuracy") ? table_in(root, "accuracy") : none,
                                    all_.accuracy, {}, "[accuracy]");
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
      entries_.fail(node->source(), "\"stage\" must be one table [[stage]] a stage, not {}", written(*node));
    for (const toml::node& item : *stages) {
      const toml::table& table = *item.as_table();
      const Entry& entry = entries_.choose(table, "do", all_.stages_for(scene), "[[stage]]");
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
    Spec stage = entries_.read(table, entry, "do", where);
    if (entry.complete) entry.complete(stage, scene);
    return stage;
  }

  static constexpr std::array<std::string_view, 4> tables = {"container", "spheres", "accuracy", "stage"};

  const schema::Schema& all_ = schema::schema();
  std::filesystem::path path_;
  std::string file_;
  EntryReader entries_;
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

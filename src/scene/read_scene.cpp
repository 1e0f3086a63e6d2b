#include "bernal/scene/read_scene.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "scene/entry_reader.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_values.hpp"

namespace bernal {
namespace {

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : path_(file), file_(file.string()), entries_(file) {}

  Scene read(std::string_view text) const {
    const toml::table root = parse(text);
    Scene scene;
    scene.file = path_;
    check_tables(root);
    read_own(root, schema::scene_entry(), "the scene", scene);
    read_container(root, scene);
    read_spheres(table_in(root, "spheres"), scene);
    if (root.contains("accuracy"))
      read_own(table_in(root, "accuracy"), schema::accuracy_entry(), "[accuracy]", scene);
    read_stages(root, scene);
    complete(scene);
    return scene;
  }

 private:
  toml::table parse(std::string_view text) const {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
    if (std::ranges::all_of(text, is_blank))
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
    entries_.check_names(root, schema::scene_entry(), {tables.begin(), tables.end()}, "the scene");
    for (const std::string_view name : tables)
      if (const toml::node* node = root.get(name); node && name != "stage" && !node->is_table())
        entries_.fail(node->source(), "\"{0}\" must be a table [{0}], not {1}", name, written(*node));
  }

  const toml::table& table_in(const toml::table& root, std::string_view name) const {
    const toml::node* node = root.get(name);
    if (!node) throw Error(ErrorCode::bad_scene, fmt::format("the scene has no [{}]", name), {file_});
    return *node->as_table();
  }

  /// A table whose keys are of the scene itself.
  void read_own(const toml::table& table, const schema::Entry& entry, const std::string& name,
                Scene& scene) const {
    entries_.read(table, entry, {}, name, &scene, scene.locations);
    scene.locations.whole = {file_};
  }

  void read_container(const toml::table& root, Scene& scene) const {
    const toml::table& table = table_in(root, "container");
    EntryReader::Names kinds;
    for (const schema::Entry& entry : schema::container_entries()) kinds.push_back(entry.name);
    schema::hold(scene.container, entries_.choose(table, "kind", kinds, "[container]"));
    entries_.read(table, schema::entry_of(scene.container), "kind", "[container]",
                  schema::options_of(scene.container), scene.container.locations);
    auto* mesh = std::get_if<MeshFile>(&scene.container);
    if (!mesh) return;
    if (!root.contains("unit"))
      entries_.fail(table.source(),
                    "a scene with a mesh needs a unit, such as unit = \"mm\", before its first table");
    if (mesh->file.is_relative()) mesh->file = (path_.parent_path() / mesh->file).lexically_normal();
  }

  void read_spheres(const toml::table& table, Scene& scene) const {
    read_own(table, schema::spheres_entry(), "[spheres]", scene);
    if (!table.contains("radius") && !table.contains("diameter"))
      entries_.fail(table.source(), "[spheres] needs exactly one of \"radius\", \"diameter\"");
    scene.target.where = entries_.at(table.source());
    for (const char* key : {"count", "packing_fraction", "fill"})
      if (table.contains(key)) scene.target.where = scene.locations.of(key);
  }

  void read_stages(const toml::table& root, Scene& scene) const {
    const toml::node* node = root.get("stage");
    if (!node) return;
    const toml::array* stages = node->as_array();
    if (!stages || stages->empty() || !stages->is_array_of_tables())
      entries_.fail(node->source(), "\"stage\" must be one table [[stage]] a stage, not {}", written(*node));
    EntryReader::Names names;
    for (const StageTable* stage : stage_tables()) names.push_back(stage->name());
    for (const toml::node& item : *stages) {
      const toml::table& table = *item.as_table();
      const StageTable& stage = *stage_tables()[entries_.choose(table, "do", names, "[[stage]]")];
      Stage& made = scene.stages.emplace_back(stage.make());
      entries_.read(table, stage.keys, "do", fmt::format("[[stage]] {}", stage.name()),
                    stage.options_of(made), made.locations);
    }
  }

  static constexpr std::array<std::string_view, 4> tables = {"container", "spheres", "accuracy", "stage"};

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

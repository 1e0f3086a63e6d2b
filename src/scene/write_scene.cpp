#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "files/staged_folder.hpp"
#include "scene/given_files.hpp"
#include "scene/output_table.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

std::string toml_string(std::string_view text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return '"' + with_escaped_controls(quoted) + '"';
}

/// An inline table.
static std::string text_of(const SceneSizes& sizes) {
  const schema::Entry& entry = schema::entry_of(sizes);
  return fmt::format("{{ distribution = {}, {} }}", toml_string(entry.name),
                     fmt::join(assignments(entry, schema::options_of(sizes)), ", "));
}

/// An inline table.
static std::string text_of(const schema::Entry& entry, const void* options) {
  return fmt::format("{{ {} }}", fmt::join(assignments(entry, options), ", "));
}
static std::string text_of(const schema::Tables& tables) {
  std::vector<std::string> all;
  for (const std::shared_ptr<void>& item : tables.items) all.push_back(text_of(*tables.of, item.get()));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

/// "[[x, y], [x, y]]"
static std::string text_of(const std::vector<Vector<2>>& loop) {
  std::vector<std::string> points;
  for (const Vector<2>& p : loop) points.push_back(fmt::format("[{}, {}]", p[0], p[1]));
  return fmt::format("[{}]", fmt::join(points, ", "));
}

std::string toml_text(const schema::Value& value) {
  struct {
    std::string operator()(bool v) const { return v ? "true" : "false"; }
    std::string operator()(std::int64_t v) const { return fmt::format("{}", v); }
    std::string operator()(double v) const { return fmt::format("{}", v); }
    std::string operator()(const std::string& v) const { return toml_string(v); }
    std::string operator()(const std::vector<double>& v) const {
      return fmt::format("[{}]", fmt::join(v, ", "));
    }
    std::string operator()(const std::vector<std::string>& v) const {
      std::vector<std::string> all;
      for (const std::string& text : v) all.push_back(toml_string(text));
      return fmt::format("[{}]", fmt::join(all, ", "));
    }
    std::string operator()(const std::vector<SceneSizes>& v) const {
      std::vector<std::string> parts;
      for (const SceneSizes& part : v) parts.push_back(text_of(part));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    std::string operator()(const Polygon& v) const {
      std::vector<std::string> loops;
      for (const auto& loop : v.loops) loops.push_back(text_of(loop));
      return fmt::format("[{}]", fmt::join(loops, ", "));
    }
    std::string operator()(const std::vector<schema::Tables>& v) const {
      std::vector<std::string> lists;
      for (const schema::Tables& list : v) lists.push_back(text_of(list));
      return fmt::format("[{}]", fmt::join(lists, ", "));
    }
  } write;
  return std::visit(write, value);
}

std::vector<std::string> assignments(const schema::Entry& entry, const void* options, bool in_bed) {
  std::vector<std::string> out;
  for (const auto& [key, value] : entry.said(options)) {
    if (!key->acts_here(in_bed)) continue;
    const auto* tables = std::get_if<std::vector<schema::Tables>>(&value);
    const std::string text =
        key->type == schema::Type::distribution ? text_of(std::get<std::vector<SceneSizes>>(value).front())
        : key->type == schema::Type::points     ? text_of(std::get<Polygon>(value).loops.front())
        : key->type == schema::Type::tables     ? text_of(tables->front())
        : tables && (key->type == schema::Type::length || key->type == schema::Type::table)
            ? text_of(*tables->front().of, tables->front().items.front().get())
            : toml_text(value);
    out.push_back(fmt::format("{} = {}", key->name, text));
  }
  return out;
}

namespace {

std::string lines(const schema::Entry& entry, const void* options, bool in_bed = true) {
  return fmt::format("{}\n", fmt::join(assignments(entry, options, in_bed), "\n"));
}

std::string engine_as_toml(const SceneEngine& engine) {
  const schema::Entry& entry = schema::entry_of(engine);
  return fmt::format("\n[engine]\nkind = {}\n{}", toml_string(entry.name),
                     lines(entry, schema::options_of(engine)));
}

/// Without the kind.
std::vector<std::string> assignments_of(const SceneContainer& container) {
  std::vector<std::string> all = assignments(schema::entry_of(container), schema::options_of(container));
  if (container.rounding > 0) all.push_back(fmt::format("rounding = {}", container.rounding));
  std::vector<std::string> obstacles;
  if (const auto* mesh = std::get_if<MeshFile>(&container))
    for (const std::filesystem::path& file : mesh->obstacles) obstacles.push_back(toml_string(file.string()));
  for (const SceneContainer& solid : container.obstacles)
    obstacles.push_back(fmt::format("{{ kind = {}, {} }}", toml_string(schema::entry_of(solid).name),
                                    fmt::join(assignments_of(solid), ", ")));
  if (!obstacles.empty()) all.push_back(fmt::format("obstacles = [{}]", fmt::join(obstacles, ", ")));
  return all;
}

std::string container_as_toml(const SceneContainer& container) {
  return fmt::format("[container]\nkind = {}\n{}\n", toml_string(schema::entry_of(container).name),
                     fmt::join(assignments_of(container), "\n"));
}

/// "median 1", for a key and its value.
std::string in_words(const schema::Key& key, const schema::Value& value) {
  constexpr std::size_t most = 8;
  if (const auto* word = std::get_if<std::string>(&value)) return fmt::format("{} {}", key.name, *word);
  if (const auto* v = std::get_if<std::vector<double>>(&value); v && v->size() > most)
    return fmt::format("{} [{}, … {} numbers … {}]", key.name, fmt::join(v->begin(), v->begin() + 3, ", "),
                       v->size() - 4, v->back());
  if (const auto* parts = std::get_if<std::vector<SceneSizes>>(&value)) {
    std::vector<std::string> all;
    for (const SceneSizes& part : *parts) all.push_back(fmt::format("({})", sizes_in_words(part)));
    return fmt::format("of {}", fmt::join(all, " and "));
  }
  if (std::holds_alternative<std::vector<schema::Tables>>(value)) return fmt::format("with {}", key.name);
  return fmt::format("{} {}", key.name, toml_text(value));
}

}  // namespace

std::string stages_as_toml(const Scene& scene) {
  std::vector<std::string> out;
  for (const Stage& stage : scene.stages) {
    const StageTable& table = table_of(stage);
    out.push_back(fmt::format("[[stage]]\ndo = {}\n{}", toml_string(table.name()),
                              lines(table.keys, table.options(stage), table.traits.stands_in_bed(scene))));
  }
  return fmt::format("{}", fmt::join(out, "\n"));
}

std::string scene_as_toml(const Scene& scene, const std::filesystem::path& folder) {
  if (scene.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
    throw Error(ErrorCode::bad_argument,
                fmt::format("TOML cannot hold the seed {}: it is above 2^63 - 1", scene.seed));
  Scene named = scene;
  if (!folder.empty())
    for (std::filesystem::path* const file : files_named_in(named))
      if (!is_given(scene, *file)) *file = std::filesystem::proximate(*file, folder);
  if (!folder.empty())
    for (Inside& inside : named.inside) inside.scene = std::filesystem::proximate(inside.scene, folder);
  std::string out = fmt::format("{}\n{}\n[spheres]\n{}\n[accuracy]\n{}", lines(schema::scene_entry(), &scene),
                                container_as_toml(named.container), lines(schema::spheres_entry(), &named),
                                lines(schema::accuracy_entry(), &scene));
  for (const Zone& zone : named.zones)
    out += fmt::format("\n[[zone]]\n{}{}", lines(schema::zone_entry(), &zone),
                       lines(schema::spheres_of_zone_entry(), &zone.spheres));
  if (scene.engine) out += engine_as_toml(*scene.engine);
  if (!scene.stages.empty()) out.append("\n").append(stages_as_toml(scene));
  for (const Output& output : scene.outputs) {
    schema::Entry entry = table_of(output).keys;
    std::erase_if(entry.keys,
                  [&](const schema::Key& key) { return !contacts_that_use(key, output).empty(); });
    out += fmt::format("\n[[output]]\nformat = {}\n{}", toml_string(output.format), lines(entry, &output));
  }
  return out;
}

void write_scene(const Scene& scene, const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  StagedFolder staged(folder);
  Scene named = scene;
  put_long_lists_beside(named);
  for (const std::filesystem::path* const name : files_named_in(named))
    if (const auto content = content_given(named, *name)) staged.write(name->filename().string(), *content);
  staged.write(file.filename().string(), scene_as_toml(named, folder));
  staged.publish();
}

std::string sizes_in_words(const SceneSizes& sizes) {
  const schema::Entry& entry = schema::entry_of(sizes);
  std::string text(entry.name);
  for (const auto& [key, value] : entry.said(schema::options_of(sizes))) text += ", " + in_words(*key, value);
  return text;
}

}  // namespace bernal

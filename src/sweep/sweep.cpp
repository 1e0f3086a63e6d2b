#include "bernal/sweep/sweep.hpp"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "cad/read/files_of_part.hpp"
#include "files/sha256.hpp"
#include "scene/read_value.hpp"
#include "scene/scene_of_table.hpp"
#include "scene/toml_file.hpp"
#include "scene/toml_text.hpp"
#include "scene/unpublished.hpp"
#include "sweep/axes.hpp"

namespace fs = std::filesystem;

namespace bernal {
namespace {

constexpr std::size_t digits_of_hash = 16;

std::string digest_of(std::string_view text) { return sha256_of_bytes(text).substr(0, digits_of_hash); }

/// Of what is refused without the place, which stands in front of it.
std::string message_of(const Error& error) {
  const std::string place = error.location().text(), what = error.what();
  return place.empty() || !what.starts_with(place + ": ") ? what : what.substr(place.size() + 2);
}

}  // namespace

struct Sweep::Read {
  fs::path file, scene_file;
  toml::table scene;
  sweep::Axes axes;
  std::size_t cells = 0;
  std::string digest;
  std::map<fs::path, std::string> digests;  ///< of files that scenes name

  explicit Read(const fs::path& sweep_file);
  const std::string& digest_of_part(const fs::path& file);
  std::string hash_of(const Scene& scene);
  std::string words_of(const std::vector<sweep::Choice*>& choices, std::size_t number) const;

 private:
  void require_sweep(const toml::table& root) const;
  [[noreturn]] void fail(const toml::source_region& where, const std::string& why) const {
    throw Error(ErrorCode::bad_scene, why, location_of(where, file.string()));
  }
};

void Sweep::Read::require_sweep(const toml::table& root) const {
  constexpr std::array<std::string_view, 4> known = {"scene", "grid", "case", "repeats"};
  if (root.contains("container") && root.contains("spheres"))
    throw Error(
        ErrorCode::bad_scene,
        "this is a scene, not a sweep: a sweep names one, scene = \"bed.toml\", and says in a [grid] what "
        "becomes of its keys",
        {file.string()});
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : root)
    if (std::ranges::find(known, key.str()) == known.end())
      if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
  if (unknown)
    fail(unknown->source(), fmt::format("unknown key {} in the sweep{}", toml_string(unknown->str()),
                                        remedy(unknown->str(), known)));
  if (!root.contains("scene"))
    throw Error(ErrorCode::bad_scene, "the sweep has no scene: give scene = \"bed.toml\", or a [scene]",
                {file.string()});
  if (!root.contains("grid") && !root.contains("case") && !root.contains("repeats"))
    throw Error(ErrorCode::bad_scene,
                "the sweep asks for one scene alone: give it a [grid], a [[case]] or repeats",
                {file.string()});
}

Sweep::Read::Read(const fs::path& sweep_file) : file(sweep_file), scene_file(sweep_file) {
  constexpr std::streamsize largest = 16 << 20, largest_scene = 1 << 20;
  std::string text = read_toml_text(file, "sweep", largest, "is more than anybody needs to say");
  if (is_blank(text))
    throw Error(ErrorCode::bad_scene, "the sweep is empty; it needs at least a scene and a [grid]",
                {file.string()});
  toml::table root = parse_toml(text, file);
  require_sweep(root);
  toml::node& named = *root.get("scene");
  if (toml::table* own = named.as_table()) {
    scene = std::move(*own);
  } else if (const auto name = named.value_exact<std::string>(); name && !name->empty()) {
    scene_file = (file.parent_path() / *name).lexically_normal();
    const std::string scene_text =
        read_toml_text(scene_file, "scene", largest_scene, "no scene is; is it the mesh?");
    scene = parse_toml(scene_text, scene_file);
    text += scene_text;
  } else {
    fail(named.source(),
         fmt::format("\"scene\" must be the path of a scene, or a table [scene], not {}", written(named)));
  }
  digest = digest_of(text);
  const auto seed = scene["seed"].value_exact<std::int64_t>();
  axes = sweep::read_axes(root, file, seed.value_or(1));
  cells = axes.size(file);
}

const std::string& Sweep::Read::digest_of_part(const fs::path& part) {
  std::string& known = digests[part];
  if (known.empty()) known = sha256_of_part(part);
  return known;
}

std::string Sweep::Read::hash_of(const Scene& whole) {
  Scene named = whole;
  const auto by_bytes = [&](fs::path& of) {
    std::error_code unknown;
    if (!fs::is_directory(of, unknown)) {
      of = digest_of_part(of) + of.extension().string();
      return;
    }
    of = digest_of_part(where_it_stands(spheres_file_in(of))) +
         digest_of_part(where_it_stands(of / "scene.toml"));
  };
  for (MeshFile* mesh : named.meshes())
    for (fs::path* part : mesh->files()) by_bytes(*part);
  if (named.start.file) by_bytes(*named.start.file);
  return digest_of("bernal cell 1\n" + scene_as_toml(named));
}

std::string Sweep::Read::words_of(const std::vector<sweep::Choice*>& choices, std::size_t number) const {
  std::vector<std::string> words;
  for (const sweep::Choice* choice : choices)
    for (const sweep::Setting& setting : *choice)
      words.push_back(fmt::format("{} = {}", axes.keys[setting.key], plain_text(setting.text, 60)));
  return fmt::format("cell {}: {}", number, fmt::join(words, ", "));
}

Sweep Sweep::read(const fs::path& file) {
  Sweep sweep;
  sweep.read_ = std::make_shared<Read>(file);
  return sweep;
}

const fs::path& Sweep::file() const { return read_->file; }
const std::vector<std::string>& Sweep::keys() const { return read_->axes.keys; }
std::size_t Sweep::size() const { return read_->cells; }
const std::string& Sweep::digest() const { return read_->digest; }

Cell Sweep::cell(std::size_t number) const {
  Read& read = *read_;
  const std::vector<sweep::Choice*> choices = read.axes.choices(number - 1);
  Cell cell;
  cell.number = number;
  cell.values.resize(keys().size());
  try {
    sweep::Overlay overlay(read.scene);
    for (sweep::Choice* choice : choices)
      for (sweep::Setting& setting : *choice) {
        overlay.put(setting.assignment);
        cell.values[setting.key] = setting.text;
      }
    cell.scene = scene_of_table(read.scene, read.scene_file);
    cell.hash = read.hash_of(cell.scene);
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("{} ({})", message_of(error), read.words_of(choices, number)),
                error.location());
  }
  return cell;
}

}  // namespace bernal

#include "scene/scene_sources.hpp"

#include <string_view>
#include <system_error>

#include <toml++/toml.h>

namespace fs = std::filesystem;

namespace bernal {
namespace {

/// Names of files are the strings of these keys, wherever they stand.
bool names_files(std::string_view key) {
  return key == "file" || key == "start" || key == "obstacles" || key == "mesh" || key == "scene";
}

void add_named_files(const toml::node& node, bool here, std::vector<std::string>& names) {
  if (const toml::table* table = node.as_table())
    for (const auto& [key, value] : *table) add_named_files(value, names_files(key.str()), names);
  if (const toml::array* array = node.as_array())
    for (const toml::node& item : *array) add_named_files(item, here, names);
  if (const auto name = node.value<std::string>(); name && here) names.push_back(*name);
}

}  // namespace

std::vector<fs::path> sources_of_scene(const fs::path& file) {
  std::vector<fs::path> files;
  std::vector<std::string> names;
  std::error_code unknown;
  if (!fs::is_regular_file(file, unknown)) return files;
  try {
    toml::table scene = toml::parse_file(file.string());
    scene.erase("output");  // whose files are written
    add_named_files(scene, false, names);
  } catch (const toml::parse_error&) {
    return files;
  }
  files.push_back(file);
  const fs::path meant = fs::canonical(file, unknown);
  for (const std::string& name : names)
    for (const fs::path& folder : {file.parent_path(), meant.parent_path()})
      if (const fs::path named = (folder / name).lexically_normal(); fs::exists(named, unknown)) {
        files.push_back(named);
        break;
      }
  return files;
}

}  // namespace bernal

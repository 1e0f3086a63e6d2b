#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// "alpha = 17" or "phi0", what it is, and what it must be.
std::string line_of(const ReferenceKey& key) {
  const char* where = key.acts == "in_bed"   ? "; between fixed walls"
                      : key.acts == "in_box" ? "; in periodic boxes"
                                             : "";
  return fmt::format("  {}{}{}\n      {}\n      {}\n", key.name,
                     key.otherwise ? " = " + *key.otherwise : std::string(), where, key.help,
                     key.expectation);
}

}  // namespace

std::string reference(std::string_view name) {
  const std::vector<ReferenceGroup> groups = scene_reference();
  std::string all, tables;
  std::vector<std::string_view> names;
  for (const ReferenceGroup& group : groups) {
    std::string lines = fmt::format("{}:\n", group.title);
    for (const ReferenceTable& table : group.tables) {
      if (table.name == name) {
        tables += fmt::format("{}{}: {}\n", tables.empty() ? "" : "\n", table.name, table.help);
        for (const ReferenceKey& key : table.keys) tables += line_of(key);
      }
      names.push_back(table.name);
      lines += fmt::format("  {:<14}{}\n", table.name, table.help);
    }
    if (!group.selector.empty()) {
      if (name == group.name) return lines;
      names.push_back(group.name);
    }
    all += (all.empty() ? "" : "\n") + lines;
  }
  if (!tables.empty()) return tables;  // a format for a program, and that program as an engine
  if (name.empty()) return all;
  throw Error(ErrorCode::bad_argument,
              fmt::format("nothing in a scene is called {}{}", toml_string(name), remedy(name, names)));
}

}  // namespace bernal

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "scene/output_table.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

using schema::Entry;

struct Group {
  std::string_view title;
  std::vector<const Entry*> entries;
  std::string_view name = {};  ///< of the table or key that its entries stand in, where no entry has it
};

std::vector<Group> groups() {
  const auto addresses = [](const std::vector<Entry>& entries) {
    std::vector<const Entry*> all;
    for (const Entry& entry : entries) all.push_back(&entry);
    return all;
  };
  std::vector<const Entry*> stages, outputs;
  for (const StageTable* table : stage_tables()) stages.push_back(&table->keys);
  for (const OutputTable* table : output_tables()) outputs.push_back(&table->keys);
  const auto& own = schema::own_entries();
  return {
      {"Tables of a scene", {own.begin(), own.end()}},
      {"Containers: kind = \"…\" in [container]", addresses(schema::container_entries()), "container"},
      {"Sizes: distribution = \"…\" in radius or diameter", addresses(schema::size_entries()), "diameter"},
      {"Stages: do = \"…\" in [[stage]]", stages, "stage"},
      {"Files for other programs: format = \"…\" in [[output]]", outputs, "output"}};
}

/// "alpha = 17" or "phi0", what it is, and what it must be.
std::string line_of(const Entry& entry, const schema::Key& key) {
  const auto otherwise = key.required ? std::nullopt : key.of(entry.defaults.get());
  const bool shown = otherwise && key.type != schema::Type::distribution;
  const char* where = key.acts == schema::Acts::in_bed   ? "; between fixed walls"
                      : key.acts == schema::Acts::in_box ? "; in periodic boxes"
                                                         : "";
  return fmt::format("  {}{}{}\n      {}\n      {}\n", key.name,
                     shown ? " = " + toml_text(*otherwise) : std::string(), where, key.help,
                     schema::expectation(key));
}

}  // namespace

std::string reference(std::string_view name) {
  std::string all;
  std::vector<std::string_view> names;
  for (const Group& group : groups()) {
    std::string lines = fmt::format("{}:\n", group.title);
    for (const Entry* entry : group.entries) {
      if (entry->name == name) {
        std::string text = fmt::format("{}: {}\n", entry->name, entry->help);
        for (const schema::Key& key : entry->keys) text += line_of(*entry, key);
        return text;
      }
      names.push_back(entry->name);
      lines += fmt::format("  {:<14}{}\n", entry->name, entry->help);
    }
    if (!group.name.empty()) {
      if (name == group.name) return lines;
      names.push_back(group.name);
    }
    all += (all.empty() ? "" : "\n") + lines;
  }
  if (name.empty()) return all;
  throw Error(ErrorCode::bad_argument,
              fmt::format("nothing in a scene is called {}{}", toml_string(name), remedy(name, names)));
}

}  // namespace bernal

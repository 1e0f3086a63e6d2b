#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// A key, and the tables that have it, all with the same default and help.
struct SharedKey {
  const ReferenceGroup* group;
  ReferenceKey key;
  std::vector<const ReferenceTable*> of;
};

/// The keys of a group in their order, each once.
std::vector<SharedKey> shared_keys(const ReferenceGroup& group) {
  std::vector<SharedKey> all;
  for (const ReferenceTable& table : group.tables)
    for (const ReferenceKey& key : table.keys) {
      const auto same = std::ranges::find_if(all, [&](const SharedKey& other) {
        return other.key.name == key.name && other.key.help == key.help && other.key.acts == key.acts &&
               other.key.otherwise == key.otherwise && other.key.expectation == key.expectation;
      });
      if (same == all.end())
        all.push_back({&group, key, {&table}});
      else
        same->of.push_back(&table);
    }
  return all;
}

/// `kind = "mesh"`, or `kind = "box" or "cylinder"`.
std::string chosen_by(const SharedKey& shared) {
  constexpr std::size_t most = 4;
  if (shared.of.size() == shared.group->tables.size()) return "any " + shared.group->selector;
  std::vector<std::string> names;
  for (const ReferenceTable* table : shared.of) names.push_back(toml_string(table->name));
  const std::size_t told = std::min(most, names.size());
  return fmt::format("{} = {}{}", shared.group->selector,
                     fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(told), " or "),
                     names.size() > told ? fmt::format(" or {} more", names.size() - told) : "");
}

std::string table_in_scene(const std::string& group) {
  if (group == "diameter") return "diameter or radius = { … }";
  return group == "stage" || group == "output" ? "[[" + group + "]]" : "[" + group + "]";
}

/// Where a key stands in a scene: "in [container] with kind = "mesh"".
std::string place_in_scene(const SharedKey& shared) {
  const std::string& group = shared.group->name;
  if (group == "table") return fmt::format("of a {}", shared.of.front()->name);
  if (shared.group->selector.empty())
    return shared.of.front()->name == group ? "at the top" : fmt::format("in [{}]", shared.of.front()->name);
  return fmt::format("in {} with {}", table_in_scene(group), chosen_by(shared));
}

/// "alpha = 17" or "phi0", what it is, and what it must be.
std::string line_of(const ReferenceKey& key, const std::string& place = {}) {
  const char* where = key.acts == "in_bed"   ? "; between fixed walls"
                      : key.acts == "in_box" ? "; in periodic boxes"
                                             : "";
  return fmt::format("  {}{}{}{}{}\n      {}\n      {}\n", key.name,
                     key.otherwise ? " = " + *key.otherwise : std::string(), where, place.empty() ? "" : "; ",
                     place, key.help, key.expectation);
}

/// What of a group is chosen by a word, such as a container, where its name or help speaks of the words:
/// "kind = "cone"; in [container]".
std::string kinds_about(const std::vector<ReferenceGroup>& groups, std::string_view words) {
  constexpr int most = 6;  // of words that so many speak of, nobody means one
  std::string text;
  int found = 0;
  for (const ReferenceGroup& group : groups)
    for (const ReferenceTable& table : group.tables)
      if (!group.selector.empty() && relevance(words, table.name, table.help) > 0) {
        ++found;
        text += fmt::format("  {} = {}; in {}\n      {}; bernal keys {} has its keys\n", group.selector,
                            toml_string(table.name), table_in_scene(group.name), table.help, table.name);
      }
  return found > most ? std::string() : text;
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
      if (name == group.name) {
        lines += "\nTheir keys:\n";
        for (const SharedKey& shared : shared_keys(group)) lines += line_of(shared.key, chosen_by(shared));
        return lines;
      }
      names.push_back(group.name);
    }
    all += (all.empty() ? "" : "\n") + lines;
  }
  if (!tables.empty()) return tables;  // a format for a program, and that program as an engine
  if (name.empty()) return all;
  throw Error(ErrorCode::bad_argument,
              fmt::format("nothing in a scene is called {}{}", toml_string(name), remedy(name, names)));
}

bool is_in_reference(std::string_view name) {
  const std::vector<ReferenceGroup> groups = scene_reference();
  return std::ranges::any_of(groups, [&](const ReferenceGroup& group) {
    return (name == group.name && !group.selector.empty()) ||
           std::ranges::find(group.tables, name, &ReferenceTable::name) != group.tables.end();
  });
}

std::string keys_about(std::string_view words) {
  constexpr std::size_t most = 12;
  const std::vector<ReferenceGroup> groups = scene_reference();
  std::vector<std::pair<double, SharedKey>> found;
  for (const ReferenceGroup& group : groups)
    for (SharedKey& shared : shared_keys(group)) {
      std::string about = shared.key.help + " " + shared.key.expectation;
      for (const ReferenceTable* table : shared.of) about += " " + table->name;
      if (const double match = relevance(words, shared.key.name, about); match > 0)
        found.emplace_back(match, std::move(shared));
    }
  std::ranges::stable_sort(found, std::greater(), &std::pair<double, SharedKey>::first);
  std::string text = kinds_about(groups, words);
  for (std::size_t i = 0; i < std::min(most, found.size()); ++i)
    text += line_of(found[i].second.key, place_in_scene(found[i].second));
  if (found.size() > most) text += fmt::format("  and {} more; give more words\n", found.size() - most);
  return text;
}

}  // namespace bernal

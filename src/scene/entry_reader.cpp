#include "scene/entry_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "scene/read_columns.hpp"
#include "scene/scene_entries.hpp"
#include "scene/toml_text.hpp"
#include "scene/toml_values.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;
using schema::Type;
using schema::Value;
using Names = EntryReader::Names;

Names names_of(const auto& entries) {
  Names names;
  for (const auto& entry : entries) names.push_back(entry.name);
  return names;
}

}  // namespace

Location EntryReader::at(const toml::source_region& where) const {
  return {file_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column)};
}

void EntryReader::check_names(const toml::table& table, const Entry& entry, const Names& others,
                              std::string_view where) const {
  Names known = names_of(entry.keys);
  known.insert(known.end(), others.begin(), others.end());
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : table) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
  }
  if (unknown)
    fail(unknown->source(), "unknown key {} in {}{}", toml_string(unknown->str()), where,
         remedy(unknown->str(), known));
}

std::size_t EntryReader::choose(const toml::table& table, std::string_view selector, const Names& names,
                                std::string_view where) const {
  const toml::node* node = table.get(selector);
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
         where, remedy(word->get(), names));
  return static_cast<std::size_t>(found - names.begin());
}

Value EntryReader::read_value(const toml::node& node, const Key& key, const std::string& where) const {
  if (key.type == Type::distribution) return std::vector{read_sizes(node, key, where)};
  if (key.type == Type::parts) return read_parts(node, key, where);
  const bool is_word = key.type == Type::number && !key.words.empty() && node.is_string();
  const std::optional<Value> value = value_in(node, is_word ? Type::word : key.type);
  if (value && schema::accepts(key, *value)) return *value;
  if (value && key.type == Type::word)
    fail(node.source(), "\"{}\" in {} is not {}{}", key.name, where, written(node),
         remedy(std::get<std::string>(*value), key.words));
  fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
       written(node));
}

void EntryReader::read(const toml::table& table, const Entry& entry, std::string_view selector,
                       const std::string& where, void* options, Locations& locations) const {
  if (&entry != &schema::scene_entry())
    check_names(table, entry, selector.empty() ? Names{} : Names{selector}, where);
  const Names absent = entry.left_out(
      [&](const Key& key) { return table.contains(key.name); },
      [&](std::string_view first, std::string_view second) {
        fail(table.find(second)->first.source(),
             "\"{}\" and \"{}\" in {} exclude each other; give one of them", first, second, where);
      },
      [&](const std::string& sets) { fail(table.source(), "{} needs exactly one of {}", where, sets); });

  if (locations.whole.file.empty()) locations.whole = at(table.source());
  for (const Key& key : entry.keys) {
    const auto found = table.find(key.name);
    if (found == table.end()) {
      if (key.required && std::ranges::find(absent, key.name) == absent.end())
        fail(table.source(), "missing \"{}\" in {}: {}, {}", key.name, where, schema::expectation(key),
             key.help);
      continue;
    }
    locations.keys[std::string(key.name)] = at(found->first.source());
    if (key.member.set)
      key.member.set(options, read_value(found->second, key, where));
    else
      take_columns(found->second, entry, where, options, locations);
  }
}

/// Puts what stands in the file in its place, so that the scene is whole without the file.
void EntryReader::take_columns(const toml::node& node, const Entry& entry, const std::string& where,
                               void* options, Locations& locations) const {
  const std::string file = std::get<std::string>(read_value(node, *entry.find("file"), where));
  const Location at_file = locations.of("file");
  const std::array keys = {entry.find(entry.columns.at(0)), entry.find(entry.columns.at(1))};
  try {
    const auto columns = read_columns(path_.parent_path() / file, keys);
    for (std::size_t k = 0; k < keys.size(); ++k) {
      keys[k]->member.set(options, columns[k]);
      locations.keys[std::string(keys[k]->name)] = at_file;
    }
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), fmt::format("\"file\" in {}: {}", where, error.what()), at_file);
  }
}

/// A plain length, whose key says what it must be, is a constant distribution.
SceneSizes EntryReader::read_sizes(const toml::node& node, const Key& key, const std::string& where) const {
  SceneSizes sizes;
  if (const toml::table* table = node.as_table()) {
    const std::string named = fmt::format("{} of {}", key.name, where);
    const auto& entries = schema::size_entries();
    const std::size_t n = choose(*table, "distribution", names_of(entries), named);
    schema::hold(sizes, n);
    read(*table, entries[n], "distribution", named, schema::options_of(sizes), sizes.locations);
    return sizes;
  }
  const auto value = value_in(node, Type::length);
  const Key length = {.name = key.name, .type = Type::length};
  if (!value || !schema::accepts(length, *value))
    fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
         written(node));
  sizes = Constant{std::get<double>(*value)};
  sizes.locations.whole = at(node.source());
  return sizes;
}

std::vector<SceneSizes> EntryReader::read_parts(const toml::node& node, const Key& key,
                                                const std::string& where) const {
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

}  // namespace bernal

#include "scene/entry_reader.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "scene/read_columns.hpp"
#include "scene/toml_text.hpp"
#include "scene/toml_values.hpp"

namespace bernal {
namespace {

using schema::Entry;
using schema::Key;
using schema::Type;
using Names = EntryReader::Names;

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

const Entry& EntryReader::choose(const toml::table& table, std::string_view selector,
                                 const std::vector<Entry>& entries, std::string_view where) const {
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
Names EntryReader::left_out(const toml::table& table, const Entry& entry, std::string_view where) const {
  Names out;
  for (const schema::Choice& choice : entry.choices) {
    const auto needs_nothing = [&](const Names& set) {
      return std::ranges::all_of(set, [&](std::string_view key) { return bool(entry.find(key)->otherwise); });
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
      const auto first = std::ranges::find_if(choice, [&](const Names& set) { return holds(set, given[0]); });
      const auto other =
          std::ranges::find_if(given, [&](std::string_view key) { return !holds(*first, key); });
      fail(table.find(*other)->first.source(), "\"{}\" and \"{}\" in {} exclude each other; give one of them",
           given[0], *other, where);
    }
    for (const Names& set : choice)
      for (const std::string_view key : set)
        if (!holds(*chosen, key)) out.push_back(key);
  }
  return out;
}

/// Reads and checks one key.
Value EntryReader::read_value(const toml::node& node, const Key& key, std::string_view where) const {
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

Spec EntryReader::read(const toml::table& table, const Entry& entry, std::string_view selector,
                       const std::string& where) const {
  if (&entry != &all_.scene) check_names(table, entry, selector.empty() ? Names{} : Names{selector}, where);
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
void EntryReader::take_columns(Spec& spec, const Entry& entry, const std::string& where) const {
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

Spec EntryReader::read_distribution(const toml::node& node, const Key& key, const std::string& where) const {
  const toml::table* table = node.as_table();
  if (!table)
    return {"constant", {{"value", {read_value(node, key, where), at(node.source())}}}, at(node.source())};
  const std::string named = fmt::format("{} of {}", key.name, where);
  return read(*table, choose(*table, "distribution", all_.distributions, named), "distribution", named);
}

std::vector<Spec> EntryReader::read_parts(const toml::node& node, const Key& key,
                                          const std::string& where) const {
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

}  // namespace bernal

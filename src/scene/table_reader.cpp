#include "scene/table_reader.hpp"

#include <algorithm>
#include <limits>

#include <fmt/ranges.h>

#include "bernal/core/text.hpp"
#include "scene/keys_from_columns.hpp"
#include "scene/read_value.hpp"
#include "scene/scene_entries.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

using schema::Entry;
using schema::Key;
using schema::Tables;
using schema::Type;
using schema::Value;

void TableReader::check_names(const toml::table& table, const Entry& entry, const Names& others,
                              std::string_view where) const {
  Names known = names_of(entry.keys);
  known.insert(known.end(), others.begin(), others.end());
  const toml::key* unknown = nullptr;
  for (const auto& [key, node] : table) {
    if (std::ranges::find(known, key.str()) != known.end()) continue;
    if (!unknown || key.source().begin < unknown->source().begin) unknown = &key;
  }
  if (!unknown) return;
  const auto number = [&](std::string_view key) { return table[key].value<double>(); };
  const std::string instead = schema::instead_of(entry, unknown->str(), number);
  fail(unknown->source(), "unknown key {} in {}{}", toml_string(unknown->str()), where,
       instead.empty() ? remedy(unknown->str(), known) : instead);
}

std::size_t TableReader::choose(const toml::table& table, std::string_view selector,
                                const std::vector<KnownWord>& known, std::string_view where) const {
  const toml::node* node = table.get(selector);
  const Names names = names_of(known);
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
         where, remedy_of_word(word->get(), known));
  return static_cast<std::size_t>(found - names.begin());
}

/// The node as a value, whatever the key accepts. Refuses text that is no number with its unit where one is
/// meant.
std::optional<Value> TableReader::value_of(const toml::node& node, const Key& key,
                                           const std::string& where) const {
  Measured measured{key.measured(), unit_};
  if (measured.quantity == Quantity::diameter && sizes_are_volumes_) measured.quantity = Quantity::volume;
  if (measured.quantity == Quantity::diameter && !sizes_are_diameters_) measured.quantity = Quantity::length;
  const bool line = key.type == Type::points;
  try {
    if (measured.quantity == Quantity::diameter) in_phi_.note(node, key.name, at(node.source()).line);
    return line || key.type == Type::lines ? lines_in(node, line, measured)
           : key.type == Type::names       ? names_in(node, measured)
                                           : value_in(node, key.type != Type::integer, measured, key.words);
  } catch (const Error& error) {
    fail(node.source(), "\"{}\" in {} must be {}, not {}: {}", key.name, where, schema::expectation(key),
         written(node), error.what());
  }
}

Value TableReader::read_value(const toml::node& node, const Key& key, const std::string& where) const {
  if (key.type == Type::distribution) return std::vector{read_sizes(node, key, where)};
  if (key.type == Type::parts) return read_parts(node, key, where);
  if (key.table && (key.type != Type::length || node.is_table())) return read_tables(node, key, where);
  const std::optional<Value> value = value_of(node, key, where);
  if (value && schema::accepts(key, *value)) return *value;
  if (const auto k = key.type == Type::points ? first_that_is_no_point(node) : std::nullopt)
    fail(node.as_array()->get(*k)->source(), "point {} of \"{}\" in {} must be two numbers {}, not {}",
         *k + 1, key.name, where, key.name == "profile" ? "[r, z]" : "[x, y]",
         written(*node.as_array()->get(*k)));
  if (key.type == Type::word && node.is_string())
    fail(node.source(), "\"{}\" in {} is not {}{}", key.name, where, written(node),
         remedy_of_word(std::get<std::string>(*value), {key.words.begin(), key.words.end()}));
  refuse(node, key, where, value);
}

void TableReader::read(const toml::table& table, const Entry& entry, const Names& others,
                       const std::string& where, void* options, Locations& locations) const {
  if (&entry != &schema::scene_entry()) check_names(table, entry, others, where);
  if (locations.whole.file.empty()) locations.whole = at(table.source());
  for (const Key& key : entry.keys) {
    const auto found = table.find(key.name);
    if (found == table.end()) continue;
    locations.keys[std::string(key.name)] = at(found->first.source());
    if (!key.member.set && key.type != Type::file) continue;  // see `read_solid`
    if (key.member.set) {
      key.member.set(options, read_value(found->second, key, where));
      continue;
    }
    for (const Key& other : entry.keys)
      if (comes_from_file(entry, other) && table.contains(other.name))
        fail(found->first.source(), "\"{}\" and \"{}\" in {} exclude each other; give one of them",
             other.name, key.name, where);
    take_columns(found->second, entry, where, options, locations);
  }
}

/// Puts what stands in the file in its place, so that the scene is whole without the file.
void TableReader::take_columns(const toml::node& node, const Entry& entry, const std::string& where,
                               void* options, Locations& locations) const {
  const std::string file = std::get<std::string>(read_value(node, *entry.find("file"), where));
  const Location at_file = locations.of("file");
  try {
    for (const Key* key : keys_from_columns(beside(at_file, file), entry, unit_, options))
      locations.keys[std::string(key->name)] = at_file;
  } catch (const Error& error) {
    if (!error.location().file.empty()) throw;
    throw Error(error.code(), fmt::format("\"file\" in {}: {}", where, error.what()), at_file);
  }
}

/// A plain length, whose key says what it must be, is a constant distribution.
SceneSizes TableReader::read_sizes(const toml::node& node, const Key& key, const std::string& where) const {
  SceneSizes sizes;
  if (key.quantity == Quantity::volume && !sizes_are_volumes_) {
    sizes_are_volumes_ = true;
    sizes = read_sizes(node, key, where);
    sizes_are_volumes_ = false;
    return sizes;
  }
  if (const toml::table* table = node.as_table()) {
    const std::string named = fmt::format("{} of {}", key.name, where);
    const auto& entries = schema::size_entries();
    const std::size_t n = choose(*table, "distribution", known_words_in(entries), named);
    schema::hold(sizes, n);
    read(*table, entries[n], {"distribution"}, named, schema::options_of(sizes), sizes.locations);
    return sizes;
  }
  if (const auto* word = node.as_string();
      word && std::ranges::find(key.words, word->get()) != key.words.end()) {
    sizes = Constant{std::numeric_limits<double>::infinity()};  // as its member takes it
    sizes.locations.whole = sizes.locations.keys["value"] = at(node.source());
    return sizes;
  }
  const Key length = {.name = key.name, .type = Type::length};
  const auto value = value_of(
      node, schema::of_quantity(sizes_are_volumes_ ? Quantity::volume : Quantity::diameter, key), where);
  if (!value || !schema::accepts(length, *value)) refuse(node, key, where, value);
  sizes = Constant{std::get<double>(*value)};
  sizes.locations.whole = sizes.locations.keys["value"] = at(node.source());
  return sizes;
}

std::vector<SceneSizes> TableReader::read_parts(const toml::node& node, const Key& key,
                                                const std::string& where) const {
  const toml::array* array = node.as_array();
  if (!array || array->empty()) refuse(node, key, where);
  std::vector<SceneSizes> parts;
  for (const toml::node& item : *array) {
    const std::string name = fmt::format("part {}", parts.size() + 1);
    parts.push_back(read_sizes(item, {.name = name, .type = Type::distribution}, where));
  }
  return parts;
}

void TableReader::read_table(const toml::node& node, const Entry& entry, const std::string& where,
                             Tables& into) const {
  std::shared_ptr<void> made = entry.make();
  Locations unkept;
  Locations* kept = entry.locations ? entry.locations(made.get()) : &unkept;
  const toml::table& table = *node.as_table();
  read(table, entry, {}, where, made.get(), *kept);
  for (const Key& key : entry.keys)  // else `check` finds it
    if (!entry.locations && key.required && !table.contains(key.name))
      fail(node.source(), "missing \"{}\" in {}: {}, {}", key.name, where, schema::expectation(key),
           key.help);
  into.items.push_back(std::move(made));
}

/// One array of tables, one of each of several, or one table.
std::vector<Tables> TableReader::read_tables(const toml::node& node, const Key& key,
                                             const std::string& where) const {
  const Entry& entry = key.table();
  std::vector<Tables> lists;
  if (key.type == Type::length || key.type == Type::table || (key.type == Type::tables && node.is_table())) {
    if (!node.is_table()) refuse(node, key, where);
    read_table(node, entry, schema::name_of_table(key, 0, 0, where), lists.emplace_back(Tables{&entry}));
    return lists;
  }
  const auto read_list = [&](const toml::array& array) {
    Tables& list = lists.emplace_back(Tables{&entry});
    for (const toml::node& item : array) {
      if (!item.is_table()) refuse(node, key, where);
      read_table(item, entry, schema::name_of_table(key, lists.size() - 1, list.items.size(), where), list);
    }
  };
  const toml::array* array = node.as_array();
  if (!array || array->empty()) refuse(node, key, where);
  if (key.type == Type::tables) {
    read_list(*array);
    return lists;
  }
  for (const toml::node& item : *array) {
    if (!item.is_array()) refuse(node, key, where);
    read_list(*item.as_array());
  }
  return lists;
}

void TableReader::refuse(const toml::node& node, const Key& key, const std::string& where,
                         const std::optional<Value>& value) const {
  fail(node.source(), "\"{}\" in {} must be {}, not {}", key.name, where, schema::expectation(key, value),
       written(node));
}

}  // namespace bernal

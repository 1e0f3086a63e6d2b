#include "scene/entry.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/toml_text.hpp"

namespace bernal::schema {

Key word(const Member& member, std::string_view name, std::string_view help,
         std::vector<std::string_view> words) {
  Key made = key(Type::word, {}, name, help);
  made.member.get = [get = member.get, words](const void* options) -> std::optional<Value> {
    const std::optional<Value> index = get(options);
    if (!index) return std::nullopt;
    const auto k = static_cast<std::size_t>(std::get<std::int64_t>(*index));
    return k < words.size() ? std::string(words[k]) : std::string("?");
  };
  made.member.set = [set = member.set, words](void* options, const Value& value) {
    set(options, std::ranges::find(words, std::get<std::string>(value)) - words.begin());
  };
  made.words = std::move(words);
  return made;
}

std::optional<Value> Key::of(const void* options) const {
  if (!member.get) return std::nullopt;
  std::optional<Value> value = member.get(options);
  return value && !unsaid.empty() && toml_text(*value) == unsaid ? std::nullopt : value;
}

Quantity Key::measured() const {
  if (quantity != Quantity::none) return quantity;
  switch (type) {
    case Type::length:
    case Type::position:
    case Type::corner:
    case Type::extents:
    case Type::points:
    case Type::lines:
    case Type::coordinates:
    case Type::lengths:
    case Type::distribution:
    case Type::parts:
      return Quantity::length;
    default:
      return Quantity::none;
  }
}

Key unless(std::string otherwise, Key key) {
  key.unsaid = std::move(otherwise);
  return key;
}

Key buys_accuracy(std::initializer_list<double> ladder, Key key) {
  for (const double value : ladder)
    key.ladder.push_back(key.type == Type::integer ? Value(static_cast<std::int64_t>(value)) : Value(value));
  return key;
}
Key buys_accuracy_as_limit(std::initializer_list<double> ladder, Key key) {
  key.is_limit = true;
  return buys_accuracy(ladder, std::move(key));
}
Key buys_accuracy(Key word) {
  for (const std::string_view value : word.words) word.ladder.emplace_back(std::string(value));
  return word;
}

std::vector<Key> acting(Acts acts, std::vector<Key> keys) {
  for (Key& key : keys) key.acts = acts;
  return keys;
}

std::vector<Key> joined(std::vector<Key> keys, std::vector<Key> others) {
  std::ranges::move(others, std::back_inserter(keys));
  return keys;
}

std::string name_of_table(const Key& key, std::size_t list, std::size_t item, const std::string& where) {
  if (key.type == Type::length || key.type == Type::table) return fmt::format("{} of {}", key.name, where);
  if (key.type == Type::tables) return fmt::format("{} {} of {}", key.table().name, item + 1, where);
  return fmt::format("{} {} of {} {} of {}", key.table().name, item + 1, key.list_of, list + 1, where);
}

/// Every table that stands in a key.
static void check_tables(const Key& key, const std::vector<Tables>& lists, const Section& section) {
  for (std::size_t i = 0; i < lists.size(); ++i)
    for (std::size_t k = 0; k < lists[i].items.size(); ++k) {
      const Entry& entry = *lists[i].of;
      void* const options = lists[i].items[k].get();
      Locations unkept{.whole = section.locations.of(key.name), .keys = {}};
      for (const Key& of : entry.keys) unkept.keys.emplace(of.name, unkept.whole);  // see `TableReader`
      check(entry, options,
            {name_of_table(key, i, k, section.name), entry.locations ? *entry.locations(options) : unkept});
    }
}

void check(const Entry& entry, const void* options, const Section& section, bool in_bed) {
  const auto absent = entry.left_out(options, section);
  for (const Key& key : entry.keys) {
    const auto value = key.of(options);
    if (!key.acts_here(in_bed)) {
      const auto otherwise = key.of(entry.defaults.get());
      const bool said = value && !(otherwise && toml_text(*value) == toml_text(*otherwise));
      if (said || section.locations.keys.contains(key.name))
        section.fail(key.name,
                     fmt::format("\"{}\" in {} acts in {} only; leave it out", key.name, section.name,
                                 in_bed ? "periodic boxes" : "containers with walls"));
      continue;
    }
    const auto& [whole, keys] = section.locations;
    const bool missing = key.of(entry.defaults.get()) ? whole.line > 0 && !keys.contains(key.name) : !value;
    if (missing && key.required && key.member.get && std::ranges::find(absent, key.name) == absent.end())
      section.fail("", fmt::format("missing \"{}\" in {}: {}, {}", key.name, section.name, expectation(key),
                                   key.help));
    if (value && !accepts(key, *value))
      section.refuse(key.name, fmt::format("must be {}, not {}", expectation(key, value),
                                           toml_text(*value).substr(0, 100)));
    if (value && std::holds_alternative<std::vector<Tables>>(*value))
      check_tables(key, std::get<std::vector<Tables>>(*value), section);
  }
  if (entry.rule) entry.rule(options, section);
}

void Section::refuse(std::string_view key, std::string_view must) const {
  fail(key, fmt::format("\"{}\" in {} {}", key, name, must));
}

void Section::fail(std::string_view key, const std::string& message) const {
  throw Error(ErrorCode::bad_scene, message, locations.of(key));
}

const Key* Entry::find(std::string_view key) const {
  const auto found = std::ranges::find(keys, key, &Key::name);
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string_view> Entry::left_out(const void* options, const Section& section) const {
  using Names = std::vector<std::string_view>;
  const auto holds = [](const Names& set, std::string_view key) {
    return std::ranges::find(set, key) != set.end();
  };
  // What always has a value is given where a file says so.
  const auto given = [&](std::string_view key_name) {
    const Key& key = *find(key_name);
    return key.of(defaults.get()) ? section.locations.keys.contains(key_name) : bool(key.of(options));
  };
  const auto needs_nothing = [&](const Names& set) {
    return std::ranges::none_of(set, [&](std::string_view key) { return find(key)->required; });
  };
  Names out;
  for (const Choice& choice : choices) {
    Names present;
    for (const Names& set : choice)
      for (const std::string_view key : set)
        if (!holds(present, key) && given(key)) present.push_back(key);
    const auto has_all = [&](const Names& set) {
      return std::ranges::all_of(present, [&](std::string_view key) { return holds(set, key); });
    };
    const auto chosen =
        present.empty() ? std::ranges::find_if(choice, needs_nothing) : std::ranges::find_if(choice, has_all);
    if (chosen == choice.end() && present.empty()) {
      std::vector<std::string> sets;
      for (const Names& set : choice) sets.push_back(fmt::format("\"{}\"", fmt::join(set, "\" and \"")));
      section.fail("", fmt::format("{} needs exactly one of {}", section.name, fmt::join(sets, ", ")));
    }
    if (chosen == choice.end()) {
      const Names& first =
          *std::ranges::find_if(choice, [&](const Names& set) { return holds(set, present[0]); });
      const auto other =
          std::ranges::find_if(present, [&](std::string_view key) { return !holds(first, key); });
      // A key that several sets have goes with it; one that no set has together with it does not.
      const auto excluded = std::ranges::find_if(present, [&](std::string_view key) {
        return std::ranges::none_of(choice,
                                    [&](const Names& set) { return holds(set, key) && holds(set, *other); });
      });
      section.fail(*other,
                   fmt::format("\"{}\" and \"{}\" in {} exclude each other; give one of them",
                               excluded == present.end() ? present[0] : *excluded, *other, section.name));
    }
    for (const Names& set : choice)
      for (const std::string_view key : set)
        if (!holds(*chosen, key)) out.push_back(key);
  }
  return out;
}

std::vector<std::pair<const Key*, Value>> Entry::said(const void* options) const {
  const auto absent = left_out(options, {std::string(name), {}});
  std::vector<std::pair<const Key*, Value>> all;
  for (const Key& key : keys)
    if (auto value = key.of(options); value && std::ranges::find(absent, key.name) == absent.end())
      all.emplace_back(&key, std::move(*value));
  return all;
}

}  // namespace bernal::schema

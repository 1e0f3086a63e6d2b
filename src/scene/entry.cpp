#include "scene/entry.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bernal::schema {

Key key(Type type, Member member, std::string_view name, std::string_view help) {
  return {.name = name, .type = type, .member = std::move(member), .help = help};
}

Key flag(Member member, std::string_view name, std::string_view help, Range range) {
  Key made = key(Type::flag, std::move(member), name, help);
  made.range = range;
  return made;
}

Key integer(Member member, std::string_view name, std::string_view help, Range range) {
  Key made = key(Type::integer, std::move(member), name, help);
  made.range = range;
  return made;
}

Key number(Member member, std::string_view name, std::string_view help, Range range) {
  Key made = key(Type::number, std::move(member), name, help);
  made.range = range;
  return made;
}

Key length(Member member, std::string_view name, std::string_view help) {
  return key(Type::length, std::move(member), name, help);
}

Key word(Member member, std::string_view name, std::string_view help, std::vector<std::string_view> words) {
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

Key required(Key key) {
  key.required = true;
  return key;
}

Key diameter(Member member, std::string_view name, std::string_view help) {
  Key made = required(length(std::move(member), name, help));
  made.is_diameter = true;
  return made;
}

std::vector<Key> acting(Acts acts, std::vector<Key> keys) {
  for (Key& key : keys) key.acts = acts;
  return keys;
}

std::vector<Key> joined(std::vector<Key> keys, std::vector<Key> others) {
  std::ranges::move(others, std::back_inserter(keys));
  return keys;
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

std::vector<std::string_view> Entry::left_out(
    const std::function<bool(const Key&)>& given,
    const std::function<void(std::string_view, std::string_view)>& conflict,
    const std::function<void(const std::string&)>& missing) const {
  using Names = std::vector<std::string_view>;
  const auto holds = [](const Names& set, std::string_view key) {
    return std::ranges::find(set, key) != set.end();
  };
  const auto needs_nothing = [&](const Names& set) {
    return std::ranges::none_of(set, [&](std::string_view key) { return find(key)->required; });
  };
  Names out;
  for (const Choice& choice : choices) {
    Names present;
    std::vector<std::string> sets;
    for (const Names& set : choice) {
      if (!set.empty()) sets.push_back(fmt::format("\"{}\"", fmt::join(set, "\" and \"")));
      for (const std::string_view key : set)
        if (!holds(present, key) && given(*find(key))) present.push_back(key);
    }
    const auto chosen = std::ranges::find_if(choice, [&](const Names& set) {
      return present.empty()
                 ? needs_nothing(set)
                 : std::ranges::all_of(present, [&](std::string_view key) { return holds(set, key); });
    });
    if (chosen == choice.end()) {
      if (present.empty()) missing(fmt::format("{}", fmt::join(sets, ", ")));
      const auto first =
          std::ranges::find_if(choice, [&](const Names& set) { return holds(set, present[0]); });
      conflict(present[0],
               *std::ranges::find_if(present, [&](std::string_view key) { return !holds(*first, key); }));
    }
    for (const Names& set : choice)
      for (const std::string_view key : set)
        if (!holds(*chosen, key)) out.push_back(key);
  }
  return out;
}

std::vector<std::string_view> Entry::left_out(const void* options, const Section& section) const {
  // What always has a value says nothing about the choice.
  const auto given = [&](const Key& key) {
    return bool(key.of(options)) && !(defaults && key.of(defaults.get()));
  };
  return left_out(
      given,
      [&](std::string_view first, std::string_view second) {
        section.fail(second, fmt::format("\"{}\" and \"{}\" in {} exclude each other; give one of them",
                                         first, second, section.name));
      },
      [&](const std::string& sets) {
        section.fail("", fmt::format("{} needs exactly one of {}", section.name, sets));
      });
}

}  // namespace bernal::schema

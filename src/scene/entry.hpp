#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "bernal/core/quantity.hpp"
#include "bernal/core/vector.hpp"
#include "bernal/scene/scene.hpp"

namespace bernal::schema {

struct Entry;

/// Tables to the right of an equals sign, each a struct of the entry `of`.
struct Tables {
  const Entry* of = nullptr;
  std::vector<std::shared_ptr<void>> items = {};
};

/// What a user may write to the right of an equals sign; a distribution is an array of one, and so is a line
/// of points, or one array of tables.
using Value = std::variant<bool, std::int64_t, double, std::string, std::vector<double>,
                           std::vector<std::string>, std::vector<SceneSizes>, Polygon, std::vector<Tables>>;

/// What the value of a key must be. Vectors have three components; arrays have at least one.
enum class Type {
  flag,          ///< true or false; only true where the range begins at 1
  integer,       ///< within Key::range
  number,        ///< finite, within Key::range; or one of Key::words, if there are any
  length,        ///< positive, in the scene's unit; or a table of Key::table, if there is one
  word,          ///< one of Key::words
  file,          ///< a path, relative to the scene's folder
  direction,     ///< [x, y, z], not all zero
  push,          ///< the same, or [x, y]: as many components as the scene has dimensions
  position,      ///< [x, y, z] in the scene's unit; or one of Key::words, if there are any
  text,          ///< a name in quotes, without control characters, commas and quotes
  names,         ///< array of strings, or one: each one of Key::words, if there are any
  corner,        ///< [x, y, z] or [x, y] in the scene's unit
  extents,       ///< [a, b, c] or [a, b], each a length
  points,        ///< array of three [x, y] or more, a closed line
  lines,         ///< array of such
  coordinates,   ///< array of numbers in the scene's unit
  lengths,       ///< array of lengths; of at least 0 where the range begins there
  shares,        ///< array of positive numbers
  amounts,       ///< array of numbers of at least 0
  axes,          ///< array of axes, counted from 0, each once
  distribution,  ///< a length, or a table of one of the distributions
  parts,         ///< array of distributions
  solids,        ///< array of files of closed surfaces and of tables of containers, or one file
  table,         ///< a table of Key::table
  tables,        ///< array of tables of Key::table, or one
  table_lists,   ///< array of arrays of such, of which some may be empty
};

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< min itself is excluded
  bool below_max = false;  ///< max itself is excluded

  bool contains(double v) const {
    return (above_min ? v > min : v >= min) && (below_max ? v < max : v <= max);
  }
};
/// (min, max], (min, max)
inline Range above(double min, double max) { return {min, max, true}; }
inline Range between(double min, double max) { return {min, max, true, true}; }

/// What lengths and coordinates may be in any unit, and volumes still neither overflow nor vanish.
inline constexpr double smallest_length = 1e-30, largest_length = 1e30;
/// Of packing fractions, so thin that a box of one sphere is some 10^12 radii long at most.
inline constexpr double least_packing_fraction = 1e-12;
inline Range packing_fractions() { return {least_packing_fraction, 1, false, true}; }

/// A member as a value; nothing where it is an empty optional or vector.
template <class M>
std::optional<Value> value_of(const M& m) {
  if constexpr (requires { m.has_value(); })
    return m ? value_of(*m) : std::nullopt;
  else if constexpr (std::is_same_v<M, bool> || std::is_same_v<M, double>)
    return m;
  else if constexpr (std::is_integral_v<M> || std::is_enum_v<M>)
    return static_cast<std::int64_t>(m);
  else if constexpr (std::is_same_v<M, std::filesystem::path>)
    return m.string();
  else if constexpr (std::is_same_v<M, std::string>)
    return m.empty() ? std::nullopt : std::optional<Value>(m);
  else if constexpr (std::is_same_v<M, std::vector<SceneSizes>> ||
                     std::is_same_v<M, std::vector<std::string>>)
    return m.empty() ? std::nullopt : std::optional<Value>(m);
  else
    return m.size() == 0 ? std::nullopt : std::optional<Value>(std::vector<double>(m.begin(), m.end()));
}
/// And back. Precondition: the value is one of such a member.
template <class M>
void take_value(M& m, const Value& value) {
  if constexpr (requires { m.has_value(); })
    take_value(m.emplace(), value);
  else if constexpr ((std::is_integral_v<M> && !std::is_same_v<M, bool>) || std::is_enum_v<M>)
    m = static_cast<M>(std::get<std::int64_t>(value));
  else if constexpr (std::is_same_v<M, std::filesystem::path>)
    m = std::get<std::string>(value);
  else if constexpr (std::is_same_v<M, bool> || std::is_same_v<M, double> || std::is_same_v<M, std::string> ||
                     std::is_same_v<M, std::vector<SceneSizes>> ||
                     std::is_same_v<M, std::vector<std::string>>)
    m = std::get<M>(value);
  else if (const auto& v = std::get<std::vector<double>>(value); true) {
    if constexpr (requires { m.assign(v.begin(), v.end()); })
      m.assign(v.begin(), v.end());
    else
      m = Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size()));
  }
}

/// The way from a plain struct to one of its members.
struct Member {
  std::function<std::optional<Value>(const void*)> get;
  std::function<void(void*, const Value&)> set;

  Member() = default;
  template <class T, class M>
  Member(M T::*member)
      : get([member](const void* of) { return value_of(static_cast<const T*>(of)->*member); }),
        set([member](void* of, const Value& value) { take_value(static_cast<T*>(of)->*member, value); }) {}

  /// The same from a struct of which the one that it leads from is a part.
  template <class T, class M>
  Member inside(M T::*part) const {
    Member member;
    member.get = [get = get, part](const void* of) { return get(&(static_cast<const T*>(of)->*part)); };
    member.set = [set = set, part](void* of, const Value& v) { set(&(static_cast<T*>(of)->*part), v); };
    return member;
  }
};

/// On what a key of a stage acts: spheres that stand in a bed, or in a box (see `SpheresOfRun`).
enum class Acts { everywhere, in_bed, in_box };

struct Key {
  std::string_view name;
  Type type;
  /// None of a key that the reader replaces by others, nor of what any container may have.
  Member member = {};
  std::string_view help = {};
  Range range = {};
  std::vector<std::string_view> words = {};
  bool required = false;     ///< in a file, unless the entry's choices leave it out
  bool is_diameter = false;  ///< a size that is a diameter by its name
  Acts acts = Acts::everywhere;
  /// Of a key that buys accuracy with time: values from the cheapest to the dearest. Of a length: in units of
  /// the one that the scene has.
  std::vector<Value> ladder = {};
  bool is_limit = false;    ///< it buys that only where a run ends at it
  std::string unsaid = {};  ///< the value, as TOML, that is not written; none if empty
  /// Of a number: whose unit may stand with it, in text; and of lengths that are diameters of grains.
  Quantity quantity = Quantity::none;
  const Entry& (*table)() = nullptr;  ///< of the tables that may stand there
  std::string_view list_of = {};      ///< what has a list of tables each, where there are several

  /// What is written of it, nothing where it goes without saying.
  std::optional<Value> of(const void* options) const;
  bool acts_here(bool in_bed) const { return acts == Acts::everywhere || (acts == Acts::in_bed) == in_bed; }
  /// Of what its numbers are.
  Quantity measured() const;
};

using Text = std::string_view;
inline Key key(Type type, Member member, Text name, Text help, Range range = {}) {
  return {name, type, std::move(member), help, range};
}
inline Key flag(Member member, Text name, Text help, Range range = {0, 1}) {
  return key(Type::flag, std::move(member), name, help, range);
}
inline Key integer(Member member, Text name, Text help, Range range) {
  return key(Type::integer, std::move(member), name, help, range);
}
inline Key number(Member member, Text name, Text help, Range range) {
  return key(Type::number, std::move(member), name, help, range);
}
inline Key length(Member member, Text name, Text help) {
  return key(Type::length, std::move(member), name, help);
}
/// Text, or a list of texts that one text may stand for.
inline Key names(Member member, Text name, Text help, std::vector<std::string_view> words = {}) {
  Key made = key(Type::names, std::move(member), name, help);
  made.words = std::move(words);
  return made;
}
/// Of an enumeration, whose words stand in the order of its enumerators.
Key word(const Member& member, Text name, Text help, std::vector<std::string_view> words);
/// A key that is said only where it is not `otherwise`.
Key unless(std::string otherwise, Key key);
/// Numbers of that quantity.
inline Key of_quantity(Quantity quantity, Key key) {
  key.quantity = quantity;
  return key;
}
inline Key required(Key key) {
  key.required = true;
  return key;
}

/// More accuracy for more time, from value to value; of a word from word to word.
Key buys_accuracy(std::initializer_list<double> ladder, Key key);
Key buys_accuracy(Key word);
/// The same of a limit, where a run reaches it.
Key buys_accuracy_as_limit(std::initializer_list<double> ladder, Key key);

/// Lists of keys: where they act, of a part of the struct, together.
std::vector<Key> acting(Acts, std::vector<Key>);
template <class T, class M>
std::vector<Key> inside(M T::*part, std::vector<Key> keys) {
  for (Key& key : keys) key.member = key.member.inside(part);
  return keys;
}
std::vector<Key> joined(std::vector<Key>, std::vector<Key>);

/// Sets of keys of which exactly one is given, whole: the first that holds all that are given; other keys
/// stay absent. Where none is given, the first set that needs nothing is meant, if there is one.
using Choice = std::vector<std::vector<std::string_view>>;

/// A table of a scene as its errors name it: "[container]", "part 2 of radius of [spheres]".
struct Section {
  std::string name;
  const Locations& locations;

  /// `"size" in [container] must …`, at the key's place.
  [[noreturn]] void refuse(std::string_view key, std::string_view must) const;
  [[noreturn]] void fail(std::string_view key, const std::string& message) const;
};

/// What a scene may say in one of its tables, and the plain struct that receives it: a container, a size
/// distribution, a stage, or a table that stands for itself. Defaults are those of the struct.
struct Entry {
  std::string_view name;
  std::string_view help;
  std::vector<Key> keys;
  std::vector<Choice> choices = {};
  /// What the keys demand of each other; throws Error{bad_scene}.
  std::function<void(const void*, const Section&)> rule = {};
  /// Fills in what depends on the rest of the scene, where it is left out.
  std::function<void(void*, Scene&, const Section&)> complete = {};
  /// Of a distribution that may stand in a "file": the keys that the file's columns are, one or two.
  std::vector<std::string_view> columns = {};
  std::shared_ptr<const void> defaults = {};  ///< a struct as it is made
  std::function<std::shared_ptr<void>()> make = {};
  Locations* (*locations)(void*) = nullptr;  ///< of a struct that keeps them

  const Key* find(std::string_view key) const;
  /// The keys that the choices leave out. Throws Error{bad_scene} where two sets are mixed, or none is given
  /// that is needed.
  std::vector<std::string_view> left_out(const void* options, const Section&) const;
  /// The keys that have a value and are not left out, with it.
  std::vector<std::pair<const Key*, Value>> said(const void* options) const;
};

/// The entry of such structs.
template <class T>
Entry entry(Entry of) {
  of.defaults = std::make_shared<const T>();
  of.make = [] { return std::make_shared<T>(); };
  if constexpr (requires { &T::locations; })
    of.locations = [](void* options) { return &static_cast<T*>(options)->locations; };
  return of;
}
template <class T>
auto rule(void (*demand)(const T&, const Section&)) {
  return [demand](const void* options, const Section& section) {
    demand(*static_cast<const T*>(options), section);
  };
}
template <class T>
auto completion(void (*fill_in)(T&, Scene&, const Section&)) {
  return [fill_in](void* options, Scene& scene, const Section& section) {
    fill_in(*static_cast<T*>(options), scene, section);
  };
}

/// Lists of structs as tables of their entry.
template <class Item>
Tables tables_of(const std::vector<Item>& items, const Entry& entry) {
  Tables all{&entry};
  for (const Item& item : items) all.items.push_back(std::make_shared<Item>(item));
  return all;
}
template <class Item>
std::vector<Item> items_of(const Tables& tables) {
  std::vector<Item> items;
  for (const std::shared_ptr<void>& item : tables.items)
    items.push_back(*static_cast<const Item*>(item.get()));
  return items;
}
/// A key of one table.
template <class T, class Item>
Key table(std::optional<Item> T::*member, const Entry& (*entry)(), Text name, Text help) {
  Member way;
  way.get = [member, entry](const void* of) -> std::optional<Value> {
    const std::optional<Item>& item = static_cast<const T*>(of)->*member;
    return item ? std::optional<Value>(std::vector{tables_of(std::vector{*item}, entry())}) : std::nullopt;
  };
  way.set = [member](void* of, const Value& value) {
    static_cast<T*>(of)->*member = items_of<Item>(std::get<std::vector<Tables>>(value).front()).front();
  };
  Key made = key(Type::table, std::move(way), name, help);
  made.table = entry;
  return made;
}
/// A key of tables; and of a list of them for each `list_of`.
template <class T, class Item>
Key tables(std::vector<Item> T::*member, const Entry& (*entry)(), Text name, Text help) {
  Member way;
  way.get = [member, entry](const void* of) -> std::optional<Value> {
    const std::vector<Item>& items = static_cast<const T*>(of)->*member;
    return items.empty() ? std::nullopt : std::optional<Value>(std::vector{tables_of(items, entry())});
  };
  way.set = [member](void* of, const Value& value) {
    static_cast<T*>(of)->*member = items_of<Item>(std::get<std::vector<Tables>>(value).front());
  };
  Key made = key(Type::tables, std::move(way), name, help);
  made.table = entry;
  return made;
}
template <class T, class Item>
Key table_lists(std::vector<std::vector<Item>> T::*member, const Entry& (*entry)(), Text list_of, Text name,
                Text help) {
  Member way;
  way.get = [member, entry](const void* of) -> std::optional<Value> {
    std::vector<Tables> lists;
    for (const std::vector<Item>& items : static_cast<const T*>(of)->*member)
      lists.push_back(tables_of(items, entry()));
    return lists.empty() ? std::nullopt : std::optional<Value>(std::move(lists));
  };
  way.set = [member](void* of, const Value& value) {
    auto& lists = static_cast<T*>(of)->*member;
    lists.clear();
    for (const Tables& list : std::get<std::vector<Tables>>(value)) lists.push_back(items_of<Item>(list));
  };
  Key made = key(Type::table_lists, std::move(way), name, help);
  made.table = entry;
  made.list_of = list_of;
  return made;
}

/// "layer 2 of [spheres]", "layer 2 of class 1 of radius of [spheres]": what errors call the item-th table of
/// the list-th list in a key, both from 0.
std::string name_of_table(const Key&, std::size_t list, std::size_t item, const std::string& where);

/// What a value of this key must be, for people: "a positive length", "a whole number from 1 to 100"; with
/// its limits where only they refuse the one that was `given`.
std::string expectation(const Key&, const std::optional<Value>& given = {});

/// Whether a value is one that the key accepts. Lengths and coordinates beyond 1e±30 are
/// not.
bool accepts(const Key&, const Value&);

/// Throws Error{bad_scene} unless every value of the struct is one that a scene can say, by the entry's keys,
/// choices and rule.
void check(const Entry& entry, const void* options, const Section& section, bool in_bed = true);

}  // namespace bernal::schema

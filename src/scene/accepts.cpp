#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/entry.hpp"

namespace bernal::schema {
namespace {

std::string number_range(const Range& range) {
  const bool from = std::isfinite(range.min), to = std::isfinite(range.max);
  const std::string lower = fmt::format("{} {}", range.above_min ? "above" : "of at least", range.min);
  const std::string upper = fmt::format("{} {}", range.below_max ? "below" : "of at most", range.max);
  if (from && to) return fmt::format("a number {} and {}", lower, upper);
  if (from || to) return fmt::format("a number {}", from ? lower : upper);
  return "a finite number";
}

/// Whether a number is one that only its size keeps from being a length or a coordinate.
bool is_absurd(double v) {
  return std::isfinite(v) && v != 0 && (std::abs(v) < smallest_length || std::abs(v) > largest_length);
}

bool is_absurd(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return is_absurd(*number);
  if (const auto* polygon = std::get_if<Polygon>(&value)) {
    for (const auto& loop : polygon->loops)
      for (const Vector<2>& p : loop)
        if (is_absurd(p[0]) || is_absurd(p[1])) return true;
    return false;
  }
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  return numbers && std::ranges::any_of(*numbers, [](double v) { return is_absurd(v); });
}

bool has_endless_point(const Value& value) {
  const auto* polygon = std::get_if<Polygon>(&value);
  return polygon && std::ranges::any_of(polygon->loops, [](const auto& loop) {
           return std::ranges::any_of(loop, [](const Vector<2>& p) { return !p.allFinite(); });
         });
}

bool is_length(double v) { return v >= smallest_length && v <= largest_length; }
bool is_coordinate(double v) { return std::abs(v) <= largest_length; }
bool is_amount(double v) { return v == 0 || is_length(v); }
bool is_axis(double v) { return v >= 0 && v < max_dimension && v == std::floor(v); }

/// An array whose numbers fit, `count` of them if that is not 0.
template <bool (*fits)(double), std::size_t count = 0>
bool all(const Value& value) {
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  return numbers && !numbers->empty() && (count == 0 || numbers->size() == count) &&
         std::ranges::all_of(*numbers, fits);
}

/// Two or three of them.
template <bool (*fits)(double)>
bool two_or_three(const Value& value) {
  return all<fits, 2>(value) || all<fits, 3>(value);
}

template <bool (*has_components)(const Value&)>
bool is_direction(const Value& value) {
  return has_components(value) && std::ranges::any_of(std::get<std::vector<double>>(value),
                                                      [](double v) { return is_length(std::abs(v)); });
}
/// What they are to each other the domain says.
bool are_lines(const Value& value) {
  const auto* polygon = std::get_if<Polygon>(&value);
  return polygon && std::ranges::all_of(polygon->loops, [](const auto& loop) {
           return loop.size() >= 3 && std::ranges::all_of(loop, [](const Vector<2>& p) {
                    return is_coordinate(p[0]) && is_coordinate(p[1]);
                  });
         });
}
bool is_line(const Value& value) { return are_lines(value) && std::get<Polygon>(value).loops.size() == 1; }
bool are_axes(const Value& value) {
  const auto* axes = std::get_if<std::vector<double>>(&value);
  return axes && std::ranges::all_of(*axes, [&](double axis) {
           return is_axis(axis) && std::ranges::count(*axes, axis) == 1;
         });
}
bool are_names(const Value& value) {
  const auto* names = std::get_if<std::vector<std::string>>(&value);
  const auto is_name = [](const std::string& name) {
    return !name.empty() && name.find('\0') == std::string::npos;
  };
  return names && !names->empty() && std::ranges::all_of(*names, is_name);
}
bool is_file(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text && !text->empty() && text->find('\0') == std::string::npos;
}
/// A name that may stand in a table of commas, in a file of XML and in a script.
bool is_plain_name(const Value& value) {
  const auto* text = std::get_if<std::string>(&value);
  const auto is_plain = [](char c) {
    return static_cast<unsigned char>(c) >= ' ' && c != 0x7f &&
           std::string_view(",;\"'<>&\\").find(c) == std::string_view::npos;
  };
  return text && !text->empty() && text->front() != ' ' && text->back() != ' ' &&
         std::ranges::all_of(*text, is_plain);
}
/// Which are checked by themselves.
bool are_sizes(const Value& value) { return std::holds_alternative<std::vector<SceneSizes>>(value); }
bool are_tables(const Value& value) { return std::holds_alternative<std::vector<Tables>>(value); }

/// What a value must be, for people and for `accepts`, where that does not depend on the key.
struct Rule {
  std::string_view kind;
  bool (*accepts)(const Value&);
  bool has_length = true;
};
/// Lengths of which some may be 0.
const Rule lengths_not_negative = {"an array of lengths of at least 0", all<is_amount>};
const std::map<Type, Rule> rules = {
    {Type::length,
     {"a positive length",
      [](const Value& v) { return std::holds_alternative<double>(v) && is_length(std::get<double>(v)); }}},
    {Type::file, {"the path of a file", is_file, false}},
    {Type::direction, {"a direction [x, y, z]", is_direction<all<is_coordinate, 3>>}},
    {Type::push,
     {"a direction [x, y, z], in two dimensions [x, y]", is_direction<two_or_three<is_coordinate>>}},
    {Type::position, {"a point [x, y, z]", all<is_coordinate, 3>}},
    {Type::text, {"a name without commas, quotes and brackets", is_plain_name, false}},
    {Type::names, {"a name or an array of names", are_names, false}},
    {Type::corner, {"a point [x, y, z], in two dimensions [x, y]", two_or_three<is_coordinate>}},
    {Type::extents, {"two or three positive lengths [a, b, c]", two_or_three<is_length>}},
    {Type::points, {"an array of three points [x, y] or more", is_line}},
    {Type::lines, {"an array of arrays of three points [x, y] or more", are_lines}},
    {Type::coordinates, {"an array of coordinates", all<is_coordinate>}},
    {Type::lengths, {"an array of positive lengths", all<is_length>}},
    {Type::shares, {"an array of positive numbers", all<is_length>}},
    {Type::amounts, {"an array of numbers of at least 0", all<is_amount>}},
    {Type::axes, {"an array of axes, counted from 0, each once", are_axes, false}},
    {Type::distribution, {"a positive length or a table { distribution = … }", are_sizes}},
    {Type::parts, {"an array of lengths and tables { distribution = … }", are_sizes, false}},
    {Type::solids, {"an array of files and of tables { kind = … }", is_file, false}},
    {Type::table, {"a table", are_tables, false}},
    {Type::tables, {"an array of tables, or one table", are_tables, false}},
    {Type::table_lists, {"an array of arrays of tables", are_tables, false}},
};

const Rule& rule_of(const Key& key) {
  return key.type == Type::lengths && key.range.min == 0 ? lengths_not_negative : rules.at(key.type);
}

}  // namespace

std::string expectation(const Key& key, const std::optional<Value>& given) {
  const std::string words = fmt::format("\"{}\"", fmt::join(key.words, "\" or \""));
  const Range& range = key.range;
  if (key.type == Type::flag) return range.min > 0 ? "true or left out" : "true or false";
  if (key.type == Type::word) return words;
  if (key.type == Type::number) return number_range(range) + (key.words.empty() ? "" : " or " + words);
  if (key.type == Type::integer)
    return range.max > 0x1p53 ? fmt::format("a whole number of at least {}", range.min)
                              : fmt::format("a whole number from {:.0f} to {:.0f}", range.min, range.max);
  if (key.type == Type::names && !key.words.empty()) return fmt::format("{} or an array of them", words);
  if (key.type == Type::position && !key.words.empty()) return fmt::format("a point [x, y, z] or {}", words);
  if (key.type == Type::distribution && !key.words.empty())
    return fmt::format("{} or {}", rules.at(key.type).kind, words);
  if (key.type == Type::distribution && key.quantity == Quantity::volume)
    return "a positive volume or a table { distribution = … }";
  const Rule& rule = rule_of(key);
  if (key.table)
    return fmt::format("{}{} {{ {} = … }}", rule.kind, key.type == Type::length ? " or a table" : "",
                       key.table().keys.front().name);
  if (given && has_endless_point(*given)) return fmt::format("{}, whose coordinates are finite", rule.kind);
  return given && rule.has_length && is_absurd(*given)
             ? fmt::format("{} from {} to {}", rule.kind, smallest_length, largest_length)
             : std::string(rule.kind);
}

bool accepts(const Key& key, const Value& value) {
  const auto is_word = [&] {
    const auto* text = std::get_if<std::string>(&value);
    return text && std::ranges::find(key.words, *text) != key.words.end();
  };
  if (const auto* flag = std::get_if<bool>(&value))
    return key.type == Type::flag && key.range.contains(*flag);
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    return key.type == Type::integer && key.range.contains(static_cast<double>(*whole));
  if (key.type == Type::flag || key.type == Type::integer) return false;
  if (key.type == Type::word) return is_word();
  if (const auto* names = std::get_if<std::vector<std::string>>(&value); names && !key.words.empty())
    return key.type == Type::names && !names->empty() &&
           std::ranges::all_of(*names, [&](const std::string& name) {
             return std::ranges::find(key.words, name) != key.words.end();
           });
  if (key.type == Type::position && !key.words.empty() && is_word()) return true;
  if (key.type == Type::length && are_tables(value)) return key.table != nullptr;
  if (key.type != Type::number) return rule_of(key).accepts(value);
  const auto* number = std::get_if<double>(&value);
  return number ? std::isfinite(*number) && key.range.contains(*number) : is_word();
}

}  // namespace bernal::schema

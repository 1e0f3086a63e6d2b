#include "scene/read_value.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "scene/toml_text.hpp"

namespace bernal {

std::string written(const toml::node& node) {
  constexpr std::size_t longest = 60;
  if (const auto* text = node.as_string()) {
    std::string_view shown = text->get();
    if (shown.size() <= longest) return toml_string(shown);
    shown = shown.substr(0, longest);
    while (!shown.empty() && (shown.back() & 0xC0) == 0x80) shown.remove_suffix(1);  // whole UTF-8 characters
    return toml_string(shown.substr(0, shown.size() - 1)) + "…";
  }
  if (const auto* number = node.as_floating_point()) return toml_text(number->get());
  if (const auto* number = node.as_integer()) return toml_text(number->get());
  if (const auto* flag = node.as_boolean()) return toml_text(flag->get());
  if (node.is_table()) return "a table";
  if (const auto* array = node.as_array()) {
    std::vector<std::string> items;
    for (const toml::node& item : *array) {
      if (items.size() == 6 || item.is_array())
        return fmt::format("an array of {} value{}", array->size(), array->size() == 1 ? "" : "s");
      items.push_back(written(item));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  return "a date or time";
}

/// The number in a node, to the nearest double. -0 is 0. Nothing where there is none.
static std::optional<double> number_in(const toml::node& node, const Measured& measured) {
  if (const auto* whole = node.as_integer()) return static_cast<double>(whole->get());
  if (const auto* number = node.as_floating_point()) return number->get() + 0.0;
  const auto* text = node.as_string();
  if (!text || measured.quantity == Quantity::none) return std::nullopt;
  std::string complaint;
  const auto value = number_with_unit(text->get(), measured.quantity, measured.unit, complaint);
  if (!value) throw Error(ErrorCode::bad_argument, complaint);
  return value;
}

std::optional<schema::Value> value_in(const toml::node& node, bool as_double, const Measured& measured,
                                      const std::vector<std::string_view>& words) {
  if (const auto* flag = node.as_boolean()) return flag->get();
  if (const auto* text = node.as_string()) {
    if (measured.quantity == Quantity::none || std::ranges::find(words, text->get()) != words.end())
      return text->get();
    return number_in(node, measured);
  }
  if (const auto* number = node.as_integer(); number && !as_double) return number->get();
  if (node.is_number()) {
    const double number = *number_in(node, measured);
    const bool is_whole = number == std::floor(number) && std::abs(number) <= 0x1p53;
    if (is_whole && !as_double) return static_cast<std::int64_t>(number);
    return number;
  }
  const toml::array* array = node.as_array();
  if (!array) return std::nullopt;
  std::vector<double> numbers;
  for (const toml::node& item : *array) {
    const std::optional<double> number = number_in(item, measured);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<schema::Value> lines_in(const toml::node& node, bool one, const Measured& measured) {
  const auto line_in = [&](const toml::node& of, std::vector<Vector<2>>& line) {
    const toml::array* points = of.as_array();
    if (!points) return false;
    for (const toml::node& item : *points) {
      const toml::array* point = item.as_array();
      if (!point || point->size() != 2) return false;
      const auto x = number_in(*point->get(0), measured), y = number_in(*point->get(1), measured);
      if (!x || !y) return false;
      line.emplace_back(*x, *y);
    }
    return true;
  };
  Polygon polygon;
  if (one)
    return line_in(node, polygon.loops.emplace_back()) ? std::optional<schema::Value>(polygon) : std::nullopt;
  const toml::array* lines = node.as_array();
  if (!lines) return std::nullopt;
  for (const toml::node& item : *lines)
    if (!line_in(item, polygon.loops.emplace_back())) return std::nullopt;
  return polygon;
}

std::optional<std::size_t> first_that_is_no_point(const toml::node& node) {
  const toml::array* line = node.as_array();
  for (std::size_t k = 0; line && k < line->size(); ++k)
    if (const toml::array* point = line->get(k)->as_array(); !point || point->size() != 2) return k;
  return std::nullopt;
}

std::optional<schema::Value> names_in(const toml::node& node, const Measured& measured) {
  std::vector<std::string> names;
  const auto take = [&](const toml::node& item) {
    if (const auto* text = item.as_string())
      names.push_back(measured.quantity == Quantity::none ? text->get()
                                                          : without_unit(text->get(), measured.unit));
    else if (const auto* number = item.as_integer())
      names.push_back(fmt::format("{}", number->get()));
    else
      return false;
    return true;
  };
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array)
      if (!take(item)) return std::nullopt;
  } else if (!take(node)) {
    return std::nullopt;
  }
  return names;
}

}  // namespace bernal

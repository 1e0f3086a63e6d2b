#include "scene/toml_values.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/toml_text.hpp"

namespace bernal {
namespace {

using schema::Value;

std::optional<Value> number_in(const toml::node& node) {
  if (!node.is_number()) return std::nullopt;
  return *node.value<double>() + 0.0;  // -0 is 0
}

}  // namespace

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
      if (items.size() == 6 || item.is_array()) return fmt::format("an array of {} values", array->size());
      items.push_back(written(item));
    }
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  return "a date or time";
}

std::optional<Value> value_in(const toml::node& node, schema::Type type) {
  using schema::Type;
  switch (type) {
    case Type::flag:
      if (const auto* flag = node.as_boolean()) return flag->get();
      return std::nullopt;
    case Type::integer:
      if (const auto* number = node.as_integer()) return number->get();
      return std::nullopt;
    case Type::number:
    case Type::length:
      return number_in(node);
    case Type::word:
    case Type::file:
      if (const auto* text = node.as_string()) return text->get();
      return std::nullopt;
    case Type::direction:
    case Type::position:
    case Type::extents:
    case Type::lengths:
    case Type::shares:
    case Type::amounts:
    case Type::axes: {
      const toml::array* array = node.as_array();
      if (!array) return std::nullopt;
      std::vector<double> numbers;
      for (const toml::node& item : *array) {
        const std::optional<Value> number = number_in(item);
        if (!number) return std::nullopt;
        numbers.push_back(std::get<double>(*number));
      }
      return numbers;
    }
    case Type::distribution:
    case Type::parts:
      return std::nullopt;  // tables of their own
  }
  return std::nullopt;
}

}  // namespace bernal

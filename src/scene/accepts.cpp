#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/entry.hpp"

namespace bernal::schema {
namespace {

constexpr double smallest_length = 1e-30;
constexpr double largest_length = 1e30;

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
  const auto* numbers = std::get_if<std::vector<double>>(&value);
  return numbers && std::ranges::any_of(*numbers, [](double v) { return is_absurd(v); });
}

bool is_length(double v) { return v >= smallest_length && v <= largest_length; }
bool is_coordinate(double v) { return std::abs(v) <= largest_length; }

bool has_length(Type type) {
  constexpr std::array types = {Type::length,  Type::direction, Type::position, Type::extents,
                                Type::lengths, Type::shares,    Type::amounts,  Type::distribution};
  return std::ranges::find(types, type) != types.end();
}

std::string kind_of_value(const Key& key) {
  switch (key.type) {
    case Type::flag:
      return key.range.min > 0 ? "true or left out" : "true or false";
    case Type::integer:
      return key.range.max > 0x1p53
                 ? fmt::format("a whole number of at least {}", key.range.min)
                 : fmt::format("a whole number from {:.0f} to {:.0f}", key.range.min, key.range.max);
    case Type::number:
      return number_range(key.range) +
             (key.words.empty() ? "" : fmt::format(" or \"{}\"", fmt::join(key.words, "\" or \"")));
    case Type::length:
      return "a positive length";
    case Type::word:
      return fmt::format("\"{}\"", fmt::join(key.words, "\" or \""));
    case Type::file:
      return "the path of a file";
    case Type::direction:
      return "a direction [x, y, z]";
    case Type::position:
      return "a point [x, y, z]";
    case Type::extents:
      return "three positive lengths [a, b, c]";
    case Type::lengths:
      return "an array of positive lengths";
    case Type::shares:
      return "an array of positive numbers";
    case Type::amounts:
      return "an array of numbers of at least 0";
    case Type::axes:
      return "an array of axes, counted from 0, each once";
    case Type::distribution:
      return "a positive length or a table { distribution = … }";
    case Type::parts:
      return "an array of lengths and tables { distribution = … }";
  }
  return {};
}

}  // namespace

std::string expectation(const Key& key, const std::optional<Value>& given) {
  std::string kind = kind_of_value(key);
  if (given && has_length(key.type) && is_absurd(*given))
    kind += fmt::format(" from {} to {}", smallest_length, largest_length);
  return kind;
}

bool accepts(const Key& key, const Value& value) {
  const auto number = [&] { return std::get<double>(value); };
  const auto numbers = [&]() -> const std::vector<double>& { return std::get<std::vector<double>>(value); };
  const auto text = [&]() -> const std::string& { return std::get<std::string>(value); };
  switch (key.type) {
    case Type::flag:
      return key.range.contains(std::get<bool>(value));
    case Type::integer:
      return key.range.contains(static_cast<double>(std::get<std::int64_t>(value)));
    case Type::number:
      if (std::holds_alternative<std::string>(value))
        return std::ranges::find(key.words, text()) != key.words.end();
      return std::isfinite(number()) && key.range.contains(number());
    case Type::length:
      return is_length(number());
    case Type::word:
      return std::ranges::find(key.words, text()) != key.words.end();
    case Type::file:
      return !text().empty() && text().find('\0') == std::string::npos;
    case Type::direction: {
      const auto nonzero = [](double v) { return is_length(std::abs(v)); };
      return numbers().size() == 3 && std::ranges::all_of(numbers(), is_coordinate) &&
             std::ranges::any_of(numbers(), nonzero);
    }
    case Type::position:
      return numbers().size() == 3 && std::ranges::all_of(numbers(), is_coordinate);
    case Type::extents:
      return numbers().size() == 3 && std::ranges::all_of(numbers(), is_length);
    case Type::lengths:
    case Type::shares:
      return !numbers().empty() && std::ranges::all_of(numbers(), is_length);
    case Type::amounts: {
      const auto amount = [](double v) { return v == 0 || is_length(v); };
      return !numbers().empty() && std::ranges::all_of(numbers(), amount);
    }
    case Type::axes: {
      const auto axis = [&](double v) {
        return v >= 0 && v < max_dimension && v == std::floor(v) && std::ranges::count(numbers(), v) == 1;
      };
      return !numbers().empty() && std::ranges::all_of(numbers(), axis);
    }
    case Type::distribution:
    case Type::parts:
      return !std::get<std::vector<SceneSizes>>(value).empty();  // which are checked by themselves
  }
  return false;
}

}  // namespace bernal::schema

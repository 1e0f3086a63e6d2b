#include "measured.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"

using namespace bernal;

double number_of(std::string_view option, const std::string& text, Quantity of, std::optional<Unit> unit) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(number)) return number;
  std::string complaint;
  const std::optional<double> value = number_with_unit(text, of, unit.value_or(Unit::m), complaint);
  if (!value)
    throw Error(ErrorCode::bad_argument, fmt::format("{} must be a number, or one with its unit, not {}: {}",
                                                     option, plain_text(text), complaint));
  if (!unit && of != Quantity::none)
    throw Error(ErrorCode::bad_argument,
                fmt::format("{} has a unit, and the file may have another: say --unit too, that of the file",
                            option));
  return *value;
}

std::vector<double> lengths_of(std::string_view option, const std::string& text, std::optional<Unit> unit) {
  std::vector<double> lengths;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    const std::string one(trimmed(std::string_view(text).substr(from, end - from)));
    if (one.empty())
      throw Error(ErrorCode::bad_argument, fmt::format("{} takes lengths between commas, such as 10,10,20 or "
                                                       "\"1 cm,1 cm,20 mm\", not \"{}\"",
                                                       option, plain_text(text)));
    lengths.push_back(number_of(option, one, Quantity::length, unit));
    from = end + 1;
  }
  return lengths;
}

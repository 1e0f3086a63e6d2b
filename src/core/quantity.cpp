#include "bernal/core/quantity.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/text.hpp"

namespace bernal {
namespace {

/// One of it is `times` / `over` of what the number is wanted in.
struct NamedFactor {
  std::string_view name;
  std::int64_t times = 1, over = 1;
};

constexpr NamedFactor units_of_mass[] = {
    {"mg", 1, 1'000'000}, {"g", 1, 1000}, {"kg"}, {"t", 1000, 1}, {"lb", 45'359'237, 100'000'000}};
constexpr NamedFactor units_of_density[] = {{"kg/m3"}, {"g/cm3", 1000, 1}};
/// In UTF-8, with the micro sign and with the Greek letter; with the superscript.
constexpr std::pair<std::string_view, std::string_view> other_names[] = {
    {"\xC2\xB5m", "um"}, {"\xCE\xBCm", "um"}, {"kg/m\xC2\xB3", "kg/m3"}, {"g/cm\xC2\xB3", "g/cm3"}};

constexpr std::string_view phi_scale = "phi";
constexpr std::string_view digit_signs = "0123456789";

bool is_grain(Quantity of) { return of == Quantity::diameter; }

std::vector<NamedFactor> units_for(Quantity of, Unit unit) {
  std::vector<NamedFactor> all;
  const auto take = [&](std::span<const NamedFactor> some) { all.assign(some.begin(), some.end()); };
  if (of == Quantity::mass) take(units_of_mass);
  if (of == Quantity::density) take(units_of_density);
  if (of == Quantity::length || is_grain(of))
    for (const std::string_view name : unit_names()) {
      const Ratio ratio = conversion_ratio(unit_named(name), unit);
      all.push_back(
          {name, static_cast<std::int64_t>(ratio.numerator), static_cast<std::int64_t>(ratio.denominator)});
    }
  return all;
}

/// Where the number ends that a text begins with; 0 where it begins with none.
std::size_t end_of_number(std::string_view text) {
  const auto after_digits = [&](std::size_t from) {
    return std::min(text.find_first_not_of(digit_signs, from), text.size());
  };
  std::size_t end = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::size_t first = end;
  end = after_digits(end);
  std::size_t found = end - first;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = end + 1;
    end = after_digits(fraction);
    found += end - fraction;
  }
  if (found == 0) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    std::size_t power = end + 1;
    if (power < text.size() && (text[power] == '-' || text[power] == '+')) ++power;
    if (const std::size_t last = after_digits(power); last > power) end = last;
  }
  return end;
}

/// The double nearest to a decimal number, as `end_of_number` takes it, times `times` / `over`: its digits
/// are multiplied and divided as on paper. Nothing beyond what a double holds. Cost: O(digits).
std::optional<double> decimal_product(std::string_view number, std::int64_t times, std::int64_t over) {
  constexpr std::size_t precise = 40;  // digits of the quotient, at least: any remainder decides only ties
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view mantissa = number.substr(0, exponent_at);
  std::int64_t exponent = 0;
  if (exponent_at < number.size()) {
    std::string_view power = number.substr(exponent_at + 1);
    if (power.starts_with('+')) power.remove_prefix(1);
    if (std::from_chars(power.data(), power.data() + power.size(), exponent).ec != std::errc() ||
        std::abs(exponent) > 10'000)
      return {};
  }
  std::string factors;
  bool is_fraction = false;
  for (const char c : mantissa) {
    if (c >= '0' && c <= '9') factors += c;
    exponent -= is_fraction && c != '.';
    is_fraction = is_fraction || c == '.';
  }
  std::int64_t carry = 0;
  for (std::size_t k = factors.size(); k-- > 0;) {
    carry += times * (factors[k] - '0');
    factors[k] = static_cast<char>('0' + carry % 10);
    carry /= 10;
  }
  if (carry > 0) factors.insert(0, fmt::format("{}", carry));
  const std::size_t more = over > 1 ? precise : 0;
  factors.append(more, '0');
  exponent -= static_cast<std::int64_t>(more);
  std::int64_t rest = 0;
  for (char& c : factors) {
    rest = 10 * rest + (c - '0');
    c = static_cast<char>('0' + rest / over);
    rest %= over;
  }
  if (rest > 0) factors += '1', --exponent;
  const std::string text = fmt::format("{}{}e{}", number.starts_with('-') ? "-" : "", factors, exponent);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return {};
  return value + 0.0;  // -0 is 0
}

std::string_view example_of(Quantity of) {
  return of == Quantity::mass      ? "2 kg"
         : of == Quantity::density ? "1550 kg/m3"
         : of == Quantity::spread  ? "0.6 phi"
         : of == Quantity::volume  ? "12.5 mm3"
                                   : "25.4 mm";
}

/// Of a name such as "mm3", "mm^3" or "mm" with a superscript three, the unit of length.
std::string_view length_of_cubic(std::string_view name) {
  for (const std::string_view cube : {"^3", "\xC2\xB3", "3"})
    if (name.ends_with(cube)) return trimmed(name.substr(0, name.size() - cube.size()));
  return {};
}

std::optional<double> volume_with_unit(std::string_view number, std::string_view name, Unit unit,
                                       std::string& complaint) {
  const std::optional<double> value = decimal_product(number, 1, 1);
  const auto& names = unit_names();
  const std::string_view length = length_of_cubic(name);
  if (std::ranges::find(names, length) != std::ranges::end(names)) {
    const Ratio ratio = conversion_ratio(unit_named(length), unit);
    const double volume = value.value_or(0) * std::pow(ratio.numerator / ratio.denominator, 3);
    if (value && std::isfinite(volume)) return volume;
    complaint = "that is beyond what numbers can hold";
    return {};
  }
  complaint = name.empty() ? fmt::format("it names no unit; write \"{} {}3\", or {} without quotes", number,
                                         name_of(unit), number)
                           : fmt::format(
                                 "a volume has a unit of length to the power of three, such as "
                                 "\"{} {}3\"",
                                 number, name_of(unit));
  return {};
}

}  // namespace

std::optional<std::string> without_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && digit_signs.find(text[at]) != std::string_view::npos;
  };
  if (comma == std::string_view::npos || comma == 0 || !is_digit(comma - 1) || !is_digit(comma + 1))
    return {};
  std::string with_point(text);
  with_point[comma] = '.';
  const std::size_t end = end_of_number(with_point);
  if (end <= comma || with_point.find(',', end) != std::string::npos) return {};
  return with_point;
}

std::optional<double> number_with_unit(std::string_view text, Quantity of, Unit unit,
                                       std::string& complaint) {
  text = trimmed(text);
  if (const auto with_point = without_decimal_comma(text)) {
    const std::size_t comma = text.find(',');
    std::string joined(text);
    joined.erase(comma, 1);
    const bool is_of_thousands =
        std::min(text.find_first_not_of(digit_signs, comma + 1), text.size()) == comma + 4;
    complaint = is_of_thousands
                    ? fmt::format("its comma may be one of thousands or of decimals; write \"{}\" or \"{}\"",
                                  joined, *with_point)
                    : fmt::format("it has a decimal comma; write a point, \"{}\"", *with_point);
    return {};
  }
  const std::size_t end = end_of_number(text);
  if (end == 0) {
    complaint = fmt::format("it is no number with a unit, such as \"{}\"", example_of(of));
    return {};
  }
  const std::string_view number = text.substr(0, end), said = trimmed(text.substr(end));
  if (of == Quantity::volume) return volume_with_unit(number, said, unit, complaint);
  std::string_view name = said;
  for (const auto& [other, same] : other_names)
    if (name == other) name = same;
  std::vector<NamedFactor> units = units_for(of, unit);
  if (name == phi_scale && (is_grain(of) || of == Quantity::spread)) {
    const std::optional<double> value = decimal_product(number, 1, 1);
    const double size = value && is_grain(of) ? std::exp2(-*value) : 0;
    if (value && of == Quantity::spread) return *value * std::numbers::ln2;
    if (size > 0 && std::isfinite(size)) {
      const Ratio ratio = conversion_ratio(Unit::mm, unit);
      return size * ratio.numerator / ratio.denominator;
    }
    complaint = "no grain is of that size";
    return {};
  }
  const auto found = std::ranges::find(units, name, &NamedFactor::name);
  if (found != units.end()) {
    const std::optional<double> value = decimal_product(number, found->times, found->over);
    if (!value) complaint = "that is beyond what numbers can hold";
    return value;
  }
  std::vector<std::string_view> known;
  for (const NamedFactor& each : units) known.push_back(each.name);
  if (is_grain(of) || of == Quantity::spread) known.push_back(phi_scale);
  if (name.empty())
    complaint = fmt::format("it names no unit; write \"{} {}\", or {} without quotes", number,
                            of == Quantity::length || is_grain(of)
                                ? name_of(unit)
                                : example_of(of).substr(example_of(of).find(' ') + 1),
                            number);
  else if (name == phi_scale)
    complaint = of == Quantity::length
                    ? "phi is of diameters of grains; write diameter = …, or a length"
                    : fmt::format("phi is of diameters of grains; use one of {}", fmt::join(known, ", "));
  else
    complaint =
        fmt::format("its unit \"{}\" is unknown; use one of {}", plain_text(said), fmt::join(known, ", "));
  return {};
}

std::string without_unit(const std::string& condition, Unit unit) {
  const std::size_t sign = condition.find_last_of("=<>");
  if (sign == std::string::npos) return condition;
  std::string complaint;
  const auto value =
      number_with_unit(std::string_view(condition).substr(sign + 1), Quantity::length, unit, complaint);
  return value ? fmt::format("{} {}", condition.substr(0, sign + 1), *value) : condition;
}

}  // namespace bernal

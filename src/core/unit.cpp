#include "bernal/core/unit.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <vector>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

/// One unit is numerator · 10^exponent metres: with both integers small, every factor between two units is a
/// quotient of integers below 2^53, and so one correctly rounded division.
struct Definition {
  int numerator;
  int exponent;
};

constexpr double power_of_ten(int n) {
  double p = 1;
  for (int k = 0; k < n; ++k) p *= 10;  // exact up to 10^22
  return p;
}

constexpr double quotient(Definition from, Definition to) {
  const int shift = from.exponent - to.exponent;
  return from.numerator * power_of_ten(shift > 0 ? shift : 0) /
         (to.numerator * power_of_ten(shift < 0 ? -shift : 0));
}

constexpr Definition metre{1, 0};
constexpr std::array<Definition, 7> definitions = {
    {{1, -9}, {1, -6}, {1, -3}, {1, -2}, metre, {254, -4}, {3048, -4}}};
constexpr std::array<Unit, 7> table = {{{"nm", quotient(definitions[0], metre)},
                                        {"um", quotient(definitions[1], metre)},
                                        {"mm", quotient(definitions[2], metre)},
                                        {"cm", quotient(definitions[3], metre)},
                                        {"m", quotient(definitions[4], metre)},
                                        {"in", quotient(definitions[5], metre)},
                                        {"ft", quotient(definitions[6], metre)}}};

std::size_t index_of(std::string_view name) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == name) return i;
    names.push_back(table[i].name);
  }
  throw Error(ErrorCode::bad_argument,
              fmt::format("unknown unit \"{}\": use one of {}", name, fmt::join(names, ", ")));
}

}  // namespace

std::span<const Unit> units() { return table; }

double metres_per(std::string_view unit) { return table[index_of(unit)].metres; }

double conversion_factor(std::string_view from, std::string_view to) {
  return quotient(definitions[index_of(from)], definitions[index_of(to)]);
}

}  // namespace bernal

#include "bernal/core/unit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"

namespace bernal {
namespace {

/// One unit is numerator · 10^exponent metres: with both integers small, every factor between two units is a
/// quotient of integers below 2^53, and so one correctly rounded division.
struct Definition {
  int numerator;
  int exponent;
};

constexpr std::int64_t power_of_ten(int n) {
  std::int64_t p = 1;
  for (int k = 0; k < n; ++k) p *= 10;
  return p;
}

constexpr Ratio quotient(Definition from, Definition to) {
  const int shift = from.exponent - to.exponent;
  const std::int64_t above = from.numerator * power_of_ten(shift > 0 ? shift : 0),
                     below = to.numerator * power_of_ten(shift < 0 ? -shift : 0);
  const std::int64_t common = std::gcd(above, below);
  return {static_cast<double>(above / common), static_cast<double>(below / common)};
}

constexpr Definition definitions[] = {{1, -9}, {1, -6}, {1, -3}, {1, -2}, {1, 0}, {254, -4}, {3048, -4}};
constexpr std::string_view names[] = {"nm", "um", "mm", "cm", "m", "in", "ft"};

Definition definition_of(Unit unit) { return definitions[static_cast<std::size_t>(unit)]; }

}  // namespace

std::string_view name_of(Unit unit) { return names[static_cast<std::size_t>(unit)]; }

std::span<const std::string_view> unit_names() { return names; }

Unit unit_named(std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == std::end(names))
    throw Error(ErrorCode::bad_argument,
                fmt::format("unknown unit \"{}\": use one of {}", name, fmt::join(names, ", ")));
  return static_cast<Unit>(found - names);
}

double metres_per(Unit unit) { return conversion_factor(unit, Unit::m); }

std::optional<Unit> unit_of_metres(double metres) {
  for (std::size_t k = 0; k < std::size(names); ++k)
    if (const Unit unit{static_cast<int>(k)}; std::abs(metres_per(unit) / metres - 1) < 1e-9) return unit;
  return {};
}

Ratio conversion_ratio(Unit from, Unit to) { return quotient(definition_of(from), definition_of(to)); }
double conversion_factor(Unit from, Unit to) { return conversion_ratio(from, to).nearest(); }

bool is_at_most(double length, Unit unit, double other, Unit unit_of_other) {
  const auto [above, below] = conversion_ratio(unit_of_other, unit);
  // A product and what rounding it lost are together the exact product; the nearest doubles of two products
  // stand in their order, or are equal.
  const double left = length * below, right = other * above;
  if (left != right) return left < right;
  return std::fma(length, below, -left) <= std::fma(other, above, -right);
}

double largest_at_most(double length, Unit from, Unit to) {
  double largest = length * conversion_factor(from, to);
  while (!is_at_most(largest, to, length, from)) largest = std::nextafter(largest, 0.0);
  for (double next = largest; is_at_most(next, to, length, from);
       next = std::nextafter(next, std::numeric_limits<double>::infinity()))
    largest = next;
  return largest;
}

}  // namespace bernal

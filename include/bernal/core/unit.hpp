#pragma once
#include <span>
#include <string_view>

namespace bernal {

/// A length unit by the name that users write.
struct Unit {
  std::string_view name;
  double metres;
};

/// nm, um, mm, cm, m, in, ft.
std::span<const Unit> units();

/// Metres in one unit. Throws Error{bad_argument} that lists the names for an unknown one.
double metres_per(std::string_view unit);

/// Lengths in `from` times this are lengths in `to`. Exactly 1 for equal names; otherwise correctly rounded
/// for the powers of ten between metric units.
double conversion_factor(std::string_view from, std::string_view to);

}  // namespace bernal

#pragma once
#include <span>
#include <string_view>

namespace bernal {

/// A unit of length.
enum class Unit { nm, um, mm, cm, m, in, ft };

/// What users write: "nm", "um", "mm", …
std::string_view name_of(Unit);
/// All names, in the order of the enumerators.
std::span<const std::string_view> unit_names();
/// Throws Error{bad_argument} that lists the names for an unknown one.
Unit unit_named(std::string_view name);

/// Metres in one unit.
double metres_per(Unit unit);

/// Lengths in `from` times this are lengths in `to`. Exactly 1 for equal units; otherwise correctly rounded
/// for the powers of ten between metric units.
double conversion_factor(Unit from, Unit to);

}  // namespace bernal

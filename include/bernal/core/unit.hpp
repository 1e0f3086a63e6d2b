#pragma once
#include <optional>
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
/// The unit of so many metres, to 1e-9 of them, as files write roundings; none if there is no such unit.
std::optional<Unit> unit_of_metres(double metres);

/// A quotient of positive doubles, both integers without a common factor where it is one of units.
struct Ratio {
  double numerator = 1, denominator = 1;

  double nearest() const { return numerator / denominator; }
};

/// Lengths in `from` times this are lengths in `to`, exactly: 127/5 from inches to millimetres.
Ratio conversion_ratio(Unit from, Unit to);
/// The double nearest to that.
double conversion_factor(Unit from, Unit to);

/// Whether a length is at most another one, in units of their own, as exact real numbers: no product and no
/// quotient is rounded. Precondition: both are between 1e-30 and 1e30.
bool is_at_most(double length, Unit unit, double other, Unit unit_of_other);
/// The largest double in `to` that is at most a length in `from`, exactly. Precondition: as above.
double largest_at_most(double length, Unit from, Unit to);

}  // namespace bernal

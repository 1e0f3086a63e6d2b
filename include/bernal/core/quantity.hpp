#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "bernal/core/unit.hpp"

namespace bernal {

/// What a number may be a number of, where people write its unit.
enum class Quantity {
  none,
  length,    ///< "25.4 mm": the units of `Unit`, and µm
  diameter,  ///< of a grain: a length, or "1.5 phi", which is 2^-1.5 mm (Krumbein 1934)
  spread,    ///< of the logarithm of a size: "0.6 phi" is 0.6 ln 2
  mass,      ///< "2 kg": mg, g, kg, t, lb
  density,   ///< "1550 kg/m3", "2.5 g/cm3"
  volume,    ///< "12.5 mm3": the units of lengths, each to the power of three
};

/// A number with its unit: a length in `unit`, a volume in `unit` to the power of three, a mass in kg, a
/// density in kg/m³, a spread as it is. Decimal digits are converted exactly and rounded once, so that
/// "25.4 mm" is 1 in; of phi the power of two is rounded first, of volumes the factor. Where `text` is no
/// such number there is none, and `complaint` says why, with the remedy: a number without a unit, an unknown
/// unit, a decimal comma.
std::optional<double> number_with_unit(std::string_view text, Quantity, Unit unit, std::string& complaint);

/// "z < 5 mm" as "z < 5": the number behind the last sign of a condition, a length that may carry its unit,
/// as a number in `unit`. As it stands where there is no such length.
std::string without_unit(const std::string& condition, Unit unit);

/// "25,4 mm" with a point in the place of the comma; nothing where there is no decimal comma.
std::optional<std::string> without_decimal_comma(std::string_view text);

}  // namespace bernal

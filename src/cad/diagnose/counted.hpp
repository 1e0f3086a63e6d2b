#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace bernal::cad {

/// "1 open edge", "72 open edges".
std::string counted(std::uint64_t count, std::string_view one, std::string_view many);

/// Rounded up to three digits, for stating an upper bound.
inline double rounded_up(double bound) {
  if (!(bound > 0) || !std::isfinite(bound)) return bound;
  const int digits = 2 - static_cast<int>(std::floor(std::log10(bound)));
  const auto text = [&](double number) { return fmt::format("{:.3g}", number); };
  const double unit = std::pow(10.0, -digits);
  double rounded = std::strtod(text(bound).c_str(), nullptr);
  while (rounded < bound) rounded = std::strtod(text(rounded + unit).c_str(), nullptr);
  return rounded;
}

}  // namespace bernal::cad

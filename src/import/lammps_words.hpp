#pragma once
#include <optional>
#include <string_view>

#include "bernal/core/unit.hpp"

namespace bernal {

/// The unit of lengths of a style of units; none of those whose lengths are reduced or in ångström.
inline std::optional<Unit> unit_of_style(std::string_view style) {
  if (style == "si") return Unit::m;
  if (style == "cgs") return Unit::cm;
  if (style == "micro") return Unit::um;
  if (style == "nano") return Unit::nm;
  return {};
}

}  // namespace bernal

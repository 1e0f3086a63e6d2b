#pragma once
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "bernal/core/unit.hpp"
#include "core/csv_lines.hpp"

namespace bernal {

/// The unit of lengths of a style of units; none of those whose lengths are reduced or in ångström. Throws
/// for a word that is no style.
inline std::optional<Unit> unit_of_style(std::string_view style, const CsvLines& lines) {
  if (style == "si") return Unit::m;
  if (style == "cgs") return Unit::cm;
  if (style == "micro") return Unit::um;
  if (style == "nano") return Unit::nm;
  for (const std::string_view other : {"lj", "real", "metal", "electron"})
    if (style == other) return {};
  lines.fail(fmt::format("{} is no style of units of LAMMPS; mend the word, or take it out and give --unit",
                         bernal::quoted(style)));
}

}  // namespace bernal

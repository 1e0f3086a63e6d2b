#pragma once
#include <optional>
#include <string_view>

#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {

/// The body of a LAMMPS data file, after its first lines: counts, box, and a line
/// `id type diameter density x y z` a sphere under that heading.
void write_atoms(TextFile& out, const Exported& file, double density, std::string_view heading);

/// "p p f", whose third axis is a period in the plane.
std::string lammps_boundary(const Exported&);

/// The unit of lengths of a style of units; none of those whose lengths are reduced or in ångström. Throws
/// for a word that is no style.
std::optional<Unit> unit_of_style(std::string_view name, const CsvLines& lines);

}  // namespace bernal

#pragma once
#include <optional>
#include <string_view>

#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {

/// The tilts of a box, in the order of a `Tilt`, as LAMMPS names them.
inline constexpr std::string_view tilt_names[] = {"xy", "xz", "yz"};

/// Writes the body of a LAMMPS data file, after its first lines: counts, box, and under the heading a line
/// `id type diameter density x y z` for each sphere; densities are divided by
/// `unit_of_density`, in kg/m³.
void write_atoms(TextFile& out, const Exported& file, double unit_of_density, std::string_view heading);

/// "p p f"; in two dimensions the third axis is periodic.
std::string lammps_boundary(const Exported&);

/// The unit of lengths of a style of units; absent for reduced lengths and ångström. Throws for an unknown
/// style.
std::optional<Unit> unit_of_style(std::string_view name, const CsvLines& lines);

}  // namespace bernal

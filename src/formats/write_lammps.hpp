#pragma once
#include <string_view>

#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {

/// The body of a LAMMPS data file, after its first lines: counts, box, and a line
/// `id type diameter density x y z` a sphere under that heading.
void write_atoms(TextFile& out, const Exported& file, double density, std::string_view heading);

}  // namespace bernal

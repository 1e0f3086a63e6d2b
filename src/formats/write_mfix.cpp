#include <fmt/format.h>

#include "formats/format.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// MFiX skips eighteen lines, of which the first says which version this is, then counts on: data begin in
/// line 35. Empty lines it does not count.
void write_mfix(const Exported& file, StagedFolder& staged) {
  const int dimension = file.dimension();
  const std::string bar(72, '=');
  const Bounds<3> box = file.box();
  TextFile out(staged.add(file.output.file.string()));
  out.add("Version 2.0\n", bar, "\n", file.title(), "\nSI units: lengths in m, density in kg/m3.\n");
  out.add("The particles lie between\n  ", row_of(box.lower), "\nand\n  ", row_of(box.upper),
          "\nso the domain of the simulation has to hold that.\n");
  out.add("Columns: the coordinates");
  out.add(file.type_count > 1 ? ", the phase, the diameter.\n" : ", the diameter.\n");
  out.add(
      "Variables with T are read from the columns, in the order below.\n"
      "Those with F are the same for every particle.\n"
      "Temperature and species count only where their equations are solved.\n"
      "With several species, give the fractions of all of them there.\n"
      "User scalars: none.\n"
      "MFiX reads this from particle_input.dat in the folder of the project.\n"
      "Data start at line 35.\n",
      bar, '\n');
  out.add("Dimension:    ", dimension, "\nParticles:    ", file.size(), '\n');
  out.add(bar, "\nVariable      Read(T/F)     Default value (when Read=F)\n", bar, '\n');
  out.add("Coordinates      T          Must always be T\n");
  out.add("Phase_ID         ", file.type_count > 1 ? "T\n" : "F          1\n");
  out.add("Diameter         T\nDensity          F          ", file.output.density, '\n');
  out.add("Velocity         F          ", dimension == 2 ? "0.0 0.0\n" : "0.0 0.0 0.0\n");
  out.add(
      "Temperature      F          298.15\nSpecies          F          1.0\n"
      "User_Scalar      F          0.0\n");
  out.add(bar, "\n   X   Y   ", dimension == 2 ? "" : "Z   ", file.type_count > 1 ? "Phase_ID   " : "",
          "Diameter\n", bar, '\n');
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (int k = 0; k < dimension; ++k) out.add(file.coordinate(k, i), ' ');
    if (file.type_count > 1) out.add(file.types[i], ' ');
    out.add(2 * file.spheres.r[i], '\n');
  }
  out.close();
}

}  // namespace

const Format& mfix_format() {
  static const Format format{
      .table = {.keys =
                    output_entry("mfix", "MFiX-DEM particle_input.dat, version 2.0", {"density", "types"}),
                .file = "particle_input.dat",
                .least_dimension = 2,
                .unit = Unit::m,
                .sizes = "diameter"},
      .write = write_mfix};
  return format;
}

}  // namespace bernal

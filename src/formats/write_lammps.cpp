#include "formats/write_lammps.hpp"

#include <fmt/format.h>

#include "bernal/core/unit.hpp"

namespace bernal {
namespace {

/// A system of units that has this one for lengths, and how many kg/m³ its density of 1 is.
struct UnitStyle {
  std::string_view name, mass;
  double density;
};
UnitStyle unit_style(Unit length) {
  switch (length) {
    case Unit::m:
      return {"si", "kg", 1};
    case Unit::cm:
      return {"cgs", "g", 1e3};
    case Unit::um:
      return {"micro", "pg", 1e3};
    case Unit::nm:
      return {"nano", "ag", 1e6};
    case Unit::mm:
      return {"lj", "kg", 1e9};
    default:
      return {"lj", "kg", 1 / (metres_per(length) * metres_per(length) * metres_per(length))};
  }
}

void write_lammps(const Exported& file, StagedFolder& staged) {
  const UnitStyle units = unit_style(file.unit());
  TextFile out(staged.add(file.output.file.string()));
  out.add("# ", file.title(), "; lengths in ", name_of(file.unit()), ", masses in ", units.mass,
          "; of density ", file.output.density, " kg/m3\n");
  out.add("# for: units ", units.name, "; dimension ", file.dimension(), "; boundary ",
          file.dimension() == 2 ? file.periods_as("p", "f").substr(0, 4) + "p" : file.periods_as("p", "f"),
          "; atom_style sphere; neighbor ", 0.5 * file.largest_radius(), " bin; read_data ", file.name(),
          "\n");
  write_atoms(out, file, file.output.density / units.density, "Atoms # sphere");
  out.close();
}

}  // namespace

void write_atoms(TextFile& out, const Exported& file, double density, std::string_view heading) {
  const Bounds<3> box = file.box();
  out.add("\n", file.size(), " atoms\n", file.type_count, " atom types\n\n");
  constexpr std::string_view axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) out.add(box.lower[k], ' ', box.upper[k], ' ', axes[k], "lo ", axes[k], "hi\n");
  out.add("\n", heading, "\n\n");
  const std::string of_density = fmt::format(" {} ", density);
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(i + 1, ' ', file.types[i], ' ', 2 * file.spheres.r[i], of_density, file.coordinate(0, i), ' ',
            file.coordinate(1, i), ' ', file.coordinate(2, i), '\n');
}

const Format& lammps_format() {
  static const Format format{
      .table = {.keys = output_entry("lammps", "LAMMPS data file for read_data, atom_style sphere",
                                     {"unit", "density", "types"}),
                .file = "lammps.data",
                .least_dimension = 2,
                .unit = Unit::m,
                .sizes = "diameter"},
      .write = write_lammps};
  return format;
}

}  // namespace bernal

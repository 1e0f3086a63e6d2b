#include <fmt/format.h>
#include <fmt/ranges.h>

#include "files/csv_lines.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/templates.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// MFiX skips eighteen lines, the first of which holds the version, then counts non-empty lines: data begin
/// in line 35.
void write_mfix(const Exported& file, TextFile& out) {
  const int dimension = file.dimension();
  const bool has_phases = file.type_count > 1, is_flat = dimension == 2;
  const bool has_densities = !file.type_densities.empty();
  const Bounds<3> box = file.box();
  out.add(filled(particle_input_dat,
                 {{"TITLE", file.title()},
                  {"LOWER", row_of(box.lower)},
                  {"UPPER", row_of(box.upper)},
                  {"PHASE_IN_WORDS", has_phases ? ", the phase" : ""},
                  {"DIMENSION", std::to_string(dimension)},
                  {"PARTICLES", std::to_string(file.size())},
                  {"PHASE", has_phases ? "T" : "F          1"},
                  {"DENSITY", has_densities ? "T" : fmt::format("F          {}", file.density())},
                  {"DENSITY_IN_WORDS", has_densities ? ", the density" : ""},
                  {"LAST", has_densities ? "   Density" : ""},
                  {"VELOCITY", is_flat ? "0.0 0.0" : "0.0 0.0 0.0"},
                  {"AXES", fmt::format("{}{}", is_flat ? "" : "Z   ", has_phases ? "Phase_ID   " : "")}}));
  for (std::size_t i = 0; i < file.size(); ++i) {
    for (int k = 0; k < dimension; ++k) out.add(file.coordinate(k, i), ' ');
    if (has_phases) out.add(file.types[i], ' ');
    out.add(2 * file.spheres.r[i]);
    if (has_densities) out.add(' ', file.density_of(file.types[i]));
    out.add('\n');
  }
}

/// The statements before the data.
struct MfixHead {
  int dimension = 3;
  std::uint64_t particles = 0;
  std::vector<std::string> columns;
  bool more_may_follow = false;    ///< further columns, whose number only the run knows
  std::optional<double> diameter;  ///< of all spheres, if there is no column for it
};

/// "Diameter T" is a column, "Density F 2500" is not.
void take_variable(std::span<const std::string_view> words, MfixHead& head, const ForeignLines& lines) {
  const std::string_view name = words[0];
  const bool is_column = words[1] == "T";
  const auto add = [&](int count) {
    for (int k = 0; k < count && is_column; ++k) head.columns.push_back(fmt::format("{}_{}", name, k));
  };
  if (name == "Coordinates") {
    for (int k = 0; k < head.dimension; ++k) head.columns.emplace_back(1, "xyz"[k]);
  } else if (name == "Diameter") {
    if (is_column) head.columns.emplace_back("diameter");
    if (!is_column && words.size() > 2) head.diameter = lines.number(words[2], "Diameter");
  } else if (name == "Velocity") {
    add(head.dimension);
  } else if (name == "Phase_ID" || name == "Density" || name == "Temperature") {
    add(1);
  } else if (name == "Species" || name.starts_with("User_") || name.starts_with("Rotational")) {
    head.more_may_follow = head.more_may_follow || is_column;  // the last columns, ignored
  } else if (is_column) {
    lines.fail(
        fmt::format("the variable {} is not known, and so not what stands in the columns; known are {}",
                    bernal::quoted(name),
                    "Coordinates, Phase_ID, Diameter, Density, Velocity, Temperature, Species, User_Scalar"));
  }
}

/// Checks a row against the variables that are columns.
void check_columns(std::size_t in_row, const MfixHead& head, const ForeignLines& lines) {
  const std::size_t known = head.columns.size();
  if (in_row < known || (in_row > known && !head.more_may_follow))
    lines.fail(
        fmt::format("{} columns, but the variables with T have {}{}: {}; mend the row, or the T and F of "
                    "the variables",
                    in_row, head.more_may_follow ? "at least " : "", known, fmt::join(head.columns, " ")));
}

FileContents read_mfix(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  MfixHead head;
  bool in_data = false, in_variables = false;
  SphereColumns columns;
  while (!in_data) {
    lines.require_next("the first particle");
    const auto words = lines.words();
    if (words.empty()) continue;
    if ((words[0] == "Dimension:" || words[0] == "Particles:") && words.size() != 2)
      lines.fail(fmt::format("one number is expected behind {}", words[0]));
    if (words[0] == "Dimension:") {
      const std::uint64_t dimension = lines.whole(words[1], "Dimension");
      if (dimension != 2 && dimension != 3) lines.fail("Dimension must be 2 or 3");
      head.dimension = static_cast<int>(dimension);
    }
    if (words[0] == "Particles:") head.particles = lines.whole(words[1], "Particles");
    if (words.size() > 1 && (words[1] == "T" || words[1] == "F")) {
      take_variable(words, head, lines);
      in_variables = true;
    }
    in_data = in_variables && is_number(words[0]);
  }
  columns = sphere_columns({}, head.columns, lines);
  contents.spheres = columns.no_spheres();
  std::size_t in_row = 0;
  for (bool found = true; found; found = lines.next()) {
    const auto row = lines.words();
    if (row.empty()) continue;
    if (contents.size() == head.particles)
      lines.refuse_more("the file", head.particles, "behind \"Particles:\"", "particle");
    if (in_row == 0) check_columns(in_row = row.size(), head, lines);
    lines.expect_fields(row.size(), in_row);
    add_row(lines, columns, row, contents.spheres);
  }
  lines.expect_rows(head.particles, contents.size());
  if (head.diameter && contents.spheres.r.empty()) {
    if (!(*head.diameter > 0)) lines.fail("Diameter must be positive");
    contents.spheres.r.assign(contents.size(), 0.5 * *head.diameter);
  }
  contents.unit = Unit::m;  // SI is the only one
  return contents;
}

}  // namespace

Format mfix_format() {
  return {.name = "mfix",
          .writes = "MFiX-DEM particle_input.dat, version 2.0",
          .keys = {"material_density", "density", "types"},
          .file = "particle_input.dat",
          .least_dimension = 2,
          .unit = Unit::m,
          .sizes = "diameter",
          .write_text = write_mfix,
          .reads = "MFiX-DEM particle_input.dat, version 2.0",
          .unit_from = "m",
          .recognises =
              [](const FileBeginning& file) {
                return file.begins("Version 2.0") && file.has("\nParticles:") && file.has("\nCoordinates");
              },
          .read = read_mfix};
}

}  // namespace bernal

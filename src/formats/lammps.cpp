#include "formats/lammps.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/unit.hpp"

namespace bernal {
namespace {

/// A system of units: the units of lengths and masses, and its unit of density in kg/m³.
struct UnitStyle {
  std::string_view name;
  std::optional<Unit> length;  ///< absent: reduced, or ångström
  std::string_view mass = {};
  double density = 1;
};
constexpr UnitStyle unit_styles[] = {{"si", Unit::m, "kg", 1},
                                     {"cgs", Unit::cm, "g", 1e3},
                                     {"micro", Unit::um, "pg", 1e3},
                                     {"nano", Unit::nm, "ag", 1e6},
                                     {"lj", {}},
                                     {"real", {}},
                                     {"metal", {}},
                                     {"electron", {}}};

/// The style with this unit of lengths, else reduced units with the mass in kg.
UnitStyle style_of_unit(Unit length) {
  for (const UnitStyle& style : unit_styles)
    if (style.length == length) return style;
  const double metres = metres_per(length);
  return {"lj", length, "kg", length == Unit::mm ? 1e9 : 1 / (metres * metres * metres)};
}

/// Whether a tilt is longer than half the edge that it lies along. LAMMPS before 2022 refuses such a box
/// unless it is told to take it.
bool is_tilted_far(const Exported& file) {
  const Vector<3> edges = file.box().size();
  const auto [xy, xz, yz] = file.tilt();
  return std::max(std::abs(xy), std::abs(xz)) > 0.5 * edges[0] || std::abs(yz) > 0.5 * edges[1];
}

void write_lammps(const Exported& file, TextFile& out) {
  const UnitStyle units = style_of_unit(file.unit());
  out.add("# ", file.title(), "; lengths in ", name_of(file.unit()), ", masses in ", units.mass,
          "; of density ", file.densities_in_words(), " kg/m3\n");
  out.add("# for: units ", units.name, "; dimension ", file.dimension(), "; boundary ", lammps_boundary(file),
          "; atom_style sphere; neighbor ", 0.5 * file.largest_radius(), " bin; ",
          is_tilted_far(file) ? "box tilt large; " : "", "read_data ", file.name(), "\n");
  write_atoms(out, file, units.density, "Atoms # sphere");
}

/// The columns of an atom style; three more may follow, the image flags.
struct AtomStyle {
  std::vector<std::string_view> names;
  std::vector<std::string> columns;
};
const std::vector<AtomStyle>& atom_styles() {
  static const std::vector<AtomStyle> styles = {
      {{"sphere", "granular"}, {"id", "type", "diameter", "density", "x", "y", "z"}},
      {{"bpm/sphere"}, {"id", "mol", "type", "diameter", "density", "x", "y", "z"}},
      {{"atomic"}, {"id", "type", "x", "y", "z"}},
      {{"charge"}, {"id", "type", "q", "x", "y", "z"}},
      {{"bond", "angle", "molecular"}, {"id", "mol", "type", "x", "y", "z"}},
      {{"full"}, {"id", "mol", "type", "q", "x", "y", "z"}}};
  return styles;
}
constexpr std::size_t image_columns = 3;

/// The style in the heading "Atoms # sphere", or, if absent, by the number of columns.
const AtomStyle& style_of_atoms(std::string_view said, std::size_t columns, const ForeignLines& lines) {
  const auto fits = [&](const AtomStyle& style) {
    return columns == style.columns.size() || columns == style.columns.size() + image_columns;
  };
  for (const AtomStyle& style : atom_styles()) {
    const bool named = std::ranges::find(style.names, said) != style.names.end();
    const bool meant = said.empty() && (style.names.front() == "sphere" || style.names.front() == "atomic");
    if ((named || meant) && fits(style)) return style;
    if (named)
      lines.fail(fmt::format("{} columns, but atoms of the style {} have {}: {}", columns, said,
                             style.columns.size(), fmt::join(style.columns, " ")));
  }
  lines.fail(
      said.empty()
          ? fmt::format("{} columns are those of no atom_style that is taken for granted; say which it "
                        "is, such as \"Atoms # sphere\"",
                        columns)
          : fmt::format("atoms of the style {} are no spheres that can be read; write those of atom_style "
                        "sphere, or a dump",
                        bernal::quoted(said)));
}

/// Whether the line is the heading of another section, "Velocities" or "Pair Coeffs": words without a number.
bool is_heading(std::span<const std::string_view> words) {
  return std::ranges::none_of(words, [](std::string_view word) {
    return word.find_first_of("0123456789") != word.npos || is_number(word);
  });
}

/// The part of the file before the atoms.
struct DataHead {
  std::uint64_t atoms = 0;
  bool has_atoms = false;
  FileBox box = FileBox::of_three(AxisEnd::unsaid);
  std::array<bool, 3> has_axis{};
  bool has_tilt = false;
  bool has_section = false;  ///< a section stands before the atoms, whose rows have words of any kind
  std::vector<std::string> not_units = {};  ///< clauses of remarks that sound like units but are not

  /// "10 atoms", "0 3 xlo xhi", "0.5 0 0 xy xz yz"; other lines are ignored.
  void take(std::span<const std::string_view> words, const Reading& reading, const ForeignLines& lines) {
    if (words.size() == 2 && words[1] == "atoms") {
      const std::uint64_t said = lines.whole(words[0], "atoms");
      if (has_atoms && said != atoms) lines.fail("a line before this one says another number of atoms");
      atoms = said;
      has_atoms = true;
    }
    for (const std::string_view other : {"ellipsoids", "lines", "triangles", "bodies"})
      if (words.size() == 2 && words[1] == other && lines.whole(words[0], other) > 0)
        lines.fail(fmt::format("some of the atoms are {}, and only spheres are known", other));
    for (std::size_t k = 0; k < 3 && words.size() == 4; ++k) {
      const char axis = "xyz"[k];
      if (words[2] != fmt::format("{}lo", axis) || words[3] != fmt::format("{}hi", axis)) continue;
      const double lower = lines.number(words[0], words[2]), upper = lines.number(words[1], words[3]);
      if (has_axis[k] && (lower != box.lower[k] || upper != box.upper[k]))
        lines.fail("a line before this one says other bounds of this axis");
      box.lower[k] = lower;
      box.upper[k] = upper;
      has_axis[k] = true;
    }
    const bool is_general = words.size() == 4 && words[3].ends_with("vec");
    if (is_general) refuse_skewed(reading, lines.number());
    const bool names_tilt = std::ranges::any_of(words, [](std::string_view word) {
      return std::ranges::find(tilt_names, word) != std::end(tilt_names);
    });
    if (words.size() == 6 && std::ranges::equal(words.subspan(3), tilt_names)) {
      Tilt tilt;
      for (std::size_t k = 0; k < 3; ++k) tilt[k] = lines.number(words[k], words[3 + k]);
      if (has_tilt && tilt != box.tilt) lines.fail("a line before this one says another tilt of the box");
      box.tilt = tilt;
      has_tilt = true;
    } else if (names_tilt && !has_section) {
      lines.fail("the tilts of a box are three numbers and the words xy xz yz, such as \"0.5 0 0 xy xz yz\"");
    }
    has_section |= is_heading(words);
  }
};

/// False for prose that begins with the word.
bool is_boundary(std::string_view clause) {
  std::vector<std::string_view> words;
  split_at(clause, " \t", words);
  return std::ranges::none_of(words | std::views::drop(1),
                              [](std::string_view word) { return word.size() > 2; });
}

/// "units lj", "radii in cm", "real units of cost".
bool sounds_like_unit(std::string_view clause) {
  std::vector<std::string_view> words;
  split_at(clause, " \t:=()", words);
  constexpr std::string_view known[] = {"unit",  "units",     "length",   "lengths",
                                        "radii", "diameters", "distances"};
  return std::ranges::any_of(
      words, [&](std::string_view word) { return std::ranges::find(known, word) != std::end(known); });
}

/// From a clause "boundary p p f" or "boundary pp pp ff".
void take_boundary(std::string_view clause, FileBox& box, const ForeignLines& lines) {
  std::vector<std::string_view> words;
  split_at(clause, " \t", words);
  std::vector<AxisEnd> ends;
  for (const std::string_view word : words | std::views::drop(1)) {
    const bool is_period = word == "p" || word == "pp";
    if (!is_period && word.find_first_not_of("fsm") != word.npos)
      lines.fail(fmt::format("{} is no end of an axis; write p, f, s or m", bernal::quoted(word)));
    ends.push_back(is_period ? AxisEnd::period : AxisEnd::wall);
  }
  if (ends.size() != 3) lines.fail("boundary needs the ends of three axes, such as \"boundary p p f\"");
  if (box.ends[0] != AxisEnd::unsaid && box.ends != ends)
    lines.fail("this line says other boundaries than one before it");
  box.ends = ends;
}

/// "# …; boundary p p f; …", "…, units = si", "…; lengths in mm": clauses in the first line or a remark.
void take_remark(const ForeignLines& lines, FileContents& contents, DataHead& head) {
  lines.take_unit_remark(contents.unit);
  constexpr std::string_view of_units = "units = ", of_ends = "boundary ";
  for (const std::string_view clause : clauses_of(lines.line())) {
    const std::string_view style = clause.substr(std::min(of_units.size(), clause.size()));
    if (clause.starts_with(of_units) && style.find(' ') == style.npos) {
      if (const std::optional<Unit> unit = unit_of_style(style, lines))
        take_unit(*unit, contents.unit, {lines.file(), lines.number()});
    } else if (clause == "dimension 2") {
      contents.is_flat = true;
    } else if (clause.starts_with(of_ends) && is_boundary(clause)) {
      take_boundary(clause, head.box, lines);
    } else if (!unit_in_clause(clause) && sounds_like_unit(clause)) {
      head.not_units.emplace_back(clause);
    }
  }
}

void read_atoms(std::string_view said, std::uint64_t claimed, const Reading& reading, ForeignLines& lines,
                FileContents& contents) {
  const AtomStyle* style = nullptr;
  SphereColumns columns;
  Identities identities;
  std::size_t in_row = 0;
  while (lines.next()) {
    if (lines.line().starts_with('#') && style) lines.is_commented_row(lines.words(), in_row);
    const auto row = lines.words_before('#');
    if (row.empty()) continue;
    if (!is_number(row.front())) {
      if (is_heading(row)) break;
      lines.fail(
          fmt::format("a row of Atoms begins with {}, which is no number; mend it, or take the row out",
                      bernal::quoted(row.front())));
    }
    if (!style) {
      style = &style_of_atoms(said, row.size(), lines);
      columns = sphere_columns({}, style->columns, lines);
      in_row = row.size();
    }
    lines.expect_fields(row.size(), in_row);
    identities.id.push_back(lines.whole(row[0], "id"));
    identities.line.push_back(lines.number());
    add_row(lines, columns, row, contents.spheres);
  }
  lines.expect_rows(claimed, contents.size());
  identities.sort(contents.spheres, reading);
  if (style)
    contents.note = fmt::format("atom_style {}{}", style->names.front(),
                                said.empty() ? fmt::format(", by its {} columns", in_row) : "");
}

/// Reads the other sections, which must not include atoms again.
void read_to_end(ForeignLines& lines) {
  do {
    const auto words = lines.words_before('#');
    if (!words.empty() && words[0] == "Atoms")
      lines.fail("a second section Atoms; leave one of them in the file");
  } while (lines.next());
}

FileContents read_lammps_data(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  DataHead head;
  lines.require_next("the first line, a remark,");
  take_remark(lines, contents, head);
  for (;;) {
    lines.require_next("the section Atoms");
    if (lines.line().starts_with('#')) take_remark(lines, contents, head);
    const std::size_t mark = lines.line().find('#');
    const auto words = lines.words_before('#');
    if (words.empty()) continue;
    if (words[0] != "Atoms") {
      head.take(words, reading, lines);
      continue;
    }
    if (!head.has_atoms) lines.fail("no line such as \"1000 atoms\" stands before the atoms");
    if (!std::ranges::all_of(head.has_axis, [](bool has) { return has; }))
      lines.fail("no three lines such as \"0 3 xlo xhi\" stand before the atoms");
    std::vector<std::string_view> style;
    if (mark != std::string_view::npos) split_at(lines.line().substr(mark + 1), " \t", style);
    contents.box = head.box;
    const std::string said(style.empty() ? std::string_view() : style.front());
    if (words.size() > 1)
      lines.fail(
          fmt::format("{} stands behind Atoms; write the style behind a mark, such as \"Atoms # sphere\"",
                      bernal::quoted(words[1])));
    read_atoms(said, head.atoms, reading, lines, contents);
    if (!head.not_units.empty())
      contents.note += fmt::format("; \"{}\" is not taken for a unit", fmt::join(head.not_units, "\", \""));
    read_to_end(lines);
    return contents;
  }
}

/// Whether there is a line "1000 atoms" near the beginning.
bool counts_atoms(const FileBeginning& file) {
  for (std::size_t at = file.bytes.find(" atoms"); at != file.bytes.npos;
       at = file.bytes.find(" atoms", at + 1)) {
    const std::size_t end = at + 6, from = file.bytes.find_last_of('\n', at) + 1;
    if (end < file.bytes.size() && file.bytes[end] != '\n' && file.bytes[end] != '\r' &&
        file.bytes[end] != ' ')
      continue;
    const std::string_view word = std::string_view(file.bytes).substr(from, at - from);
    if (word.find_first_not_of(" \t0123456789") == word.npos && word.find_first_of("0123456789") != word.npos)
      return true;
  }
  return false;
}

}  // namespace

std::optional<Unit> unit_of_style(std::string_view name, const CsvLines& lines) {
  for (const UnitStyle& style : unit_styles)
    if (style.name == name) return style.length;
  lines.fail(fmt::format("{} is no style of units of LAMMPS; mend the word, or take it out and give ‹unit›",
                         bernal::quoted(name)));
}

std::string lammps_boundary(const Exported& file) {
  const std::string ends = file.periods_as("p", "f");
  return file.dimension() == 2 ? ends.substr(0, 4) + "p" : ends;
}

void write_atoms(TextFile& out, const Exported& file, double unit_of_density, std::string_view heading) {
  const Bounds<3> box = file.box();
  out.add("\n", file.size(), " atoms\n", file.type_count, " atom types\n\n");
  constexpr std::string_view axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) out.add(box.lower[k], ' ', box.upper[k], ' ', axes[k], "lo ", axes[k], "hi\n");
  if (const Tilt tilt = file.tilt(); tilt != Tilt{})
    out.add(tilt[0], ' ', tilt[1], ' ', tilt[2], " xy xz yz\n");
  out.add("\n", heading, "\n\n");
  std::vector<std::string> densities;
  for (std::uint32_t type = 1; type <= file.type_count; ++type)
    densities.push_back(fmt::format(" {} ", file.density_of(type) / unit_of_density));
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(i + 1, ' ', file.types[i], ' ', 2 * file.spheres.r[i], densities[file.types[i] - 1],
            file.coordinate(0, i), ' ', file.coordinate(1, i), ' ', file.coordinate(2, i), '\n');
}

Format lammps_format() {
  return {.name = "lammps",
          .writes = "LAMMPS data file for read_data, atom_style sphere",
          .keys = {"unit", "material_density", "density", "types"},
          .file = "lammps.data",
          .least_dimension = 2,
          .unit = Unit::m,
          .sizes = "diameter",
          .tilted = true,
          .repeated_mesh = true,
          .write_text = write_lammps,
          .reads =
              "LAMMPS and LIGGGHTS data files, atom_style sphere or granular, or another with ‹diameter›; an "
              "upright or tilted box, periodic unless a remark says \"boundary p p f\"",
          .unit_from = "remarks \"units = si\", \"lengths in mm\", or ‹unit›",
          .recognises = counts_atoms,
          .read = read_lammps_data};
}

}  // namespace bernal

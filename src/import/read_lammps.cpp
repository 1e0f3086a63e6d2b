#include <algorithm>
#include <cctype>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "import/foreign_lines.hpp"
#include "import/lammps_words.hpp"

namespace bernal {
namespace {

/// The columns of a style of atoms; after them may stand three more, in which box the atom is.
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

/// Of the heading "Atoms # sphere", or, where it does not say, of the number of columns.
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

/// What stands before the atoms.
struct DataHead {
  std::uint64_t atoms = 0;
  bool has_atoms = false;
  FileBox box{std::vector<double>(3), std::vector<double>(3), std::vector<AxisEnd>(3, AxisEnd::unsaid)};
  std::array<bool, 3> has_axis{};

  /// "10 atoms", "0 3 xlo xhi"; others are of no matter.
  void take(std::span<const std::string_view> words, const Reading& reading, const ForeignLines& lines) {
    if (words.size() == 2 && words[1] == "atoms") {
      atoms = lines.whole(words[0], "atoms");
      has_atoms = true;
    }
    for (std::size_t k = 0; k < 3 && words.size() == 4; ++k) {
      const char axis = "xyz"[k];
      if (words[2] != fmt::format("{}lo", axis) || words[3] != fmt::format("{}hi", axis)) continue;
      box.lower[k] = lines.number(words[0], words[2]);
      box.upper[k] = lines.number(words[1], words[3]);
      has_axis[k] = true;
    }
    const bool is_general = words.size() == 4 && words[3].ends_with("vec");
    if (is_general) refuse_skewed(reading.file, lines.number());
    if (words.size() == 6 && words[3] == "xy")
      for (const std::string_view tilt : words.first(3))
        if (lines.number(tilt, "tilt") != 0) refuse_skewed(reading.file, lines.number());
  }
};

/// "# … boundary p p f; …", "… units = si", "…; lengths in mm": what a first line or a remark may tell.
void take_remark(std::string_view line, FileContents& contents, DataHead& head) {
  if (!contents.unit) contents.unit = unit_in_title(line);
  if (const std::size_t at = line.find("units = "); at != line.npos && !contents.unit) {
    const std::string_view style = line.substr(at + 8);
    contents.unit = unit_of_style(style.substr(0, style.find_first_of(" ,;")));
  }
  if (line.find("; dimension 2;") != line.npos) contents.is_flat = true;
  if (const std::size_t at = line.find("boundary "); at != line.npos && line.size() >= at + 14)
    for (std::size_t k = 0; k < 3; ++k)
      head.box.ends[k] = line[at + 9 + 2 * k] == 'p' ? AxisEnd::period : AxisEnd::wall;
}

void read_atoms(std::string_view said, std::uint64_t claimed, const Reading& reading, ForeignLines& lines,
                FileContents& contents) {
  const AtomStyle* style = nullptr;
  SphereColumns columns;
  Identities identities;
  std::size_t in_row = 0;
  while (lines.next()) {
    const auto row = lines.words_before('#');
    if (row.empty()) continue;
    if (!is_number(row.front())) break;  // another section
    if (!style) {
      style = &style_of_atoms(said, row.size(), lines);
      columns = sphere_columns({}, style->columns, lines);
      in_row = row.size();
    }
    if (row.size() != in_row)
      lines.fail(
          fmt::format("{} columns, but the first atom has {}; was the line cut off?", row.size(), in_row));
    identities.id.push_back(lines.whole(row[0], "id"));
    identities.line.push_back(lines.number());
    add_row(lines, columns, row, contents.spheres);
  }
  lines.expect_rows(claimed, contents.size());
  identities.sort(contents.spheres, reading);
  if (style) contents.note = fmt::format("atom_style {}", style->names.front());
}

FileContents read_lammps_data(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  DataHead head;
  lines.require_next("the first line, a remark,");
  take_remark(lines.line(), contents, head);
  for (;;) {
    lines.require_next("the section Atoms");
    if (lines.line().starts_with('#')) take_remark(lines.line(), contents, head);
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
    read_atoms(said, head.atoms, reading, lines, contents);
    return contents;
  }
}

/// A line "1000 atoms" near the beginning.
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

const PackingReader& lammps_reader() {
  static const PackingReader reader{
      .about =
          {"lammps",
           "LAMMPS and LIGGGHTS data files, atom_style sphere or granular, or another with --diameter; an "
           "upright box, periodic unless a remark says \"boundary p p f\"",
           "remarks \"units = si\", \"lengths in mm\", or --unit",
           {}},
      .recognises = counts_atoms,
      .read = read_lammps_data};
  return reader;
}

}  // namespace bernal

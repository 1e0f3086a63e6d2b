#include <fmt/format.h>

#include "files/csv_headings.hpp"
#include "formats/foreign_lines.hpp"
#include "formats/text_file.hpp"

namespace bernal {
namespace {

/// The first word that ymport.textExt expects, and the cell, which bernal writes in a remark.
constexpr std::string_view format_mark = "#format", plain_rows = "x_y_z_r", cell_mark = "O.cell.setBox(";

void write_yade(const Exported& file, TextFile& out) {
  out.add(format_mark, " ", plain_rows, "\n# ", file.title(), "; lengths in ", name_of(file.unit()), "\n");
  out.add("# from yade import ymport; O.bodies.append(ymport.textExt(\"", file.name(), "\"))\n");
  if (const auto* box = std::get_if<Box>(&file.domain); box && !box->has_walls())
    out.add("# O.periodic = True; ", cell_mark, box->size[0], ", ", box->size[1], ", ", box->size[2], ")\n");
  for (std::size_t i = 0; i < file.size(); ++i)
    out.add(file.coordinate(0, i), '\t', file.coordinate(1, i), '\t', file.coordinate(2, i), '\t',
            file.spheres.r[i], '\n');
}

/// The cell of "# O.periodic = True; O.cell.setBox(3, 4, 5)", as bernal writes it.
std::optional<FileBox> cell_in(const ForeignLines& lines) {
  const std::size_t at = lines.line().find(cell_mark);
  if (at == std::string_view::npos) return {};
  const std::string_view inside = lines.line().substr(at + cell_mark.size());
  std::vector<std::string_view> edges;
  split_at(inside.substr(0, inside.find(')')), ", ", edges);
  if (edges.size() != 3) lines.fail("O.cell.setBox needs three edges; write all three");
  FileBox box = FileBox::of_three(AxisEnd::period);
  for (std::size_t k = 0; k < 3; ++k) box.upper[k] = lines.number(edges[k], "edge");
  return box;
}

FileContents read_yade(const Reading& reading) {
  ForeignLines lines(reading);
  FileContents contents;
  std::vector<std::string> names = {"x", "y", "z", "r"};  // textExt's default
  std::optional<SphereColumns> columns;
  std::size_t in_row = 0, left_out = 0;
  std::vector<std::string_view> row;
  while (lines.next()) {
    const std::string_view line = stripped(lines.line(), " \t");
    if (line.empty()) continue;
    if (line.starts_with(format_mark)) {
      if (columns) lines.fail("a second #format stands among the rows; import one table at a time");
      std::vector<std::string_view> words;
      split_at(line.substr(format_mark.size()), "_ \t", words);
      names.assign(words.begin(), words.end());
    }
    if (line.starts_with('#')) {
      lines.take_unit_remark(contents.unit);
      if (auto box = cell_in(lines)) {
        if (contents.box && contents.box->upper != box->upper)
          lines.fail("a second cell, other than the first; leave one of them in the file");
        contents.box = std::move(box);
      }
      split_at(line, " \t,", row);
      if (columns && lines.is_commented_row(row, in_row)) ++left_out;
      continue;
    }
    if (!columns) {
      columns = sphere_columns({}, names, lines);
      contents.spheres = columns->no_spheres();
    }
    split_at(line, " \t,", row);
    if (in_row == 0) in_row = row.size();
    lines.expect_fields(row.size(), in_row);
    add_row(lines, *columns, row, contents.spheres);
  }
  if (contents.size() == 0) lines.refuse_empty();
  if (left_out > 0) contents.note = fmt::format("rows behind a mark are left out, {} of them", left_out);
  return contents;
}

}  // namespace

Format yade_format() {
  return {.name = "yade",
          .writes = "YADE, for ymport.textExt",
          .keys = {"unit"},
          .file = "yade.txt",
          .unit = Unit::m,
          .write_text = write_yade,
          .reads = "YADE, what export.textExt writes: #format x_y_z_r, or another with these",
          .unit_from = "‹unit›",
          .recognises = [](const FileBeginning& file) { return file.begins(format_mark); },
          .read = read_yade};
}

}  // namespace bernal

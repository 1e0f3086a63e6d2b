#include <fmt/format.h>

#include "files/csv_headings.hpp"
#include "formats/foreign_lines.hpp"

namespace bernal {
namespace {

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//") || line.starts_with('!');
}

/// The separator in a line of numbers. A semicolon takes precedence over a comma, which may be a decimal
/// point.
char separator_of(std::string_view line) {
  for (const char separator : {';', ',', '\t'})
    if (line.find(separator) != line.npos) return separator;
  return ' ';
}

/// The information before the first row.
struct TableHead {
  char separator = ' ';
  std::vector<std::string> names, units;
  bool is_row = false;  ///< the line at which reading stopped is a row

  void take(const Headings& headings) {
    separator = headings.separator;
    names.clear();
    units.clear();
    for (const Heading& heading : headings.columns) {
      names.push_back(heading.name);
      units.push_back(heading.unit);
    }
  }
};

/// The names in a line, without empty ones if it ends in a delimiter.
Headings named_columns(std::string_view line) {
  Headings headings = headings_in(line);
  while (headings.columns.size() > 1 && headings.columns.back().name.empty() &&
         headings.columns.back().unit.empty())
    headings.columns.pop_back();
  return headings;
}

/// Whether a remark names at least the first coordinate, so that it is a header.
bool names_coordinates(const Headings& headings) {
  for (const Heading& heading : headings.columns)
    if (heading.name == "x" || heading.name == "x0") return true;
  return false;
}

/// Throws if a field begins with a quotation mark but does not end with one.
void split_row(const ForeignLines& lines, char separator, std::vector<std::string_view>& fields) {
  const std::string_view line = stripped(lines.line(), " \t");
  if (separator == ' ') {
    split_at(line, " \t", fields);
  } else {
    split_fields(line, separator, fields);
  }
  for (const std::string_view field : fields)
    if (field.starts_with('"') && (field.size() < 2 || !field.ends_with('"')))
      lines.fail(
          fmt::format("{} opens a quotation mark that its column does not close; close it, or take it out",
                      bernal::quoted(field)));
}

/// Without empty fields at the end, since some programs end every line with delimiters.
std::size_t filled(std::span<const std::string_view> fields) {
  std::size_t count = fields.size();
  while (count > 0 && fields[count - 1].empty()) --count;
  return count;
}

TableHead read_head(ForeignLines& lines, std::string& unit) {
  TableHead head;
  std::optional<Headings> remarked;
  while (lines.next()) {
    const std::string_view line = stripped(lines.line(), " \t");
    if (line.empty() || lines.says_unit(unit)) continue;
    if (is_comment(line)) {
      lines.refuse_spreadsheet_errors();
      std::string_view remark = stripped(line, "#%!/ \t");
      if (const std::size_t label = remark.find(": "); label != remark.npos) remark.remove_prefix(label + 2);
      if (Headings headings = named_columns(remark); names_coordinates(headings))
        remarked = std::move(headings);
      continue;
    }
    head.separator = separator_of(line);
    std::vector<std::string_view> fields;
    split_row(lines, head.separator, fields);
    head.is_row = is_number(fields.front());
    if (!head.is_row) {
      head.take(named_columns(line));
    } else if (remarked && remarked->columns.size() == filled(fields)) {
      const char separator = head.separator;
      head.take(*remarked);
      head.separator = separator;
    }
    return head;
  }
  lines.refuse_empty();
}

std::string unit_of_heading(const TableHead& head, std::size_t place) {
  return head.units[place].empty() ? "no unit" : bernal::quoted(head.units[place]);
}

/// The unit of the columns that are read, if the header states one.
void take_units_of(const SphereColumns& columns, const TableHead& head, const CsvLines& lines,
                   std::string& unit) {
  if (head.units.empty()) return;
  std::vector<std::size_t> places = columns.x;
  if (columns.size) places.push_back(*columns.size);
  for (const std::size_t place : places)
    if (head.units[place] != head.units[places.front()])
      lines.fail(
          fmt::format("the header says {} of {} and {} of {}; say one unit for all of them, or none and give "
                      "‹unit›",
                      unit_of_heading(head, places.front()), head.names[places.front()],
                      unit_of_heading(head, place), head.names[place]));
  if (const std::string& said = head.units[places.front()]; !said.empty()) lines.take_unit(said, unit);
}

FileContents read_table(const Reading& reading) {
  ForeignLines lines(reading);
  std::string unit;
  const TableHead head = read_head(lines, unit);
  const SphereColumns columns = sphere_columns(reading.options.columns, head.names, lines);
  take_units_of(columns, head, lines, unit);
  FileContents contents{.spheres = columns.no_spheres()};
  std::vector<std::string_view> fields;
  std::size_t in_row = head.names.size(), least = in_row, left_out = 0;
  int first_left_out = 0;
  for (bool found = head.is_row || lines.next(); found; found = lines.next()) {
    const std::string_view line = stripped(lines.line(), " \t");
    if (line.empty() || (is_comment(line) && lines.says_unit(unit))) continue;
    split_row(lines, head.separator, fields);
    if (is_comment(line)) {
      lines.refuse_spreadsheet_errors();
      if (lines.is_commented_row(std::span(fields).first(filled(fields)), least) && ++left_out == 1)
        first_left_out = lines.number();
      continue;
    }
    if (in_row == 0) {
      in_row = fields.size();
      least = filled(fields);
    }
    if (fields.size() < least || filled(fields) > in_row)
      lines.fail(fmt::format("{} {}, but {} {}", fields.size(), fields.size() == 1 ? "field" : "fields",
                             head.names.empty() ? "the first row has" : "the header names", in_row));
    add_row(lines, columns, fields, contents.spheres);
  }
  if (contents.size() == 0) lines.refuse_empty();
  if (!unit.empty()) contents.unit = unit_named(unit);
  contents.note = columns.in_words();
  if (left_out > 0)
    contents.note +=
        fmt::format("; {} {} behind a mark {} left out, the first in line {}", left_out,
                    left_out == 1 ? "row" : "rows", left_out == 1 ? "is" : "are", first_left_out);
  return contents;
}

}  // namespace

Format table_format() {
  return {
      .name = "table",
      .reads =
          "a table of any program, spheres.csv among them: commas, semicolons, tabs or blanks between the "
          "columns, whose names its first line or ‹columns› gives",
      .unit_from = "# unit: mm, x [mm], or ‹unit›",
      .options = {"columns"},
      .recognises = [](const FileBeginning&) { return true; },
      .read = read_table};
}

}  // namespace bernal

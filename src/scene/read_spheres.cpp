#include "scene/read_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "bernal/core/error.hpp"
#include "files/csv_headings.hpp"
#include "files/csv_lines.hpp"
#include "files/npy_file.hpp"
#include "scene/read_npy_spheres.hpp"

namespace bernal {
namespace {

constexpr double smallest_size = 1e-30, farthest = 1e30;

/// Where on a line the coordinates and the size stand.
struct Columns {
  char separator = ',';
  std::size_t count = 0;
  std::vector<std::size_t> x;
  std::size_t size = 0;
  bool is_diameter = false;
  std::vector<std::string> names;  // as they stand in the header, by their place
  std::vector<std::string> units;  // "" where it says none

  /// Of the coordinates and the size.
  std::vector<std::size_t> places() const {
    std::vector<std::size_t> all = x;
    all.push_back(size);
    return all;
  }
};

/// The place of a column; throws where there are two of that name.
std::optional<std::size_t> place_of(const std::vector<std::string>& names, std::string_view name,
                                    const CsvLines& lines) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return {};
  if (std::find(found + 1, names.end(), name) != names.end())
    lines.fail(fmt::format("the header names the column {} twice", name));
  return static_cast<std::size_t>(found - names.begin());
}

/// Those of the line if it is a header: one that names coordinates and a size. Throws where it names too
/// many.
std::optional<Columns> columns_in(std::string_view header, const CsvLines& lines) {
  Columns columns;
  Headings headings = headings_in(header);
  columns.separator = headings.separator;
  columns.count = headings.columns.size();
  std::vector<std::string>& names = columns.names;
  for (Heading& heading : headings.columns) {
    names.push_back(std::move(heading.name));
    columns.units.push_back(std::move(heading.unit));
  }

  std::vector<std::size_t> letters, numbers;
  for (const std::string_view letter : {"x", "y", "z"}) {
    const auto at = place_of(names, letter, lines);
    if (!at) break;
    letters.push_back(*at);
  }
  while (const auto at = place_of(names, fmt::format("x{}", numbers.size()), lines)) numbers.push_back(*at);
  if (letters.empty() == numbers.empty()) {
    if (letters.empty()) return {};
    lines.fail("the header names the coordinates twice, as x and as x0; leave one of them out");
  }
  columns.x = letters.empty() ? numbers : letters;

  std::vector<std::string_view> sizes;
  for (const std::string_view name : {"r", "radius", "d", "diameter"})
    if (const auto at = place_of(names, name, lines)) {
      sizes.push_back(name);
      columns.size = *at;
      columns.is_diameter = name.starts_with('d');
    }
  if (sizes.empty()) return {};
  if (sizes.size() > 1)
    lines.fail(fmt::format("the header names the size of a sphere more than once, as {}; leave one of them",
                           fmt::join(sizes, " and ")));
  return columns;
}

/// The columns that a remark names, if it reads as a header; else it is one for people.
std::optional<Columns> columns_in_remark(std::string_view remark, const CsvLines& lines) {
  remark.remove_prefix(1);
  if (const std::size_t label = remark.find(':'); label != remark.npos) remark.remove_prefix(label + 1);
  try {
    return columns_in(remark, lines);
  } catch (const Error&) {
    return {};
  }
}

/// Of the columns that are read, if they say one.
void take_units(const Columns& columns, const CsvLines& lines, std::string& unit) {
  const std::vector<std::size_t> places = columns.places();
  const std::string& first = columns.units[places.front()];
  const auto said = [](std::string_view name) { return name.empty() ? "no unit" : bernal::quoted(name); };
  for (const std::size_t k : places)
    if (columns.units[k] != first)
      lines.fail(fmt::format("the header says that {} is in {} and {} in {}; say one unit for all of them",
                             columns.names[places.front()], said(first), columns.names[k],
                             said(columns.units[k])));
  if (!first.empty()) lines.take_unit(first, unit);
}

/// `is_sphere` says whether the line after which it stops is one.
Columns read_header(CsvLines& lines, std::string& unit, bool& is_sphere) {
  std::vector<Columns> remarked;
  bool found;
  for (found = lines.next(); found; found = lines.next()) {
    const std::string_view line = stripped(lines.line(), " \t");
    if (line.empty()) continue;
    if (!line.starts_with('#')) break;
    if (lines.says_unit(unit)) continue;
    if (auto columns = columns_in_remark(line, lines)) remarked.push_back(std::move(*columns));
  }
  std::optional<Columns> columns;
  if (found) columns = columns_in(lines.line(), lines);
  is_sphere = found && !columns;
  if (!columns) {
    std::vector<std::string_view> fields;
    for (Columns& candidate : remarked) {
      if (found) split_fields(lines.line(), candidate.separator, fields);
      if (!found || fields.size() == candidate.count) columns = std::move(candidate);
    }
  }
  if (columns) {
    take_units(*columns, lines, unit);
    return *columns;
  }
  const std::string wanted = "columns such as x,y,z and r, radius, d or diameter";
  if (!found) lines.fail("the header is missing, which names " + wanted);
  lines.fail(fmt::format("expected a header that names {}; found {}", wanted, quoted(lines.line())));
}

/// As `CsvLines::read_number`, in quotation marks or not, with a plus or not.
double number_in(std::string_view field, const std::string& column, const CsvLines& lines) {
  field = unquoted(field);
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  return lines.read_number(field, column);
}

}  // namespace

NamedColumns read_spheres(const std::filesystem::path& file,
                          const std::function<void(std::string_view bytes)>& see) {
  if (is_npy_file(file)) return {read_npy_spheres(file, {smallest_size, farthest}, see), {}, 1};
  CsvLines lines(file, {.last_line_may_lack_feed = true, .see = see});
  NamedColumns read;
  bool is_sphere = false;
  const Columns columns = read_header(lines, read.unit, is_sphere);
  const std::size_t dimension = columns.x.size();
  if (dimension > max_dimension)
    lines.fail(
        fmt::format("the header names {} coordinates; there are at most {}", dimension, max_dimension));
  read.spheres = Spheres<dynamic>(static_cast<int>(dimension));
  std::vector<std::string_view> fields;
  int empty_line = 0;
  for (bool found = is_sphere || lines.next(); found; found = lines.next()) {
    if (stripped(lines.line(), " \t").empty()) {
      empty_line = lines.number();
      continue;
    }
    if (read.spheres.empty())
      read.first_line = lines.number();
    else if (empty_line > read.first_line)
      lines.fail(fmt::format("line {} is empty, and spheres follow; leave it out", empty_line));
    split_fields(lines.line(), columns.separator, fields);
    if (fields.size() != columns.count)
      lines.fail(fmt::format("{} {}, but the header has {}", fields.size(),
                             fields.size() == 1 ? "field" : "fields", columns.count));
    for (std::size_t k = 0; k < dimension; ++k) {
      const double x = number_in(fields[columns.x[k]], columns.names[columns.x[k]], lines);
      if (std::abs(x) > farthest)
        lines.fail(fmt::format("{} = {} is beyond {}", columns.names[columns.x[k]], x, farthest));
      read.spheres.x[k].push_back(x);
    }
    const double size = number_in(fields[columns.size], columns.names[columns.size], lines);
    if (!(size >= smallest_size && size <= farthest))
      lines.fail(fmt::format("the {} {} is not a length from {} to {}",
                             columns.is_diameter ? "diameter" : "radius", size, smallest_size, farthest));
    read.spheres.r.push_back(columns.is_diameter ? 0.5 * size : size);
  }
  return read;
}

}  // namespace bernal

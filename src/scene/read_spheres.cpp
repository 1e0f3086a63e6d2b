#include "scene/read_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "core/csv_lines.hpp"

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
};

std::string_view trimmed(std::string_view text, std::string_view of) {
  const auto first = text.find_first_not_of(of);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(of) - first + 1);
}

/// Of a line; several blanks part two fields as one does.
void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    for (line = trimmed(line, " "); !line.empty();) {
      const std::size_t end = line.find(' ');
      fields.push_back(line.substr(0, end));
      line = end == line.npos ? std::string_view() : trimmed(line.substr(end), " ");
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end), " \t"));
    if (end == line.npos) return;
    line.remove_prefix(end + 1);
  }
}

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

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
std::optional<Columns> columns_in(std::string_view line, const CsvLines& lines) {
  Columns columns;
  for (const char separator : {',', ';', '\t', ' '})
    if (line.find(separator) != line.npos) {
      columns.separator = separator;
      break;
    }
  std::vector<std::string_view> fields;
  split(line, columns.separator, fields);
  std::vector<std::string> names;
  for (const std::string_view field : fields) names.push_back(in_lower_case(trimmed(field, " \"'")));
  columns.count = names.size();

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
  columns.names = std::move(names);
  return columns;
}

Columns read_header(CsvLines& lines, std::string& unit) {
  std::optional<Columns> columns;
  bool found = lines.next();
  for (bool first = true; found; first = false, found = lines.next()) {
    std::string_view line = lines.line();
    if (first && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    const bool is_remark = line.starts_with('#');
    if (const std::string name = lines.unit(); !name.empty())
      unit = name;
    else
      columns = columns_in(is_remark ? line.substr(1) : line, lines);
    if (columns || !is_remark) break;
  }
  if (columns) return *columns;
  const std::string wanted = "columns such as x,y,z and r, radius, d or diameter";
  if (!found) lines.fail("the header is missing, which names " + wanted);
  lines.fail(fmt::format("expected a header that names {}; found {}", wanted, quoted(lines.line())));
}

}  // namespace

NamedColumns read_spheres(const std::filesystem::path& file) {
  CsvLines lines(file);
  NamedColumns read;
  const Columns columns = read_header(lines, read.unit);
  const std::size_t dimension = columns.x.size();
  if (dimension > max_dimension)
    lines.fail(
        fmt::format("the header names {} coordinates; there are at most {}", dimension, max_dimension));
  read.spheres = Spheres<dynamic>(static_cast<int>(dimension));
  read.first_line = lines.number() + 1;
  std::vector<std::string_view> fields;
  while (lines.next()) {
    split(lines.line(), columns.separator, fields);
    if (fields.size() != columns.count)
      lines.fail(fmt::format("{} fields, but the header has {}", fields.size(), columns.count));
    for (std::size_t k = 0; k < dimension; ++k) {
      const double x = lines.read_number(fields[columns.x[k]], columns.names[columns.x[k]]);
      if (std::abs(x) > farthest)
        lines.fail(fmt::format("{} = {} is beyond {}", columns.names[columns.x[k]], x, farthest));
      read.spheres.x[k].push_back(x);
    }
    const double size = lines.read_number(fields[columns.size], columns.names[columns.size]);
    if (!(size >= smallest_size && size <= farthest))
      lines.fail(fmt::format("the {} {} is not a length from {} to {}",
                             columns.is_diameter ? "diameter" : "radius", size, smallest_size, farthest));
    read.spheres.r.push_back(columns.is_diameter ? 0.5 * size : size);
  }
  return read;
}

}  // namespace bernal

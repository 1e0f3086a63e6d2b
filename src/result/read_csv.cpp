#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/result/read_packing.hpp"
#include "files/csv_lines.hpp"
#include "result/write_csv.hpp"

namespace bernal {
namespace {

/// So many lines tell how long the others are.
constexpr std::size_t enough_to_judge = 10'000;

/// Which dimension has this header; it may end in the columns of classes.
int dimension_of_header(const CsvLines& lines, bool& has_classes) {
  for (int dimension = 1; dimension <= max_dimension; ++dimension) {
    const std::string header = csv_header(dimension);
    if (!lines.line().starts_with(header)) continue;
    const std::string_view rest = lines.line().substr(header.size());
    has_classes = rest == csv_class_columns;
    if (has_classes || rest.empty()) return dimension;
  }
  lines.fail(fmt::format("expected the header {} (or {} and so on), found {}", csv_header(3), csv_header(2),
                         quoted(lines.line())));
}

/// Takes class and material from the end of a line; the number of the class, which may be a new one.
std::uint32_t take_class(const CsvLines& lines, std::string_view& line, std::vector<std::string>& names) {
  const std::size_t material = line.rfind(',');
  const std::size_t name = material == 0 || material == std::string_view::npos
                               ? std::string_view::npos
                               : line.rfind(',', material - 1);
  if (name == std::string_view::npos) lines.fail("the line does not end in a class and a material");
  const std::string_view word = line.substr(name + 1, material - name - 1);
  line = line.substr(0, name);
  const auto k = static_cast<std::size_t>(std::ranges::find(names, word) - names.begin());
  if (k == names.size()) names.emplace_back(word);
  return static_cast<std::uint32_t>(k);
}

/// One line: the coordinates, then the radius. `columns` are their names.
void read_sphere(const CsvLines& lines, std::string_view rest, const std::vector<std::string>& columns,
                 Spheres<dynamic>& spheres) {
  if (rest.empty()) lines.fail("empty line; one sphere a line is expected");
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::size_t comma = rest.find(',');
    const bool last = k + 1 == columns.size();
    if ((comma == std::string_view::npos) != last) {
      const auto fields = static_cast<std::ptrdiff_t>(k) + 1 + std::count(rest.begin(), rest.end(), ',');
      lines.fail(fmt::format("{} field{}, expected {}: {}", fields, fields == 1 ? "" : "s", columns.size(),
                             fmt::join(columns, ",")));
    }
    const double value = lines.read_number(rest.substr(0, comma), columns[k]);
    if (last && !(value > 0)) lines.fail(fmt::format("the radius {} is not positive", value));
    (last ? spheres.r : spheres.x[k]).push_back(value);
    if (!last) rest.remove_prefix(comma + 1);
  }
}

}  // namespace

SpheresFile read_csv(const std::filesystem::path& file) {
  CsvLines lines(file);
  std::string unit;

  bool found = lines.next();
  while (found && lines.line().starts_with('#')) {
    lines.says_unit(unit);
    found = lines.next();
  }
  if (!found) lines.fail(fmt::format("the header {} is missing", csv_header(3)));
  bool has_classes = false;
  SpheresFile result{Spheres<dynamic>(dimension_of_header(lines, has_classes)), std::move(unit), {}, {}};
  const std::vector<std::string> columns = csv_columns(result.spheres.dimension());
  std::size_t bytes = 0;
  while (lines.next()) {
    std::string_view line = lines.line();
    if (has_classes) result.classes.push_back(take_class(lines, line, result.class_names));
    read_sphere(lines, line, columns, result.spheres);
    bytes += lines.line().size() + 1;
    if (result.spheres.size() == enough_to_judge) {  // or columns that grow hold twice what they need
      const double share = static_cast<double>(std::filesystem::file_size(file)) / static_cast<double>(bytes);
      result.spheres.reserve(static_cast<std::size_t>(1.01 * share * static_cast<double>(enough_to_judge)));
    }
  }
  return result;
}

}  // namespace bernal

#pragma once
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "files/csv_lines.hpp"
#include "formats/format.hpp"

namespace bernal {

/// The lines of another program's file; the last may lack a line feed. Reports progress, and throws Cancelled
/// once the monitor says stop.
class ForeignLines : public CsvLines {
 public:
  explicit ForeignLines(const Reading& reading);

  using CsvLines::number;  // the number of the line
  bool next();
  /// Like `next`, but throws at the end of the file; `what` is the expected content: "the box".
  void require_next(std::string_view what);
  /// The line's words, separated by blanks and tabs.
  std::span<const std::string_view> words();
  /// The words before a mark such as '#'.
  std::span<const std::string_view> words_before(char mark);

  /// A number, possibly in quotation marks or with a plus sign. Throws as `read_number`, and for an unpaired
  /// quotation mark.
  double number(std::string_view field, std::string_view column) const;
  /// Throws for anything but a whole number.
  std::uint64_t whole(std::string_view field, std::string_view column) const;
  /// Whether the line, a remark with these fields, is a commented-out row of `in_row` numbers. Throws for a
  /// row in which a program gave up: "#N/A 2 3 0.5".
  bool is_commented_row(std::span<const std::string_view> fields, std::size_t in_row) const;
  /// Throws if the line begins with a spreadsheet's mark for a missing number or a narrow column: "#N/A",
  /// "####".
  void refuse_spreadsheet_errors() const;
  /// `take_unit_of_remark` for the line.
  void take_unit_remark(std::optional<Unit>& unit) const;
  /// Throws if the file ends after `found` of the `said` rows.
  void expect_rows(std::uint64_t said, std::uint64_t found) const;
  /// Throws if a row has another number of fields than the first one.
  void expect_fields(std::size_t found, std::size_t in_first) const;
  /// Error for a row more than the file, or `what` of it, announces; `where` is the place of the number:
  /// "below X".
  [[noreturn]] void refuse_more(std::string_view what, std::uint64_t said, std::string_view where,
                                std::string_view one = "sphere") const;
  [[noreturn]] void refuse_empty() const { fail("there are no spheres in it"); }

 private:
  const Monitor& monitor_;
  double bytes_ = 0, size_ = 0;
  std::vector<std::string_view> words_;
};

/// Splits a text at any of these characters; consecutive ones count as one separator.
void split_at(std::string_view text, std::string_view between, std::vector<std::string_view>& parts);
/// Whether the field begins with a number.
bool is_number(std::string_view field);
/// Absent unless the text is a whole number and nothing else.
std::optional<std::uint64_t> whole_number(std::string_view text);

/// The columns of the centre and the size.
struct SphereColumns {
  std::vector<std::size_t> x = {};  ///< indices, from 0
  std::optional<std::size_t> size = {};
  bool is_diameter = false;
  std::vector<std::string> names = {};  ///< of the coordinates, then the size, as in the file

  std::size_t least_fields() const;
  /// Of the dimension given by the number of coordinates.
  Spheres<dynamic> no_spheres() const { return Spheres<dynamic>(static_cast<int>(x.size())); }
  /// "x column 3, y column 4, diameter column 6 (d_p)".
  std::string in_words() const;
};

/// x, y, z and the radius, the first four of a row.
inline SphereColumns columns_xyzr() {
  return {.x = {0, 1, 2}, .size = 3, .names = {"x", "y", "z", "radius"}};
}

/// The columns that the user names, else those found by the header's names. Throws, with the remedy, if they
/// are ambiguous or missing.
SphereColumns sphere_columns(const std::string& wish, const std::vector<std::string>& names,
                             const CsvLines& lines);

/// Appends the sphere with the numbers value(place, name). Calls fail(why) for invalid ones.
template <class Value, class Fail>
void add_sphere(const SphereColumns& columns, Spheres<dynamic>& spheres, const Value& value,
                const Fail& fail) {
  for (std::size_t k = 0; k < columns.x.size(); ++k) {
    const double x = value(columns.x[k], columns.names[k]);
    if (!(std::abs(x) <= farthest_place))
      fail(fmt::format("{} = {} is not finite or is beyond {}", columns.names[k], x, farthest_place));
    spheres.x[k].push_back(x);
  }
  if (!columns.size) return;
  const double size = value(*columns.size, columns.names.back());
  if (!is_size(size)) fail(size_error(size, columns.is_diameter));
  spheres.r.push_back(columns.is_diameter ? 0.5 * size : size);
}

/// Appends the sphere of a row. Throws for invalid numbers. Precondition: a column for each of the
/// coordinates.
void add_row(const ForeignLines& lines, const SphereColumns& columns, std::span<const std::string_view> row,
             Spheres<dynamic>& spheres);

/// Columns of numbers, each in an array with `components` numbers a row, which must outlive the table.
struct NumberTable {
  struct Column {
    const std::vector<double>& values;
    std::uint64_t components, component;
    double at(std::uint64_t row) const { return values[row * components + component]; }
  };
  std::vector<Column> columns = {};
  std::vector<std::string> names = {};

  /// Several components are named "name:0", "name:1", …
  void add(const std::vector<double>& values, std::uint64_t components, const std::string& name);
  /// The spheres of this many rows; with `row` = "point" and `first` = 0, errors name the first one "point
  /// 0".
  Spheres<dynamic> spheres(const SphereColumns&, std::uint64_t rows, std::string_view row,
                           std::uint64_t first, const Reading&) const;
};

/// The axis for a column's name: "x", "x0" and "Points:0" are the first.
std::optional<std::size_t> axis_named(std::string_view name);

/// The numbers of spheres, with their lines or positions in the file.
struct Identities {
  std::string_view what = "line";
  std::vector<std::uint64_t> id;
  std::vector<int> line;
  /// Sorts the spheres by their numbers. Throws if two have the same number.
  void sort(Spheres<dynamic>& spheres, const Reading& reading) const;
};

}  // namespace bernal

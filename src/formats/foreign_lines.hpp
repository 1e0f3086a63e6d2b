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

/// The lines of a file of another program; its last may lack a line feed. Reports how far it has come, and
/// throws Cancelled once the monitor says stop.
class ForeignLines : public CsvLines {
 public:
  explicit ForeignLines(const Reading& reading);

  using CsvLines::number;  // of the line
  bool next();
  /// As `next`, but throws where the file ends; `what` should stand there: "the box".
  void require_next(std::string_view what);
  /// Of the line, between blanks and tabs.
  std::span<const std::string_view> words();
  /// The same of what stands before a mark, such as '#'.
  std::span<const std::string_view> words_before(char mark);

  /// In quotation marks or not, with a plus or not. Throws as `read_number`, and for a quotation mark at one
  /// end alone.
  double number(std::string_view field, std::string_view column) const;
  /// Throws where it is no whole number.
  std::uint64_t whole(std::string_view field, std::string_view column) const;
  /// Whether the line, a remark whose parts these are, is a row of so many numbers behind a mark. Throws
  /// where it is a row that a program gave up: "#N/A 2 3 0.5".
  bool is_row_left_out(std::span<const std::string_view> fields, std::size_t in_row) const;
  /// Throws where the line begins with what a spreadsheet writes for a number that it has not, or no room
  /// for: "#N/A",
  /// "####".
  void refuse_what_a_spreadsheet_gave_up() const;
  /// `take_unit_of_remark` of the line.
  void take_unit_remark(std::optional<Unit>& unit) const;
  /// Throws where the file ends after `found` of the rows that it says it has.
  void expect_rows(std::uint64_t said, std::uint64_t found) const;
  /// Throws where a row has not as many fields as the first one.
  void expect_fields(std::size_t found, std::size_t in_first) const;
  /// Of a row more than the file, or `what` of it, says it has, in a number that stands there: "below X".
  [[noreturn]] void refuse_more(std::string_view what, std::uint64_t said, std::string_view where,
                                std::string_view one = "sphere") const;
  [[noreturn]] void refuse_empty() const { fail("there are no spheres in it"); }

 private:
  const Monitor& monitor_;
  double bytes_ = 0, size_ = 0;
  std::vector<std::string_view> words_;
};

/// The parts of a text between any of these characters, several of which part as one does.
void split_at(std::string_view text, std::string_view between, std::vector<std::string_view>& parts);
/// Whether a number stands at its beginning.
bool is_number(std::string_view field);
/// Of a text that is a whole number and nothing else.
std::optional<std::uint64_t> whole_number(std::string_view text);

/// Where in a row the centre and the size stand.
struct SphereColumns {
  std::vector<std::size_t> x = {};  ///< places, from 0
  std::optional<std::size_t> size = {};
  bool is_diameter = false;
  std::vector<std::string> names = {};  ///< of the coordinates, then the size, as the file calls them

  std::size_t least_fields() const;
  /// Of as many dimensions as there are coordinates.
  Spheres<dynamic> no_spheres() const { return Spheres<dynamic>(static_cast<int>(x.size())); }
  /// "x column 3, y column 4, diameter column 6 (d_p)".
  std::string in_words() const;
};

/// x, y, z and the radius, the first four of a row.
inline SphereColumns columns_xyzr() {
  return {.x = {0, 1, 2}, .size = 3, .names = {"x", "y", "z", "radius"}};
}

/// Those of the user's words where there are some, else by the names that columns have; without names there
/// is nothing else to go by. Throws with the remedy where that says too little or too much.
SphereColumns sphere_columns(const std::string& wish, const std::vector<std::string>& names,
                             const CsvLines& lines);

/// Appends the sphere whose numbers are value(place, name). Calls fail(why) for what is none.
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
  if (!is_size(size)) fail(complaint_of_size(size, columns.is_diameter));
  spheres.r.push_back(columns.is_diameter ? 0.5 * size : size);
}

/// Appends the sphere of a row. Throws for what is none. Precondition: a column for each of the coordinates.
void add_row(const ForeignLines& lines, const SphereColumns& columns, std::span<const std::string_view> row,
             Spheres<dynamic>& spheres);

/// Columns of numbers, each `components` apart in an array that outlives them, from its number `component`
/// on.
struct NumberTable {
  struct Column {
    const std::vector<double>& values;
    std::uint64_t components, component;
    double at(std::uint64_t row) const { return values[row * components + component]; }
  };
  std::vector<Column> columns = {};
  std::vector<std::string> names = {};

  /// Several components are called "name:0", "name:1", …
  void add(const std::vector<double>& values, std::uint64_t components, const std::string& name);
  /// The spheres of so many rows; errors call the first "point 0" where `row` is "point" and `first` is 0.
  Spheres<dynamic> spheres(const SphereColumns&, std::uint64_t rows, std::string_view row,
                           std::uint64_t first, const Reading&) const;
};

/// The axis that a column's name means: "x", "x0" and "Points:0" the first.
std::optional<std::size_t> axis_named(std::string_view name);

/// The numbers of spheres, with the lines where they stand, or which points of a file they are.
struct Identities {
  std::string_view what = "line";
  std::vector<std::uint64_t> id;
  std::vector<int> line;
  /// Puts the spheres into the order of their numbers. Throws where two have one.
  void sort(Spheres<dynamic>& spheres, const Reading& reading) const;
};

}  // namespace bernal

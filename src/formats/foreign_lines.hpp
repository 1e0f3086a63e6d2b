#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bernal/core/monitor.hpp"
#include "bernal/core/spheres.hpp"
#include "core/csv_lines.hpp"
#include "formats/reader.hpp"

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
  /// Throws where it is not so many.
  void expect_rows(std::uint64_t said, std::uint64_t found) const;

 private:
  const Monitor& monitor_;
  double bytes_ = 0, size_ = 0;
  std::vector<std::string_view> words_;
};

/// The parts of a text between any of these characters, several of which part as one does.
void split_at(std::string_view text, std::string_view between, std::vector<std::string_view>& parts);
/// Whether a number stands at its beginning.
bool is_number(std::string_view field);

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

/// Those of the user's words where there are some, else by the names that columns have; without names there
/// is nothing else to go by. Throws with the remedy where that says too little or too much.
SphereColumns sphere_columns(const std::string& wish, const std::vector<std::string>& names,
                             const CsvLines& lines);

/// Appends the sphere of a row. Throws for what is none. Precondition: a column for each of the coordinates.
void add_row(const ForeignLines& lines, const SphereColumns& columns, std::span<const std::string_view> row,
             Spheres<dynamic>& spheres);
/// Throws Error{bad_packing} for a coordinate or a size that no sphere has.
void check_coordinate(const CsvLines& lines, double x, std::string_view column);

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

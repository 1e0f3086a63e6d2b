#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace bernal {

/// What the header of a table calls a column.
struct Heading {
  std::string name;  ///< in lower case, without quotation marks and unit
  std::string unit;  ///< "mm" of "x [mm]" or "x (mm)", "" where it says none
};

struct Headings {
  char separator = ',';
  std::vector<Heading> columns;
};

/// Commas, semicolons, tabs or blanks part the columns: the first of these that the line has.
Headings headings_in(std::string_view line);

/// The fields of a line, without blanks at their ends; of blanks several part two fields as one does.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// Text without these characters at its ends.
std::string_view stripped(std::string_view text, std::string_view of);

/// "um" for "µm", with the micro sign or the Greek letter in UTF-8; any other text as it is.
std::string_view unit_in_letters(std::string_view unit);

/// What stands in quotation marks, without them.
inline std::string_view unquoted(std::string_view field) { return stripped(field, " \"'"); }

}  // namespace bernal

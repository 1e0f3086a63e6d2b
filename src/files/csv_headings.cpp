#include "files/csv_headings.hpp"

#include "core/lower_case.hpp"

namespace bernal {

std::string_view stripped(std::string_view text, std::string_view of) {
  const auto first = text.find_first_not_of(of);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(of) - first + 1);
}

std::string_view unit_in_letters(std::string_view unit) {
  return unit == "\xC2\xB5m" || unit == "\xCE\xBCm" ? "um" : unit;
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    for (line = stripped(line, " "); !line.empty();) {
      const std::size_t end = line.find(' ');
      fields.push_back(line.substr(0, end));
      line = end == line.npos ? std::string_view() : stripped(line.substr(end), " ");
    }
    return;
  }
  for (;;) {
    const std::size_t end = line.find(separator);
    fields.push_back(stripped(line.substr(0, end), " \t"));
    if (end == line.npos) return;
    line.remove_prefix(end + 1);
  }
}

namespace {

/// "x [mm]" without its unit, which is told.
std::string_view without_unit(std::string_view name, std::string& unit) {
  for (const std::string_view marks : {"[]", "()"}) {
    const std::size_t begin = name.find(marks[0]);
    if (begin == name.npos || !name.ends_with(marks[1])) continue;
    unit = unit_in_letters(stripped(name.substr(begin + 1, name.size() - begin - 2), " "));
    return stripped(name.substr(0, begin), " ");
  }
  return name;
}

/// A header in which no blank stands before the units, so that blanks may part the columns.
std::string with_units_close(std::string_view line) {
  std::string close;
  for (const char c : line) {
    while ((c == '[' || c == '(') && close.ends_with(' ')) close.pop_back();
    close += c;
  }
  return close;
}

}  // namespace

Headings headings_in(std::string_view text) {
  Headings headings;
  const std::string line = with_units_close(text);
  for (const char separator : {',', ';', '\t', ' '})
    if (line.find(separator) != line.npos) {
      headings.separator = separator;
      break;
    }
  std::vector<std::string_view> fields;
  split_fields(line, headings.separator, fields);
  for (const std::string_view field : fields) {
    Heading& heading = headings.columns.emplace_back();
    heading.name = in_lower_case(without_unit(unquoted(field), heading.unit));
  }
  return headings;
}

}  // namespace bernal

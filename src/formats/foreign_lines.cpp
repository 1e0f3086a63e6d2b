#include "formats/foreign_lines.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>

#include "bernal/core/error.hpp"
#include "files/csv_headings.hpp"

namespace bernal {

ForeignLines::ForeignLines(const Reading& reading)
    : CsvLines(reading.file, {.last_line_may_lack_feed = true}), monitor_(reading.monitor) {
  std::error_code unknown;
  size_ = static_cast<double>(std::filesystem::file_size(reading.file, unknown));
}

bool ForeignLines::next() {
  constexpr int lines_between_news = 1 << 14;
  if (number() % lines_between_news == 0) {
    if (monitor_.stop()) throw Cancelled();
    if (number() > 0) monitor_.report({"read", std::min(1.0, bytes_ / size_), {}});
  }
  const bool found = CsvLines::next();
  bytes_ += static_cast<double>(line().size() + 1);
  return found;
}

void ForeignLines::require_next(std::string_view what) {
  if (!next()) fail(fmt::format("the file ends where {} should stand; was it cut off?", what));
}

void split_at(std::string_view text, std::string_view between, std::vector<std::string_view>& parts) {
  parts.clear();
  for (std::size_t at = 0; (at = text.find_first_not_of(between, at)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(between, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end;
  }
}

std::span<const std::string_view> ForeignLines::words() {
  split_at(line(), " \t", words_);
  return words_;
}

std::span<const std::string_view> ForeignLines::words_before(char mark) {
  split_at(line().substr(0, line().find(mark)), " \t", words_);
  return words_;
}

double ForeignLines::number(std::string_view field, std::string_view column) const {
  field = stripped(field, " ");
  for (const char mark : {'"', '\''}) {
    if (!field.starts_with(mark) && !field.ends_with(mark)) continue;
    if (field.size() < 2 || !field.starts_with(mark) || !field.ends_with(mark))
      fail(fmt::format("{} = {} has a quotation mark at one end alone; close it, or take it out", column,
                       bernal::quoted(field)));
    field = stripped(field.substr(1, field.size() - 2), " ");
  }
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  return read_number(field, column);
}

bool ForeignLines::is_commented_row(std::span<const std::string_view> fields, std::size_t in_row) const {
  constexpr std::string_view marks = "#%!/";
  if (fields.empty() || in_row < 2) return false;
  const std::string_view first = stripped(fields[0], " \t");
  const std::string_view behind = first.substr(std::min(first.find_first_not_of(marks), first.size()));
  const auto rest = fields.subspan(1);
  const auto numbers = static_cast<std::size_t>(std::ranges::count_if(rest, is_number));
  const std::size_t all = rest.size() + (behind.empty() ? 0 : 1);
  if (all != in_row || numbers == 0) return false;
  if (numbers == rest.size() && (behind.empty() || is_number(stripped(behind, " \t")))) return true;
  if (behind.empty() || behind.starts_with(' ') || behind.starts_with('\t')) return false;
  fail(fmt::format(
      "this row begins with {}, which is no number; mend the row, or if it is a remark put a blank "
      "behind its mark",
      bernal::quoted(first)));
}

void ForeignLines::refuse_spreadsheet_errors() const {
  constexpr std::string_view errors[] = {"#N/A",  "#DIV/0!", "#NULL!",  "#NAME?", "#REF!",
                                         "#NUM!", "#VALUE!", "#SPILL!", "#CALC!"};
  std::vector<std::string_view> fields;
  split_at(line(), ";,\t \"", fields);
  if (fields.empty()) return;
  const auto is_too_narrow = [](std::string_view field) {
    return field.size() > 2 && field.find_first_not_of('#') == field.npos;
  };
  const bool is_row = std::ranges::any_of(std::span(fields).subspan(1), [&](std::string_view field) {
    return is_too_narrow(field) || is_number(field);
  });
  if (std::ranges::find(errors, fields[0]) != std::end(errors) || (is_too_narrow(fields[0]) && is_row))
    fail(fmt::format(
        "this row begins with {}, which a spreadsheet writes where it has no number to show; mend the row",
        bernal::quoted(fields[0])));
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, value);
  if (problem != std::errc{} || stop != end) return {};
  return value;
}

std::uint64_t ForeignLines::whole(std::string_view field, std::string_view column) const {
  const std::optional<std::uint64_t> value = whole_number(field);
  if (!value) fail(fmt::format("{} = {} is not a whole number", column, bernal::quoted(field)));
  return *value;
}

void ForeignLines::take_unit_remark(std::optional<Unit>& unit) const {
  take_unit_of_remark(line(), unit, {file(), number()});
}

void ForeignLines::expect_rows(std::uint64_t said, std::uint64_t found) const {
  if (said != found)
    fail(fmt::format("the file says that it has {} spheres, and here end {} of them; was it cut off?", said,
                     found));
}

void ForeignLines::expect_fields(std::size_t found, std::size_t in_first) const {
  if (found != in_first)
    fail(fmt::format("{} columns, but the first row has {}; was the line cut off?", found, in_first));
}

void ForeignLines::refuse_more(std::string_view what, std::uint64_t said, std::string_view where,
                               std::string_view one) const {
  fail(
      fmt::format("{0} says that it has {1} {3}s, and here is more; if it is a {3}, correct the number {2}, "
                  "else take the line out",
                  what, said, where, one));
}

bool is_number(std::string_view field) {
  field = unquoted(field);
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  return std::from_chars(field.data(), field.data() + field.size(), value).ec != std::errc::invalid_argument;
}

void add_row(const ForeignLines& lines, const SphereColumns& columns, std::span<const std::string_view> row,
             Spheres<dynamic>& spheres) {
  if (row.size() < columns.least_fields())
    lines.fail(fmt::format("{} {}, but a sphere needs {}; was the line cut off?", row.size(),
                           row.size() == 1 ? "field" : "fields", columns.least_fields()));
  add_sphere(
      columns, spheres,
      [&](std::size_t place, const std::string& name) { return lines.number(row[place], name); },
      [&](const std::string& why) { lines.fail(why); });
}

void NumberTable::add(const std::vector<double>& values, std::uint64_t components, const std::string& name) {
  for (std::uint64_t k = 0; k < components; ++k) {
    columns.push_back({values, components, k});
    names.push_back(components == 1 ? name : fmt::format("{}:{}", name, k));
  }
}

Spheres<dynamic> NumberTable::spheres(const SphereColumns& of, std::uint64_t rows, std::string_view row,
                                      std::uint64_t first, const Reading& reading) const {
  Spheres<dynamic> made = of.no_spheres();
  for (std::uint64_t i = 0; i < rows; ++i)
    add_sphere(
        of, made, [&](std::size_t place, const std::string&) { return columns[place].at(i); },
        [&](const std::string& why) { reading.fail(fmt::format("{} {}: {}", row, i + first, why)); });
  return made;
}

void Identities::sort(Spheres<dynamic>& spheres, const Reading& reading) const {
  std::vector<std::size_t> order(id.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::ranges::is_sorted(id)) {
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return id[i]; });
    const auto sorted = [&](std::vector<double>& column) {
      std::vector<double> made(column.size());
      for (std::size_t i = 0; i < made.size(); ++i) made[i] = column[order[i]];
      column = std::move(made);
    };
    std::ranges::for_each(spheres.x, sorted);
    if (!spheres.r.empty()) sorted(spheres.r);
  }
  for (std::size_t i = 1; i < order.size(); ++i)
    if (id[order[i]] == id[order[i - 1]])
      throw Error(ErrorCode::bad_packing,
                  fmt::format("the number {} has a sphere in {} {} already; leave one of them out",
                              id[order[i]], what, line[order[i - 1]]),
                  {reading.file.string(), what == "line" ? line[order[i]] : 0});
}

std::vector<std::string_view> clauses_of(std::string_view remark) {
  std::vector<std::string_view> clauses;
  constexpr std::string_view between = ";,\n", around = " \t\r#%!/.";
  for (std::size_t at = 0; (at = remark.find_first_not_of(between, at)) != remark.npos;) {
    const std::size_t end = std::min(remark.find_first_of(between, at), remark.size());
    if (const std::string_view clause = stripped(remark.substr(at, end - at), around); !clause.empty())
      clauses.push_back(clause);
    at = end;
  }
  return clauses;
}

std::optional<std::string_view> unit_in_clause(std::string_view clause) {
  for (const std::string_view mark : {"lengths in ", "unit: ", "units: "}) {
    if (!clause.starts_with(mark)) continue;
    const std::string_view rest = stripped(clause.substr(mark.size()), " \t");
    const bool is_text = rest.find_first_of(" \t") != rest.npos && !is_number(rest);
    if (!is_text) return rest;
  }
  return {};
}

void take_unit(Unit said, std::optional<Unit>& unit, const Location& where) {
  if (unit && *unit != said)
    throw Error(ErrorCode::bad_packing,
                fmt::format("this line says that the unit is {}, and it or one before it says {}",
                            name_of(said), name_of(*unit)),
                where);
  unit = said;
}

void take_unit(std::string_view word, std::string_view what, std::optional<Unit>& unit,
               const Location& where) {
  const std::string_view name = unit_in_letters(word);
  if (const std::string complaint = complaint_of_unit(name); !complaint.empty())
    throw Error(ErrorCode::bad_packing,
                fmt::format("{}; convert the file, or take {} out and give ‹unit›", complaint, what), where);
  take_unit(unit_named(name), unit, where);
}

void take_unit_of_remark(std::string_view remark, std::optional<Unit>& unit, const Location& where) {
  for (const std::string_view clause : clauses_of(remark))
    if (const auto word = unit_in_clause(clause)) take_unit(*word, "this remark", unit, where);
}

void refuse_skewed(const Reading& reading, int line) {
  reading.fail(
      "the box is triclinic with cell vectors other than (lx, 0, 0), (xy, ly, 0) and (xz, yz, lz); turn the "
      "packing so that they are these",
      line);
}

int frame_of(const Reading& reading, int frames) {
  const int wanted = reading.options.frame.value_or(frames);
  if (wanted < 1 || wanted > frames)
    throw Error(ErrorCode::bad_argument,
                fmt::format("there is no frame {}; the file has {}, and the first is 1", wanted, frames),
                {reading.file.string()});
  return wanted;
}

std::string size_error(double length, bool is_diameter) {
  return fmt::format("the {} {} is not a length from {} to {}", is_diameter ? "diameter" : "radius", length,
                     smallest_length, farthest_place);
}

}  // namespace bernal

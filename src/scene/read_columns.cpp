#include "scene/read_columns.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/quantity.hpp"
#include "bernal/core/text.hpp"
#include "core/lower_case.hpp"
#include "files/csv_headings.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "files/input_file.hpp"
#include "files/next_line.hpp"
#include "files/npy_file.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

constexpr std::size_t longest_of_numbers = 1000;

/// The number that the text begins with, which is taken off.
std::optional<double> take_number(std::string_view& text) {
  double value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value + 0.0;  // -0 is 0
}

/// So many numbers, and nothing else.
std::optional<std::vector<double>> numbers_in(std::string_view line, std::size_t count) {
  std::vector<double> numbers;
  for (;;) {
    const std::optional<double> number = take_number(line);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    const bool parted =
        !line.empty() && (trimmed(line.substr(0, 1)).empty() || line.front() == ',' || line.front() == ';');
    line = trimmed(line);
    if (numbers.size() == count || !parted) break;
    if (line.starts_with(',') || line.starts_with(';')) line = trimmed(line.substr(1));
  }
  return numbers.size() == count && line.empty() ? std::optional(numbers) : std::nullopt;
}

/// "0, 12" for "pan, 12"; empty where the line begins with something else.
std::string with_zero_for_pan(std::string_view line) {
  constexpr std::string_view pan = "pan";
  const bool begins = line.size() > pan.size() &&
                      in_lower_case(std::string(line.substr(0, pan.size()))) == pan &&
                      std::isalnum(static_cast<unsigned char>(line[pan.size()])) == 0;
  return begins ? "0" + std::string(line.substr(pan.size())) : std::string();
}

bool is_length_column(const schema::Key& key) {
  return key.type == schema::Type::coordinates || key.type == schema::Type::lengths;
}

bool begins_with_a_number(std::string_view line) { return bool(take_number(line)); }

/// "sizes and passing, two numbers with decimal points such as 0.5, 12".
std::string expected_line(const WantedColumns& wanted) {
  if (wanted.keys.size() == 1)
    return fmt::format("one of the {}, a number with a decimal point such as 0.5", wanted.keys[0]->name);
  return fmt::format("{} and {}, two numbers with decimal points such as 0.5, 12", wanted.keys[0]->name,
                     wanted.keys[1]->name);
}

void require_readable(const std::filesystem::path& file) {
  const FileKind kind = kind_of_file(file);
  if (kind == FileKind::regular) return;
  const std::string name = toml_string(file.string());
  throw Error(ErrorCode::bad_scene, kind == FileKind::missing ? fmt::format("there is no file {}", name)
                                    : kind == FileKind::folder
                                        ? fmt::format("{} is a folder", name)
                                        : fmt::format("{} is a pipe or a device", name));
}

/// An array of NumPy's.
std::vector<double> read_npy_column(const std::filesystem::path& file, const WantedColumns& wanted) {
  const schema::Key& key = *wanted.keys.front();
  std::vector<double> column;
  try {
    NpyFile array(file, {}, NpyFile::Takes::any_numbers);
    if (array.columns() != 1)
      array.fail(fmt::format("has {} columns; save the one with the {} alone", array.columns(), key.name));
    if (array.rows() > wanted.most)
      array.fail(fmt::format("has more than {} numbers; {}", wanted.most, wanted.if_more));
    column.resize(array.rows());
    array.read([&](std::size_t, std::size_t first, std::span<const double> values) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::vector<double> one = {values[i] + 0.0};  // -0 is 0
        if (!schema::accepts(key, one))
          array.fail_at(first + i, fmt::format("\"{}\" must be {}, not {}", key.name,
                                               schema::expectation(key, one), one[0]));
        column[first + i] = one[0];
      }
    });
    if (column.empty()) array.fail("has no numbers");
  } catch (const Error& error) {  // which names the file and the row
    throw Error(ErrorCode::bad_scene, error.what());
  }
  return column;
}

}  // namespace

std::vector<std::vector<double>> read_columns(const std::filesystem::path& file, WantedColumns& wanted) {
  auto& keys = wanted.keys;
  require_readable(file);
  const std::size_t count = keys.size();
  if (count == 1 && is_npy_file(file)) return {read_npy_column(file, wanted)};
  InputFile in(file);
  if (!in) throw Error(ErrorCode::bad_scene, fmt::format("{} cannot be read", toml_string(file.string())));

  std::vector<std::vector<double>> columns(count);
  bool headed = false, swapped = false;
  std::string text, unit;
  double factor = 1;
  for (int number = 1;; ++number) {
    const NextLine next = next_line(in, text);
    if (next == NextLine::none) break;
    const auto fail = [&](const std::string& why) {
      throw Error(ErrorCode::bad_scene, why, {file.string(), number});
    };
    if (next == NextLine::too_long || text.size() > longest_of_numbers)
      fail(fmt::format("this line is too long for {}; is it another file?",
                       count == 1 ? "a number" : "two numbers"));
    std::string_view line = text;
    const auto take_unit = [&](std::string_view name) {
      if (const std::string complaint = complaint_of_unit(name); !complaint.empty()) fail(complaint);
      if (!unit.empty() && unit != name)
        fail(fmt::format("this line says that the unit is {}, and one before it says {}", name, unit));
      if (!columns[0].empty()) fail("the unit is said too late: numbers stand before it");
      unit = name;
      factor = conversion_factor(unit_named(name), wanted.unit);
    };
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    if (const auto name = unit_in_remark(line)) take_unit(*name);
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const std::string with_pan = keys[0]->range.min == 0 ? with_zero_for_pan(line) : std::string();
    if (!with_pan.empty()) line = with_pan;
    if (const auto numbers = numbers_in(line, count)) {
      for (std::size_t k = 0; k < count; ++k) {
        const double value = (*numbers)[swapped ? 1 - k : k];
        const std::vector<double> one = {is_length_column(*keys[k]) ? factor * value : value};
        if (!schema::accepts(*keys[k], one))
          fail(fmt::format("\"{}\" must be {}, not {}", keys[k]->name, schema::expectation(*keys[k], one),
                           one[0]));
        columns[k].push_back(one[0]);
      }
      if (columns[0].size() > wanted.most)
        fail(fmt::format("more than {} {}; {}", wanted.most, count == 1 ? "numbers" : "points",
                         wanted.if_more));
    } else if (!headed && columns[0].empty() && !begins_with_a_number(line)) {
      headed = true;
      const Headings headings = headings_in(line);
      if (headings.columns.size() != count) continue;
      if (wanted.other &&
          std::ranges::find(headings.columns, wanted.other->name, &Heading::name) != headings.columns.end())
        keys[1] = wanted.other;
      swapped = count == 2 && headings.columns[0].name == keys[1]->name &&
                (headings.columns[1].name == keys[0]->name || keys[1] == wanted.other);
      for (std::size_t k = 0; k < count; ++k)
        if (const std::string& said = headings.columns[swapped ? 1 - k : k].unit;
            is_length_column(*keys[k]) && !said.empty())
          take_unit(said);
    } else {
      const auto with_point = count == 1 ? without_decimal_comma(line) : std::nullopt;
      fail(fmt::format("expected {}; not {}{}", expected_line(wanted), toml_string(line.substr(0, 40)),
                       with_point ? ": write " + *with_point + " in place of the decimal comma" : ""));
    }
  }
  if (columns[0].empty())
    throw Error(ErrorCode::bad_scene,
                count == 1 ? fmt::format("no line has a number, one of the {}", keys[0]->name)
                           : fmt::format("no line has two numbers, {} and {}", keys[0]->name, keys[1]->name),
                {file.string()});
  return columns;
}

}  // namespace bernal

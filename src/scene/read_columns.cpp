#include "scene/read_columns.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "files/csv_headings.hpp"
#include "files/csv_lines.hpp"
#include "files/file_kind.hpp"
#include "files/input_file.hpp"
#include "files/next_line.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

constexpr std::size_t longest_pair = 1000;

/// The number that the text begins with, which is taken off.
std::optional<double> take_number(std::string_view& text) {
  double value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value + 0.0;  // -0 is 0
}

std::optional<std::array<double, 2>> pair_in(std::string_view line) {
  const std::optional<double> first = take_number(line);
  if (!first || line.empty()) return std::nullopt;
  if (trimmed(line.substr(0, 1)).size() == 1 && line.front() != ',' && line.front() != ';')
    return std::nullopt;
  line = trimmed(line);
  if (line.starts_with(',') || line.starts_with(';')) line = trimmed(line.substr(1));
  const std::optional<double> second = take_number(line);
  if (!second || !line.empty()) return std::nullopt;
  return std::array{*first, *second};
}

bool is_length_column(const schema::Key& key) {
  return key.type == schema::Type::coordinates || key.type == schema::Type::lengths;
}

bool begins_with_a_number(std::string_view line) { return bool(take_number(line)); }

}  // namespace

std::array<std::vector<double>, 2> read_columns(const std::filesystem::path& file, const TwoColumns& wanted) {
  const auto& keys = wanted.keys;
  if (const FileKind kind = kind_of_file(file); kind != FileKind::regular) {
    const std::string name = toml_string(file.string());
    throw Error(ErrorCode::bad_scene, kind == FileKind::missing ? fmt::format("there is no file {}", name)
                                      : kind == FileKind::folder
                                          ? fmt::format("{} is a folder", name)
                                          : fmt::format("{} is a pipe or a device", name));
  }
  InputFile in(file);
  if (!in) throw Error(ErrorCode::bad_scene, fmt::format("{} cannot be read", toml_string(file.string())));

  std::array<std::vector<double>, 2> columns;
  bool headed = false, swapped = false;
  std::string text, unit;
  double factor = 1;
  for (int number = 1;; ++number) {
    const NextLine next = next_line(in, text);
    if (next == NextLine::none) break;
    const auto fail = [&](const std::string& why) {
      throw Error(ErrorCode::bad_scene, why, {file.string(), number});
    };
    if (next == NextLine::too_long || text.size() > longest_pair)
      fail("this line is too long for two numbers; is it another file?");
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
    if (const auto pair = pair_in(line)) {
      for (std::size_t k = 0; k < 2; ++k) {
        const double value = (*pair)[swapped ? 1 - k : k];
        const std::vector<double> one = {is_length_column(*keys[k]) ? factor * value : value};
        if (!schema::accepts(*keys[k], one))
          fail(fmt::format("\"{}\" must be {}, not {}", keys[k]->name, schema::expectation(*keys[k], one),
                           one[0]));
        columns[k].push_back(one[0]);
      }
      if (columns[0].size() > wanted.most)
        fail(fmt::format("more than {} points; {}", wanted.most, wanted.if_more));
    } else if (!headed && columns[0].empty() && !begins_with_a_number(line)) {
      headed = true;
      const Headings headings = headings_in(line);
      if (headings.columns.size() != 2) continue;
      swapped = headings.columns[0].name == keys[1]->name && headings.columns[1].name == keys[0]->name;
      for (std::size_t k = 0; k < 2; ++k)
        if (const std::string& said = headings.columns[swapped ? 1 - k : k].unit;
            is_length_column(*keys[k]) && !said.empty())
          take_unit(said);
    } else {
      fail(fmt::format("expected {} and {}, two numbers with decimal points such as 0.5, 12; not {}",
                       keys[0]->name, keys[1]->name, toml_string(line.substr(0, 40))));
    }
  }
  if (columns[0].empty())
    throw Error(ErrorCode::bad_scene,
                fmt::format("no line has two numbers, {} and {}", keys[0]->name, keys[1]->name),
                {file.string()});
  return columns;
}

}  // namespace bernal

#include "scene/read_columns.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include <fmt/format.h>

#include "bernal/core/error.hpp"
#include "core/file_kind.hpp"
#include "core/next_line.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

/// More points are measurements, not a distribution; and a scene has to hold them.
constexpr std::size_t most_points = 4096;
constexpr std::size_t longest_pair = 1000;
constexpr std::string_view blank = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blank);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

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
  if (blank.find(line.front()) == blank.npos && line.front() != ',' && line.front() != ';')
    return std::nullopt;
  line = trimmed(line);
  if (line.starts_with(',') || line.starts_with(';')) line = trimmed(line.substr(1));
  const std::optional<double> second = take_number(line);
  if (!second || !line.empty()) return std::nullopt;
  return std::array{*first, *second};
}

bool begins_with_a_number(std::string_view line) { return bool(take_number(line)); }

}  // namespace

std::array<std::vector<double>, 2> read_columns(const std::filesystem::path& file,
                                                const std::array<const schema::Key*, 2>& keys) {
  if (const FileKind kind = kind_of_file(file); kind != FileKind::regular) {
    const std::string name = toml_string(file.string());
    throw Error(ErrorCode::bad_scene, kind == FileKind::missing ? fmt::format("there is no file {}", name)
                                      : kind == FileKind::folder
                                          ? fmt::format("{} is a folder", name)
                                          : fmt::format("{} is a pipe or a device", name));
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(ErrorCode::bad_scene, fmt::format("{} cannot be read", toml_string(file.string())));

  std::array<std::vector<double>, 2> columns;
  bool headed = false;
  std::string text;
  for (int number = 1;; ++number) {
    const NextLine next = next_line(in, text);
    if (next == NextLine::none) break;
    const auto fail = [&](const std::string& why) {
      throw Error(ErrorCode::bad_scene, why, {file.string(), number});
    };
    if (next == NextLine::too_long || text.size() > longest_pair)
      fail("this line is too long for two numbers; is it another file?");
    std::string_view line = text;
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    if (const auto pair = pair_in(line)) {
      for (std::size_t k = 0; k < 2; ++k) {
        const std::vector<double> one = {(*pair)[k]};
        if (!schema::accepts(*keys[k], one))
          fail(fmt::format("\"{}\" must be {}, not {}", keys[k]->name, schema::expectation(*keys[k], one),
                           one[0]));
        columns[k].push_back(one[0]);
      }
      if (columns[0].size() > most_points)
        fail(fmt::format("more than {} points; sum them up in fewer", most_points));
    } else if (!headed && columns[0].empty() && !begins_with_a_number(line)) {
      headed = true;
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

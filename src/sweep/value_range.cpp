#include "sweep/value_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "scene/read_value.hpp"
#include "scene/toml_file.hpp"
#include "scene/toml_text.hpp"

namespace bernal::sweep {
namespace {

constexpr double most_values = 1e6;

/// Names of keys that take whole numbers alone, wherever they stand.
const std::set<std::string, std::less<>>& whole_keys() {
  static const auto names = [] {
    std::set<std::string, std::less<>> whole, other;
    for (const ReferenceGroup& group : scene_reference())
      for (const ReferenceTable& table : group.tables)
        for (const ReferenceKey& key : table.keys) (key.type == "integer" ? whole : other).insert(key.name);
    std::erase_if(whole, [&](const std::string& name) { return other.contains(name); });
    return whole;
  }();
  return names;
}

class Range {
 public:
  Range(const toml::table& table, const KeyPath& key, const std::string& file)
      : table_(table), key_(key), file_(file), whole_(whole_keys().contains(key.last_name())) {}

  std::vector<double> values() const {
    constexpr std::array<std::string_view, 5> known = {"from", "to", "step", "count", "scale"};
    for (const auto& [name, node] : table_)
      if (std::ranges::find(known, name.str()) == known.end())
        fail(name.source(),
             fmt::format("unknown key {} in a range{}", toml_string(name.str()), remedy(name.str(), known)));
    const double from = number("from"), to = number("to");
    const bool by_log = is_logarithmic(), by_count = table_.contains("count"),
               by_step = table_.contains("step");
    if (by_count && by_step)
      fail(at("step"), "\"count\" and \"step\" of a range exclude each other; give one");
    if (by_log && !by_count) fail(at("scale"), "a range with scale = \"log\" needs a \"count\"");
    if (by_log && !(from > 0 && to > 0)) fail(at("scale"), "a range with scale = \"log\" has ends above 0");
    return by_count ? spread(from, to, by_log) : steps(from, to, by_step);
  }

  std::string text(double value) const { return fmt::format("{}", value); }

 private:
  std::vector<double> spread(double from, double to, bool by_log) const {
    const double count = number("count");
    if (!(count >= 2 && count <= most_values && count == std::floor(count)))
      fail(at("count"),
           fmt::format("the \"count\" of a range must be a whole number from 2 to {:.0f}, not {}",
                       most_values, written(*table_.get("count"))));
    if (from == to) fail(at("to"), "the ends of a range must differ");
    std::vector<double> values;
    for (int k = 0; k < static_cast<int>(count); ++k) {
      const double share = k / (count - 1);
      values.push_back(rounded(by_log ? from * std::pow(to / from, share) : from + (to - from) * share));
    }
    return values;
  }

  std::vector<double> steps(double from, double to, bool given) const {
    const bool are_whole = from == std::floor(from) && to == std::floor(to);
    if (!given && !are_whole)
      fail(table_.source(), "a range between numbers that are not whole needs a \"count\" or a \"step\"");
    const double step = given ? number("step") : to < from ? -1 : 1;
    if (step == 0 || (to - from) / step < 0)
      fail(at("step"),
           fmt::format("the \"step\" of a range must lead from {} to {}, not be {}", from, to, step));
    const double count = std::floor((to - from) / step + 1e-9) + 1;
    if (!(count <= most_values))
      fail(table_.source(), fmt::format("a range has at most {:.0f} values", most_values));
    std::vector<double> values;
    for (int k = 0; k < static_cast<int>(count); ++k) values.push_back(rounded(from + k * step));
    return values;
  }

  double rounded(double value) const {
    if (whole_) return std::round(value);
    return std::abs(value) < 1e-300 ? 0 : std::stod(fmt::format("{:.12g}", value));
  }

  bool is_logarithmic() const {
    const toml::node* node = table_.get("scale");
    if (!node) return false;
    const auto word = node->value<std::string>();
    if (word != "log" && word != "linear")
      fail(node->source(),
           fmt::format("the \"scale\" of a range must be \"linear\" or \"log\", not {}", written(*node)));
    return word == "log";
  }

  double number(std::string_view name) const {
    const toml::node* node = table_.get(name);
    if (!node) fail(table_.source(), fmt::format("a range needs \"{}\"", name));
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value))
      fail(node->source(), fmt::format("\"{}\" of a range must be a number, not {}", name, written(*node)));
    constexpr double largest = 0x1p53;
    if (std::abs(*value) > largest && node->is_integer())
      fail(node->source(), fmt::format("\"{}\" of a range must not be beyond 2^53", name));
    return *value;
  }

  const toml::source_region& at(std::string_view name) const {
    const auto found = table_.find(name);
    return found == table_.end() ? table_.source() : found->first.source();
  }

  [[noreturn]] void fail(const toml::source_region& where, const std::string& why) const {
    throw Error(ErrorCode::bad_scene, fmt::format("\"{}\": {}", key_.text(), why), location_of(where, file_));
  }

  const toml::table& table_;
  const KeyPath& key_;
  const std::string& file_;
  bool whole_;
};

}  // namespace

bool is_range(const toml::table& table) { return table.contains("from") || table.contains("to"); }

toml::array values_of_range(const toml::table& table, const KeyPath& key, const std::string& file) {
  const Range range(table, key, file);
  std::vector<std::string> texts;
  for (const double value : range.values()) texts.push_back(range.text(value));
  return array_at(fmt::format("{}", fmt::join(texts, ",")), table.source(), file);
}

toml::array array_at(const std::string& numbers, const toml::source_region& where, const std::string& file) {
  const std::size_t lines_before = where.begin.line > 0 ? where.begin.line - 1 : 0;
  toml::table made = toml::parse(std::string(lines_before, '\n') + "v=[" + numbers + "]", file);
  return std::move(*made["v"].as_array());
}

}  // namespace bernal::sweep

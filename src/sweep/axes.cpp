#include "sweep/axes.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "scene/read_value.hpp"
#include "scene/toml_file.hpp"
#include "scene/toml_text.hpp"
#include "sweep/value_range.hpp"

namespace bernal::sweep {
namespace {

constexpr double most_cells = 1e6;

std::string toml_of(const toml::node& node) {
  std::vector<std::string> parts;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& item : *array) parts.push_back(toml_of(item));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      parts.push_back(fmt::format("{} = {}", key.str(), toml_of(value)));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
  }
  if (const auto* text = node.as_string()) return toml_string(text->get());
  return written(node);
}

class AxesReader {
 public:
  AxesReader(const std::filesystem::path& file) : file_(file.string()) {}

  Axes read(toml::table& sweep, std::int64_t seed) {
    if (toml::node* cases = sweep.get("case")) add_cases(*cases);
    if (toml::node* grid = sweep.get("grid")) {
      if (!grid->is_table())
        fail(grid->source(), fmt::format("\"grid\" must be a table [grid], not {}", written(*grid)));
      add_grid(*grid->as_table());
    }
    if (toml::node* repeats = sweep.get("repeats")) add_repeats(*repeats, seed);
    require_apart();
    return std::move(axes_);
  }

 private:
  struct Leaf {
    std::string path;
    toml::source_region where;
    toml::node* node;
  };
  /// Keys of a table in the order of the file; `is_value` says which tables are values themselves.
  void collect(toml::table& table, const std::string& before, bool (*is_value)(const toml::table&),
               std::vector<Leaf>& leaves) const {
    for (auto&& [key, node] : table) {
      const std::string path = before + (before.empty() ? "" : ".") + std::string(key.str());
      toml::table* nested = node.as_table();
      if (nested && !is_value(*nested)) {
        if (nested->empty()) fail(key.source(), fmt::format("\"{}\" has no values", path));
        collect(*nested, path, is_value, leaves);
      } else {
        leaves.push_back({path, key.source(), &node});
      }
    }
  }
  std::vector<Leaf> leaves_of(toml::table& table, bool (*is_value)(const toml::table&)) const {
    std::vector<Leaf> leaves;
    collect(table, "", is_value, leaves);
    std::ranges::sort(leaves, [](const Leaf& a, const Leaf& b) { return a.where.begin < b.where.begin; });
    return leaves;
  }

  void add_cases(toml::node& node) {
    toml::array* cases = node.as_array();
    if (!cases || cases->empty() || !cases->is_array_of_tables())
      fail(node.source(), fmt::format("\"case\" must be one table [[case]] a case, not {}", written(node)));
    const auto is_value = [](const toml::table& table) { return table.is_inline(); };
    Alternatives axis;
    for (toml::node& item : *cases) {
      Choice choice;
      for (const Leaf& leaf : leaves_of(*item.as_table(), is_value))
        choice.push_back(setting(leaf, *leaf.node, "[[case]]"));
      if (choice.empty())
        fail(item.source(), "a [[case]] says nothing; give it keys of a scene, or leave it out");
      axis.push_back(std::move(choice));
    }
    axes_.axes.push_back(std::move(axis));
  }

  void add_grid(toml::table& grid) {
    for (const Leaf& leaf : leaves_of(grid, is_range)) {
      const KeyPath path = path_of(leaf, "[grid]");
      toml::array made;
      toml::array* values = leaf.node->as_array();
      if (const toml::table* range = leaf.node->as_table()) {
        made = values_of_range(*range, path, file_);
        values = &made;
      }
      Alternatives axis;
      std::set<std::string> seen;
      const auto add = [&](toml::node& value) {
        Choice choice;
        choice.push_back(setting(leaf, value, "[grid]"));
        if (!seen.insert(toml_of(choice.front().assignment.value.node())).second)
          fail(leaf.where,
               fmt::format("\"{}\" in [grid] has the value {} twice; runs that differ by their seed "
                           "alone are asked for by repeats = 5",
                           path.text(), choice.front().text));
        axis.push_back(std::move(choice));
      };
      if (!values)
        add(*leaf.node);
      else if (values->empty())
        fail(leaf.where, fmt::format("\"{}\" in [grid] has no values", path.text()));
      else
        for (toml::node& value : *values) add(value);
      axes_.axes.push_back(std::move(axis));
    }
  }

  void add_repeats(toml::node& node, std::int64_t seed) {
    const auto count = node.is_number() ? node.value<std::int64_t>() : std::nullopt;
    if (!count || *count < 1 || static_cast<double>(*count) > most_cells)
      fail(node.source(), fmt::format("\"repeats\" must be a whole number from 1 to {:.0f}, not {}",
                                      most_cells, written(node)));
    if (seed > std::numeric_limits<std::int64_t>::max() - *count)
      fail(node.source(), "so many seeds do not follow that of the scene");
    std::string seeds;
    for (std::int64_t k = 0; k < *count; ++k) seeds += fmt::format("{}{}", k == 0 ? "" : ",", seed + k);
    toml::array values = array_at(seeds, node.source(), file_);
    Alternatives axis;
    axis.resize(values.size());
    for (std::size_t k = 0; k < axis.size(); ++k)
      axis[k].push_back(setting({"seed", node.source(), nullptr}, *values.get(k), "repeats"));
    axes_.axes.push_back(std::move(axis));
  }

  KeyPath path_of(const Leaf& leaf, std::string_view in) const {
    const auto path = KeyPath::parsed(leaf.path);
    if (!path)
      fail(leaf.where, fmt::format("{} in {} is no key of a scene, such as \"spheres.diameter.sigma\" or "
                                   "\"stage[0].alpha\"",
                                   toml_string(leaf.path), in));
    return *path;
  }

  Setting setting(const Leaf& leaf, toml::node& value, const std::string& in) {
    const KeyPath path = path_of(leaf, in);
    const std::string name = path.text();
    std::string text = shown(value);
    auto key = std::ranges::find(axes_.keys, name);
    if (key == axes_.keys.end()) key = axes_.keys.insert(key, name);
    paths_.push_back({path, leaf.where, axes_.axes.size(), in});
    return {
        static_cast<std::size_t>(key - axes_.keys.begin()), std::move(text), {path, leaf.where, Slot(value)}};
  }

  /// No key is swept twice, nor a table together with a key in it.
  void require_apart() const {
    std::map<std::string, const Said*> said;
    for (const Said& one : paths_) {
      const auto [other, is_new] = said.try_emplace(one.path.text(), &one);
      if (!is_new && other->second->axis != one.axis) fail_twice(*other->second, one);
    }
    for (auto one = said.begin(); one != said.end(); ++one)
      for (auto other = std::next(one); other != said.end(); ++other)
        if (one->second->path.overlaps(other->second->path) && one->second->axis != other->second->axis)
          fail_twice(*one->second, *other->second);
    for (const Alternatives& axis : axes_.axes)
      for (const Choice& choice : axis)
        for (std::size_t k = 0; k < choice.size(); ++k)
          for (std::size_t l = 0; l < k; ++l)
            if (choice[k].assignment.path.overlaps(choice[l].assignment.path))
              fail(choice[k].assignment.where,
                   overlap_text(choice[l].assignment.path, choice[k].assignment.path));
  }

  struct Said {
    KeyPath path;
    toml::source_region where;
    std::size_t axis;
    std::string in;
  };
  static std::string overlap_text(const KeyPath& one, const KeyPath& other) {
    return fmt::format("\"{}\" and \"{}\" write over each other; give one of them", one.text(), other.text());
  }
  [[noreturn]] void fail_twice(const Said& one, const Said& other) const {
    const Said& later = other.where.begin < one.where.begin ? one : other;
    if (one.path.text() != other.path.text()) fail(later.where, overlap_text(one.path, other.path));
    fail(later.where,
         fmt::format("\"{}\" is swept by {} and by {}; give one of them", one.path.text(), one.in, other.in));
  }

  [[noreturn]] void fail(const toml::source_region& where, const std::string& why) const {
    throw Error(ErrorCode::bad_scene, why, location_of(where, file_));
  }

  std::string file_;
  Axes axes_;
  std::vector<Said> paths_;
};

}  // namespace

std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  return toml_of(node);
}

Axes read_axes(toml::table& sweep, const std::filesystem::path& file, std::int64_t seed) {
  return AxesReader(file).read(sweep, seed);
}

std::size_t Axes::size(const std::filesystem::path& file) const {
  double cells = 1;
  for (const Alternatives& axis : axes) cells *= static_cast<double>(axis.size());
  if (cells > most_cells)
    throw Error(ErrorCode::bad_scene,
                fmt::format("the sweep has {:.4g} cells; ask for at most {:.0f}", cells, most_cells),
                {file.string()});
  return static_cast<std::size_t>(cells);
}

std::vector<Choice*> Axes::choices(std::size_t cell) {
  std::vector<Choice*> taken(axes.size());
  for (std::size_t k = axes.size(); k-- > 0;) {
    taken[k] = &axes[k][cell % axes[k].size()];
    cell /= axes[k].size();
  }
  return taken;
}

}  // namespace bernal::sweep

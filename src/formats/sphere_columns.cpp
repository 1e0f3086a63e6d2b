#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bernal/core/dimension.hpp"
#include "core/lower_case.hpp"
#include "files/csv_headings.hpp"
#include "formats/foreign_lines.hpp"

namespace bernal {
namespace {

constexpr std::string_view example_of_wish = "‹columns=x,y,z,r› (r radius, d diameter, - another column)";

bool names_radius(std::string_view word) {
  return word == "r" || word == "radius" || word == "radii" || word == "rad" || word == "particle_radius" ||
         word == "particle radius";
}
bool names_diameter(std::string_view word) {
  return word == "d" || word == "diameter" || word == "diam" || word == "diameters" ||
         word == "particle_diameter" || word == "particle diameter";
}

}  // namespace

std::optional<std::size_t> axis_named(std::string_view name) {
  const std::string lower = in_lower_case(name);
  const std::string_view word = lower;
  if (word.size() == 1 && word[0] >= 'x' && word[0] <= 'z') return static_cast<std::size_t>(word[0] - 'x');
  for (const std::string_view stem : {"x", "points:", "points_"}) {  // the latter two are ParaView's
    if (!word.starts_with(stem) || word.size() != stem.size() + 1) continue;
    const char digit = word.back();
    if (digit >= '0' && digit < '0' + max_dimension) return static_cast<std::size_t>(digit - '0');
  }
  return {};
}
namespace {

/// Assigns columns to roles, one by one.
struct Choice {
  const CsvLines& lines;
  std::vector<std::optional<std::size_t>> axes = {};
  std::optional<std::size_t> size = {};
  bool is_diameter = false;
  bool twice = false;  ///< two columns have the same role

  /// False if the word is not a role.
  bool take(std::string_view role, std::size_t place) {
    if (const auto axis = axis_named(role)) {
      if (axes.size() <= *axis) axes.resize(*axis + 1);
      twice = twice || axes[*axis].has_value();
      axes[*axis] = place;
      return true;
    }
    if (!names_radius(role) && !names_diameter(role)) return false;
    twice = twice || size.has_value();
    size = place;
    is_diameter = names_diameter(role);
    return true;
  }

  bool is_complete() const {
    return !axes.empty() && std::ranges::all_of(axes, [](const auto& place) { return place.has_value(); });
  }
  SphereColumns columns(const std::vector<std::string>& names) const {
    SphereColumns made{.size = size, .is_diameter = is_diameter};
    const auto name = [&](std::size_t place) {
      return place < names.size() ? names[place] : fmt::format("column {}", place + 1);
    };
    for (const auto& place : axes) {
      made.x.push_back(*place);
      made.names.push_back(name(*place));
    }
    if (size) made.names.push_back(name(*size));
    return made;
  }
};

SphereColumns columns_by_name(const std::vector<std::string>& names, const CsvLines& lines) {
  Choice choice{lines};
  for (std::size_t k = 0; k < names.size(); ++k) choice.take(in_lower_case(names[k]), k);
  if (!choice.is_complete())
    lines.fail(
        fmt::format("the columns are called {}, and none or not all of x, y, z; say which they are, such "
                    "as ‹columns=x=3,y=4,z=5,d=7›",
                    bernal::quoted(fmt::format("{}", fmt::join(names, " ")))));
  if (choice.twice)
    lines.fail(
        fmt::format("of the columns {} two may be a coordinate or the size; say which are meant, such "
                    "as ‹columns=x=3,y=4,z=5,d=7›",
                    bernal::quoted(fmt::format("{}", fmt::join(names, " ")))));
  return choice.columns(names);
}

/// The column for a number, from 1, or a name.
std::size_t place_of_wish(std::string_view word, const std::vector<std::string>& names,
                          const CsvLines& lines) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (in_lower_case(names[k]) == in_lower_case(word)) return k;
  if (const auto number = whole_number(word);
      number && *number > 0 && *number <= (names.empty() ? 4096 : names.size()))
    return *number - 1;
  lines.fail(
      names.empty()
          ? fmt::format("‹columns›: {} is no number of a column, which count from 1", bernal::quoted(word))
          : fmt::format("‹columns›: there is no column {}; there are {}", bernal::quoted(word),
                        bernal::quoted(fmt::format("{}", fmt::join(names, " ")))));
}

}  // namespace

std::size_t SphereColumns::least_fields() const {
  std::size_t last = size.value_or(0);
  for (const std::size_t place : x) last = std::max(last, place);
  return last + 1;
}

std::string SphereColumns::in_words() const {
  std::vector<std::string> all;
  const auto add = [&](std::string_view role, std::size_t place, const std::string& name) {
    const std::string number = fmt::format("column {}", place + 1);
    all.push_back(name == number ? fmt::format("{} {}", role, number)
                                 : fmt::format("{} {} ({})", role, number, bernal::quoted(name)));
  };
  for (std::size_t k = 0; k < x.size(); ++k)
    add(x.size() > 3 ? fmt::format("x{}", k) : std::string(1, static_cast<char>('x' + k)), x[k], names[k]);
  if (size) add(is_diameter ? "diameter" : "radius", *size, names.back());
  return fmt::format("{}", fmt::join(all, ", "));
}

SphereColumns sphere_columns(const std::string& wish, const std::vector<std::string>& names,
                             const CsvLines& lines) {
  if (wish.empty()) {
    if (names.empty())
      lines.fail(fmt::format("no line names the columns; say which they are, such as {}", example_of_wish));
    return columns_by_name(names, lines);
  }
  std::vector<std::string_view> words;
  split_fields(wish, ',', words);
  // A list of names in the header selects by name, in any order.
  const auto is_named = [&](std::string_view word) {
    return std::ranges::any_of(
        names, [&](const std::string& name) { return in_lower_case(name) == in_lower_case(word); });
  };
  const bool by_name = std::ranges::find(words, "-") == words.end() && std::ranges::any_of(words, is_named);
  Choice choice{lines};
  for (std::size_t k = 0; k < words.size(); ++k) {
    const std::string_view word = words[k];
    if (word == "-") continue;
    const std::size_t sign = word.find('=');
    const std::string role = in_lower_case(word.substr(0, sign));
    if (choice.twice) break;
    std::size_t place = k;
    if (sign != word.npos) {
      place = place_of_wish(word.substr(sign + 1), names, lines);
    } else if (by_name) {
      // "d" also matches the header "diameter".
      const auto same = std::ranges::find_if(names, [&](const std::string& name) {
        const std::string lower = in_lower_case(name);
        return lower == role || (names_radius(role) && names_radius(lower)) ||
               (names_diameter(role) && names_diameter(lower));
      });
      place = same != names.end() ? static_cast<std::size_t>(same - names.begin())
                                  : place_of_wish(word, names, lines);
    }
    if (!choice.take(role, place))
      lines.fail(
          fmt::format("‹columns›: {} is neither a coordinate nor a size; write x, y, z and r or d, - for "
                      "another column, or x=3,y=4,z=5,d=7",
                      bernal::quoted(word)));
  }
  if (choice.twice)
    lines.fail(
        fmt::format("‹columns› names a coordinate or the size twice; write it such as {}", example_of_wish));
  if (!choice.is_complete())
    lines.fail(fmt::format("‹columns› names not all coordinates; write it such as {}", example_of_wish));
  SphereColumns columns = choice.columns(names);
  if (!names.empty() && columns.least_fields() > names.size())
    lines.fail(
        fmt::format("‹columns› names {} columns, and the file has {}", columns.least_fields(), names.size()));
  return columns;
}

}  // namespace bernal

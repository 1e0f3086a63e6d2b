#include "cad/read/file_facts.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "bernal/core/text.hpp"
#include "core/lower_case.hpp"

namespace bernal::cad {
namespace {

constexpr std::pair<std::string_view, double> units_by_name[] = {
    {"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2}, {"inch", 0.0254},
    {"foot", 0.3048}, {"feet", 0.3048},     {"meter", 1},
};

}  // namespace

void set_unit(pugi::xml_node root, FileFacts& facts) {
  const pugi::xml_attribute unit = root.attribute("unit");
  const std::string name = in_lower_case(unit.empty() ? "millimeter" : unit.value());
  if (unit.empty()) facts.notes.push_back("the file names no unit; the default is millimeter");
  for (const auto& [known, metres] : units_by_name)
    if (name == known) facts.unit = FileFacts::Length{metres, name};
  if (!facts.unit)
    facts.notes.push_back(fmt::format("the file's unit \"{}\" is unknown to its format", unit.value()));
}

FileFacts facts_of_collada(std::string text) {
  const XmlDocument xml({}, std::move(text));
  const pugi::xml_node asset = child_of(xml.root(), "asset");
  FileFacts facts;
  const std::string_view axis = trimmed(child_of(asset, "up_axis").child_value());
  if (axis == "X_UP") facts.up = 'x';
  if (axis == "Y_UP") facts.up = 'y';
  if (axis == "Z_UP") facts.up = 'z';
  const pugi::xml_node unit = child_of(asset, "unit");
  const std::string_view written = attribute_of(unit, "meter"), digits = trimmed(written);
  double metres = written.empty() ? 1 : 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), metres);
  if (metres > 0 && std::isfinite(metres)) {
    std::string name(attribute_of(unit, "name"));
    if (name.empty()) name = metres == 1 ? "meter" : fmt::format("{} m", metres);
    facts.unit = FileFacts::Length{metres, std::move(name)};
  } else {
    facts.notes.push_back(fmt::format("the file's unit is \"{}\" metres, which is none", written));
  }
  return facts;
}

std::string text_without_mark(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  return text;
}

}  // namespace bernal::cad

#include "bernal/scene/scene_reference.hpp"

#include "scene/cells_entry.hpp"
#include "scene/layer_entry.hpp"
#include "scene/output_table.hpp"
#include "scene/scene_entries.hpp"
#include "scene/stage_table.hpp"
#include "scene/toml_text.hpp"

namespace bernal {
namespace {

using schema::Entry;

/// In the order of schema::Type.
constexpr std::string_view type_words[] = {
    "flag",  "integer",     "number",  "length", "word",       "file",    "direction",
    "push",  "position",    "text",    "names",  "corner",     "extents", "points",
    "lines", "coordinates", "lengths", "shares", "amounts",    "axes",    "distribution",
    "parts", "solids",      "table",   "tables", "table_lists"};
static_assert(std::size(type_words) == static_cast<std::size_t>(schema::Type::table_lists) + 1);
/// In the order of schema::Acts.
constexpr std::string_view acts_words[] = {"everywhere", "in_bed", "in_box"};
/// In the order of Quantity.
constexpr std::string_view quantity_words[] = {"none", "length", "diameter", "spread", "mass", "density"};

ReferenceKey described(const Entry& entry, const schema::Key& key) {
  ReferenceKey made{.name = std::string(key.name),
                    .help = std::string(key.help),
                    .type = std::string(type_words[static_cast<std::size_t>(key.type)]),
                    .expectation = schema::expectation(key),
                    .min = key.range.min,
                    .max = key.range.max,
                    .above_min = key.range.above_min,
                    .below_max = key.range.below_max,
                    .words = {key.words.begin(), key.words.end()},
                    .required = key.required,
                    .is_diameter = key.is_diameter,
                    .acts = std::string(acts_words[static_cast<std::size_t>(key.acts)]),
                    .quantity = std::string(quantity_words[static_cast<std::size_t>(key.measured())]),
                    .table = std::string(key.table ? key.table().name : "")};
  const auto otherwise = key.required ? std::nullopt : key.of(entry.defaults.get());
  if (otherwise && key.type != schema::Type::distribution) made.otherwise = toml_text(*otherwise);
  return made;
}

ReferenceTable described(const Entry& entry) {
  ReferenceTable made{.name = std::string(entry.name), .help = std::string(entry.help), .keys = {}};
  for (const schema::Key& key : entry.keys) made.keys.push_back(described(entry, key));
  for (const schema::Choice& choice : entry.choices) {
    auto& sets = made.choices.emplace_back();
    for (const auto& set : choice) sets.emplace_back(set.begin(), set.end());
  }
  return made;
}

}  // namespace

std::vector<ReferenceGroup> scene_reference() {
  std::vector<ReferenceGroup> groups = {
      {"scene", "", "Tables of a scene", {}},
      {"container", "kind", "Containers: kind = \"…\" in [container]", {}},
      {"diameter", "distribution", "Sizes: distribution = \"…\" in radius or diameter", {}},
      {"stage", "do", "Stages: do = \"…\" in [[stage]]", {}},
      {"output", "format", "Files for other programs: format = \"…\" in [[output]]", {}},
      {"engine", "kind", "Other programs that find the places: kind = \"…\" in [engine]", {}},
      {"zone", "", "Parts of a container with spheres of their own: [[zone]]", {}},
      {"table", "", "Tables within others: layers = [{ … }]", {}}};
  for (const Entry* entry : schema::own_entries()) groups[0].tables.push_back(described(*entry));
  for (const Entry& entry : schema::container_entries()) groups[1].tables.push_back(described(entry));
  for (const Entry& entry : schema::size_entries()) groups[2].tables.push_back(described(entry));
  for (const StageTable* table : stage_tables()) groups[3].tables.push_back(described(table->keys));
  for (const OutputTable* table : output_tables()) groups[4].tables.push_back(described(table->keys));
  for (const Entry& entry : schema::engine_entries()) groups[5].tables.push_back(described(entry));
  ReferenceTable zone = described(schema::zone_entry()), spheres = described(schema::spheres_of_zone_entry());
  zone.keys.insert(zone.keys.end(), spheres.keys.begin(), spheres.keys.end());
  zone.choices.insert(zone.choices.end(), spheres.choices.begin(), spheres.choices.end());
  groups[6].tables.push_back(std::move(zone));
  for (const Entry* entry :
       {&schema::layer_entry(), &schema::thickness_entry(), &schema::cells_entry(), &schema::inside_entry()})
    groups[7].tables.push_back(described(*entry));
  return groups;
}

}  // namespace bernal

// The output of `bernal keys --schema`, made from the table that scenes are read by.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bernal/core/vector.hpp"
#include "bernal/report/json.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "scene/scene_entries.hpp"

namespace bernal {
namespace {

using SceneSchema = nlohmann::ordered_json;

SceneSchema refers_to(const std::string& definition) { return {{"$ref", "#/$defs/" + definition}}; }

SceneSchema array_of(SceneSchema items, std::size_t least, std::size_t most = 0) {
  SceneSchema made = {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}};
  if (most > 0) made["maxItems"] = most;
  return made;
}

/// Text that is a number with one of these units, see `number_with_unit`.
SceneSchema with_unit(const std::string& units, const char* sign = "[-+]?") {
  return {{"type", "string"},
          {"pattern",
           fmt::format(R"(^\s*{}([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*({})\s*$)", sign, units)}};
}
SceneSchema either(SceneSchema one, SceneSchema other) {
  return {{"anyOf", {std::move(one), std::move(other)}}};
}

constexpr const char* length_units = "nm|um|µm|μm|mm|cm|m|in|ft";

/// The text that a number of that quantity may be; none where there is no unit.
std::optional<SceneSchema> measured_text(const std::string& quantity) {
  if (quantity == "length") return with_unit(length_units);
  if (quantity == "spread") return with_unit("phi");
  if (quantity == "mass") return with_unit("mg|g|kg|t|lb");
  if (quantity == "density") return with_unit("kg/m3|kg/m³|g/cm3|g/cm³");
  return std::nullopt;
}

/// The smallest and the largest length, as in `schema::accepts`; phi is of diameters of grains, which differ
/// from other lengths in that only.
SceneSchema basic_definitions() {
  const SceneSchema plain = {{"type", "number"}, {"minimum", 1e-30}, {"maximum", 1e30}};
  const SceneSchema component = {{"type", "number"}, {"minimum", -1e30}, {"maximum", 1e30}};
  const SceneSchema length = {{"anyOf", {plain, with_unit(length_units, R"(\+?)"), with_unit("phi")}}};
  const SceneSchema not_zero = {
      {"anyOf", {SceneSchema{{"minimum", 1e-30}}, SceneSchema{{"maximum", -1e-30}}}}};
  const SceneSchema file = {{"type", "string"}, {"pattern", R"(^[^\u0000]+$)"}};
  SceneSchema direction = array_of(refers_to("component"), 3, 3);
  SceneSchema push = array_of(refers_to("component"), 2, 3);
  direction["contains"] = push["contains"] = not_zero;
  SceneSchema axes = array_of({{"type", "integer"}, {"minimum", 0}, {"maximum", max_dimension - 1}}, 0);
  axes["uniqueItems"] = true;
  return {
      {"length", length},
      {"positive", plain},
      {"component", component},
      {"coordinate", either(component, with_unit(length_units))},
      {"file", file},
      {"direction", direction},
      {"push", push},
      {"position", array_of(refers_to("coordinate"), 3, 3)},
      {"text", {{"type", "string"}, {"pattern", R"(^[^\u0000-\u001f,;"'<>&\\]+$)"}}},
      {"name", {{"anyOf", {file, SceneSchema{{"type", "integer"}}}}}},
      {"names", {{"anyOf", {refers_to("name"), array_of(refers_to("name"), 1)}}}},
      {"corner", array_of(refers_to("coordinate"), 2, 3)},
      {"extents", array_of(refers_to("length"), 2, 3)},
      {"points", array_of(array_of(refers_to("coordinate"), 2, 2), 3)},
      {"lines", array_of(refers_to("points"), 0)},
      {"coordinates", array_of(refers_to("coordinate"), 1)},
      {"lengths", array_of(refers_to("length"), 1)},
      {"lengths_from_zero", array_of(either({{"const", 0}}, refers_to("length")), 1)},
      {"shares", array_of(refers_to("positive"), 1)},
      {"amounts", array_of({{"anyOf", {SceneSchema{{"const", 0}}, refers_to("positive")}}}, 1)},
      {"axes", axes},
      {"solids", {{"anyOf", {refers_to("file"), array_of(refers_to("solid"), 1)}}}},
  };
}

SceneSchema one_of_words(const ReferenceKey& key) { return {{"type", "string"}, {"enum", key.words}}; }

SceneSchema within_range(const ReferenceKey& key) {
  const bool whole = key.type == "integer";
  const auto limit = [whole](double v) {
    return whole ? SceneSchema(static_cast<std::int64_t>(v)) : SceneSchema(v);
  };
  SceneSchema made = {{"type", key.type}};
  if (std::isfinite(key.min)) made[key.above_min ? "exclusiveMinimum" : "minimum"] = limit(key.min);
  // TOML's largest integer; but 1e31 is an integer for JSON.
  if (whole && key.max >= 0x1p63)
    made["maximum"] = std::numeric_limits<std::int64_t>::max();
  else if (std::isfinite(key.max))
    made[key.below_max ? "exclusiveMaximum" : "maximum"] = limit(key.max);
  return made;
}

/// The schema of a key's value; `sizes` is "radius" or "diameter" if its value can be a distribution.
SceneSchema value_of_key(const ReferenceKey& key, const std::string& sizes) {
  if (key.type == "flag")
    return key.min > 0 ? SceneSchema{{"const", true}} : SceneSchema{{"type", "boolean"}};
  if (key.type == "word") return one_of_words(key);
  // Numbers are what they are in a radius, which is no diameter.
  if (key.type == "distribution" && key.words.empty())
    return refers_to(key.name == "volume" ? "radius" : key.name);
  if (key.type == "parts") return array_of(refers_to(sizes), 1);
  if (key.type == "table") return refers_to(key.table);
  if (key.type == "tables") return either(refers_to(key.table), array_of(refers_to(key.table), 1));
  if (key.type == "table_lists") return array_of(array_of(refers_to(key.table), 0), 1);
  if (!key.table.empty()) return either(refers_to(key.type), refers_to(key.table));
  const bool from_zero = key.type == "lengths" && key.min == 0;
  SceneSchema value = key.type == "number" || key.type == "integer"
                          ? within_range(key)
                          : refers_to(from_zero                    ? "lengths_from_zero"
                                      : key.type == "distribution" ? key.name
                                                                   : key.type);
  if (const auto text = measured_text(key.quantity); text && key.type == "number")
    value = either(std::move(value), *text);
  else if (text && key.type == "shares")
    value = array_of(either(refers_to("positive"), *text), 1);
  if (key.words.empty()) return value;
  const SceneSchema word = one_of_words(key);
  if (key.type == "names") return {{"anyOf", {word, array_of(word, 1)}}};
  return {{"anyOf", {word, std::move(value)}}};
}

std::string description_of(const ReferenceKey& key) {
  std::string text = key.help;
  if (key.acts == "in_bed") text += "; between fixed walls";
  if (key.acts == "in_box") text += "; in periodic boxes";
  if (key.type != "flag" && key.type != "word") text += ": " + key.expectation;
  return text;
}

const ReferenceKey* find(const ReferenceTable& table, const std::string& name) {
  const auto found = std::ranges::find(table.keys, name, &ReferenceKey::name);
  return found == table.keys.end() ? nullptr : &*found;
}

/// For a choice of key sets: the required keys of each set, and the keys it excludes.
SceneSchema schema_of_choice(const ReferenceTable& table, const std::vector<std::vector<std::string>>& sets) {
  SceneSchema made = {{"anyOf", SceneSchema::array()}};
  for (const auto& set : sets) {
    SceneSchema needed = SceneSchema::array(), others = SceneSchema::object();
    bool possible = true;
    for (const std::string& name : set) {
      const ReferenceKey* key = find(table, name);
      if (!key) possible = false;
      if (key && !key->otherwise) needed.push_back(name);
    }
    for (const auto& other : sets)
      for (const std::string& name : other)
        if (std::ranges::find(set, name) == set.end() && find(table, name)) others[name] = false;
    if (!possible) continue;
    SceneSchema one = SceneSchema::object();
    if (!needed.empty()) one["required"] = needed;
    if (!others.empty()) one["properties"] = others;
    made["anyOf"].push_back(one);
  }
  return made;
}

/// A table with exactly these keys, and `selector` with its name.
SceneSchema schema_of_table(const ReferenceTable& table, const std::string& selector,
                            const std::string& sizes = {}) {
  SceneSchema properties = SceneSchema::object(), required = SceneSchema::array();
  std::set<std::string> chosen;
  for (const auto& choice : table.choices)
    for (const auto& set : choice) chosen.insert(set.begin(), set.end());
  if (!selector.empty()) {
    properties[selector] = {{"const", table.name}, {"description", table.help}};
    required.push_back(selector);
  }
  for (const ReferenceKey& key : table.keys) {
    SceneSchema value = value_of_key(key, sizes);
    value["description"] = description_of(key);
    if (key.otherwise) value["default"] = SceneSchema::parse(*key.otherwise);
    properties[key.name] = std::move(value);
    if (key.required && !chosen.contains(key.name)) required.push_back(key.name);
  }
  SceneSchema made = {{"description", table.help},
                      {"type", "object"},
                      {"properties", properties},
                      {"additionalProperties", false}};
  if (!required.empty()) made["required"] = required;
  for (const auto& choice : table.choices) made["allOf"].push_back(schema_of_choice(table, choice));
  return made;
}

/// The table with lengths as radii, without keys that are diameters by name. Absent if it needs these.
std::optional<ReferenceTable> as_radii(ReferenceTable table) {
  std::erase_if(table.keys, [](const ReferenceKey& key) { return key.is_diameter; });
  const auto has_all = [&](const std::vector<std::string>& set) {
    return std::ranges::all_of(set, [&](const std::string& name) { return find(table, name); });
  };
  for (const auto& choice : table.choices)
    if (std::ranges::none_of(choice, has_all)) return std::nullopt;
  return table;
}

/// Adds a definition for each table of the group, and `name` for a choice of them.
void define_group(const ReferenceGroup& group, const std::string& name, SceneSchema& definitions) {
  const bool is_size = group.name == "diameter";
  SceneSchema choice = SceneSchema::array();
  if (is_size) choice.push_back(refers_to("length"));
  for (const ReferenceTable& given : group.tables) {
    std::optional<ReferenceTable> table = given;
    // Of percentiles two or more are needed, which this schema does not say.
    const bool has_diameters = std::ranges::any_of(given.keys, &ReferenceKey::is_diameter);
    if (name == "radius") table = has_diameters && given.choices.empty() ? std::nullopt : as_radii(given);
    if (!table) continue;
    const bool depends = std::ranges::any_of(
        given.keys, [](const ReferenceKey& key) { return key.is_diameter || key.type == "parts"; });
    const std::string of = (is_size && !depends ? "size" : name) + "_" + table->name;
    if (!definitions.contains(of)) definitions[of] = schema_of_table(*table, group.selector, name);
    choice.push_back(refers_to(of));
  }
  definitions[name] = {{"oneOf", choice}};
}

}  // namespace

std::string scene_schema_as_json() {
  SceneSchema definitions = basic_definitions();
  SceneSchema scene;
  SceneSchema tables = SceneSchema::object();
  for (const ReferenceGroup& group : scene_reference()) {
    if (!group.selector.empty()) {
      if (group.name == "diameter") define_group(group, "radius", definitions);
      define_group(group, group.name, definitions);
      continue;
    }
    for (const ReferenceTable& table : group.tables) {
      if (table.name == "scene")
        scene = schema_of_table(table, "");
      else if (group.name == "table")
        definitions[table.name] = schema_of_table(table, "");
      else
        tables[table.name] = schema_of_table(table, "");
    }
  }
  // Sizes are optional if a start is given, or zones.
  SceneSchema& sizes = tables.at("spheres").at("allOf").back();
  sizes.at("anyOf").push_back(
      {{"required", {"start"}}, {"properties", {{"radius", false}, {"diameter", false}, {"cells", false}}}});
  definitions["solid"]["anyOf"].push_back(refers_to("file"));
  for (const KnownWord& kind : schema::kinds_of_solids())
    definitions["solid"]["anyOf"].push_back(refers_to(fmt::format("container_{}", kind.name)));
  SceneSchema& properties = scene.at("properties");
  properties["container"] = refers_to("container");
  properties["container"]["description"] =
      "what the spheres lie in; left out of a scene that lies inside of spheres, whose ball it is";
  properties.update(tables);
  properties["zone"] = array_of(std::move(properties.at("zone")), 1);
  properties["zone"]["description"] = "parts of the container with spheres of their own";
  properties["engine"] = refers_to("engine");
  properties["engine"]["description"] = "another program that finds the places the first stage begins with";
  properties["stage"] = array_of(refers_to("stage"), 1);
  properties["stage"]["description"] = "what is done, in this order; if absent what bernal explain prints";
  properties["output"] = array_of(refers_to("output"), 1);
  properties["output"]["description"] = "files for other programs, written with the result";
  SceneSchema made = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                      {"title", "A scene of bernal"},
                      {"description", "What is packed into what, and how."}};
  scene.erase("description");
  made.update(scene);
  made["anyOf"] = {SceneSchema{{"required", {"spheres"}}}, SceneSchema{{"required", {"zone"}}}};
  made["if"] = {{"required", {"container"}},
                {"properties", {{"container", {{"properties", {{"kind", {{"const", "mesh"}}}}}}}}}};
  made["then"] = {{"required", {"unit"}}};
  made["$defs"] = definitions;
  return made.dump(2) + '\n';
}

}  // namespace bernal

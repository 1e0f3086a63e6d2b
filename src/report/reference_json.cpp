#include <nlohmann/json.hpp>

#include "bernal/report/json.hpp"
#include "bernal/scene/scene_reference.hpp"

namespace bernal {
namespace {

using ReferenceJson = nlohmann::ordered_json;  // writes infinity as null

/// Defaults are numbers, words, flags and arrays of them, which have the same syntax in TOML and JSON.
ReferenceJson json_of_key(const ReferenceKey& key) {
  return {{"name", key.name},
          {"help", key.help},
          {"type", key.type},
          {"expectation", key.expectation},
          {"default", key.otherwise ? ReferenceJson::parse(*key.otherwise) : ReferenceJson()},
          {"min", key.min},
          {"max", key.max},
          {"above_min", key.above_min},
          {"below_max", key.below_max},
          {"words", key.words},
          {"required", key.required},
          {"is_diameter", key.is_diameter},
          {"acts", key.acts},
          {"quantity", key.quantity},
          {"table", key.table}};
}

}  // namespace

std::string scene_reference_as_json() {
  ReferenceJson groups = ReferenceJson::array();
  for (const ReferenceGroup& group : scene_reference()) {
    ReferenceJson tables = ReferenceJson::array();
    for (const ReferenceTable& table : group.tables) {
      ReferenceJson keys = ReferenceJson::array();
      for (const ReferenceKey& key : table.keys) keys.push_back(json_of_key(key));
      tables.push_back(
          {{"name", table.name}, {"help", table.help}, {"keys", keys}, {"choices", table.choices}});
    }
    groups.push_back(
        {{"name", group.name}, {"selector", group.selector}, {"title", group.title}, {"tables", tables}});
  }
  return ReferenceJson{{"groups", groups}}.dump(2) + '\n';
}

}  // namespace bernal

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "bernal/report/json.hpp"
#include "bernal/scene/read_scene.hpp"
#include "bernal/scene/scene_reference.hpp"
#include "commands.hpp"

namespace {

std::vector<std::string> names_in_scenes() {
  std::vector<std::string> names;
  for (const bernal::ReferenceGroup& group : bernal::scene_reference()) {
    names.push_back(group.name);
    for (const bernal::ReferenceTable& table : group.tables) names.push_back(table.name);
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

}  // namespace

Command keys_command() {
  const auto name = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  const auto schema = std::make_shared<bool>(false);
  return {
      "keys",
      "Say what a scene may hold: every key with its default",
      {offering({"NAME", name.get(),
                 "A container, a distribution of sizes, a stage or a format of [[output]]; a line each of "
                 "all if absent"},
                names_in_scenes()),
       json_option(*json),
       {"--schema", schema.get(), "Print a JSON Schema of scenes, for editors and programs"}},
      {.examples = {{"bernal keys", "all containers, distributions and stages, a line each"},
                    {"bernal keys relax", "the keys of a stage, their defaults and ranges"},
                    {"bernal keys output", "the formats of [[output]]; likewise stage, container, diameter"},
                    {"bernal keys --json", "all of it, for programs"},
                    {"bernal keys --schema > scene.schema.json",
                     "an editor that knows TOML checks and completes a scene whose first line is #:schema "
                     "./scene.schema.json"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
      [name, json, schema] {
        if ((*json || *schema) && !name->empty()) {
          // one object with all tables, in which a reader looks up a name
          throw bernal::Error(bernal::ErrorCode::bad_argument,
                              "--json and --schema print everything that a scene may say; leave NAME out");
        }
        if (*json && *schema)
          throw bernal::Error(bernal::ErrorCode::bad_argument, "give --json or --schema, not both");
        fmt::print("{}", *json     ? bernal::scene_reference_as_json()
                         : *schema ? bernal::scene_schema_as_json()
                                   : bernal::reference(*name));
        return exit_code::done;
      }};
}

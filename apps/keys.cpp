#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

/// Lines for the options of a command, and of its commands, that speak of what the words ask for.
void add_options_about(const std::string& words, const Command& command, const std::string& name,
                       std::vector<std::pair<double, std::string>>& found) {
  for (const Option& option : command.options)
    for (const std::string& own : option.all_names())
      if (const double match = bernal::relevance(words, own, option.what); match > 0 && own.starts_with("--"))
        found.emplace_back(match,
                           fmt::format("  {} {}{}\n      {}\n", name, own,
                                       option.is_flag() ? "" : " " + option.placeholder(), option.what));
  for (const Command& of : command.commands) add_options_about(words, of, name + " " + of.name, found);
}

/// What a scene or a command may be told of what the words ask for.
std::string found_for(const std::string& words, const Command& all) {
  constexpr std::size_t most = 6;
  const std::string keys = bernal::keys_about(words);
  std::vector<std::pair<double, std::string>> options;
  add_options_about(words, all, all.name, options);
  std::ranges::stable_sort(options, std::greater(), &std::pair<double, std::string>::first);
  if (options.size() > most) options.resize(most);
  std::string text = keys.empty() ? "" : "Keys of a scene:\n" + keys;
  if (!options.empty()) text += (text.empty() ? "" : "\n") + std::string("Options of commands:\n");
  for (const auto& [match, line] : options) text += line;
  return text.empty() ? bernal::reference(words) : text;  // which says what the nearest name is
}

std::string answer(const std::string& words, const Command& all) {
  return words.empty() || bernal::is_in_reference(words) ? bernal::reference(words) : found_for(words, all);
}

}  // namespace

Command keys_command(const Command& all) {
  const auto name = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  const auto schema = std::make_shared<bool>(false);
  return {
      "keys",
      "Say what a scene may hold: every key with its default",
      {offering({"NAME", name.get(),
                 "A container, a distribution of sizes, a stage or a format of [[output]]; or words for what "
                 "a key is about; a line each of all if absent"},
                names_in_scenes()),
       json_option(*json),
       {"--schema", schema.get(), "Print a JSON Schema of scenes, for editors and programs"}},
      {.examples = {{"bernal keys", "all containers, distributions and stages, a line each"},
                    {"bernal keys relax", "the keys of a stage, their defaults and ranges"},
                    {"bernal keys container",
                     "the kinds of containers with their keys; likewise diameter, stage, output"},
                    {"bernal keys roundness of the top", "the keys, and options of commands, about that"},
                    {"bernal keys --json", "all of it, for programs"},
                    {"bernal keys --schema > scene.schema.json",
                     "an editor that knows TOML checks and completes a scene whose first line is #:schema "
                     "./scene.schema.json"}},
       .exit_codes = {{"0", "done"}, {"2", "bad input"}}},
      [name, json, schema, &all] {
        if ((*json || *schema) && !name->empty()) {
          // one object with all tables, in which a reader looks up a name
          throw bernal::Error(bernal::ErrorCode::bad_argument,
                              "--json and --schema print everything that a scene may say; leave NAME out");
        }
        if (*json && *schema)
          throw bernal::Error(bernal::ErrorCode::bad_argument, "give --json or --schema, not both");
        fmt::print("{}", *json     ? bernal::scene_reference_as_json()
                         : *schema ? bernal::scene_schema_as_json()
                                   : answer(fmt::format("{}", fmt::join(*name, " ")), all));
        return exit_code::done;
      }};
}

#pragma once
#include <string>
#include <vector>

#include "check.hpp"

namespace bernal::testing {

/// A command as its --help tells of it, which is read here as people read it.
struct ToldCommand {
  std::vector<std::string> words;    ///< {"design", "target"}
  std::vector<std::string> options;  ///< "--unit", "-o"
  std::vector<std::string> commands;
};

inline ToldCommand told_command(const std::vector<std::string>& words) {
  std::vector<std::string> call = words;
  call.emplace_back("--help");
  const Ended help = bernal(call);
  EXPECT_EQ(help.status, 0) << help.err;
  ToldCommand told{words, {}, {}};
  std::string section;
  std::istringstream lines(help.out);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) section.clear();
    if (line == "Options:" || line == "Subcommands:") section = line;
    if (!line.starts_with("  ") || line[2] == ' ') continue;
    std::string names = line.substr(2, line.find_first_of(" {", 2) - 2);
    if (section == "Subcommands:") told.commands.push_back(names);
    if (section != "Options:") continue;
    for (std::istringstream each(names); std::getline(each, names, ',');)
      told.options.push_back(names.substr(0, names.find(':')));
  }
  return told;
}

/// bernal, its commands, theirs.
inline std::vector<ToldCommand> all_told_commands(const std::vector<std::string>& words = {}) {
  std::vector<ToldCommand> all{told_command(words)};
  for (const std::string& name : std::vector(all.front().commands)) {
    std::vector<std::string> of = words;
    of.push_back(name);
    for (ToldCommand& told : all_told_commands(of)) all.push_back(std::move(told));
  }
  return all;
}

}  // namespace bernal::testing

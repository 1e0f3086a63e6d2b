#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "completion.hpp"

namespace {

/// Text in single quotes, with the characters escaped that are special to _arguments or _describe.
std::string quoted(std::string_view text, std::string_view special) {
  std::string all;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos || c == '\\') all += '\\';
    all += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return all;
}

/// What an option is, in a line beside its name.
std::string in_short(const std::string& what) { return what.substr(0, what.find("; ")); }

/// Offers its value: the third field of _arguments.
std::string action(const Option& option) {
  if (!option.words.empty()) return fmt::format("({})", fmt::join(option.words, " "));
  const bool is_file = std::holds_alternative<std::filesystem::path*>(option.to);
  if (!option.files && !is_file) return " ";
  const Files files = option.files.value_or(Files{});
  if (files.folders_only) return "_files -/";
  if (files.endings.empty()) return "_files";
  std::vector<std::string> endings;
  for (const std::string& dotted : files.endings) endings.push_back(dotted.substr(1));
  return fmt::format("_files -g \"(#i)*.({})(-.)\"", fmt::join(endings, "|"));
}

std::string argument(const Option& option) {
  const std::string value =
      fmt::format(":{}:{}", quoted(option.placeholder(), ":"), quoted(action(option), ""));
  if (option.is_positional()) {
    const bool several = std::holds_alternative<std::vector<std::string>*>(option.to);
    return fmt::format("'{}{}'", several ? "*" : "", option.required ? value : ":" + value);
  }
  const std::vector<std::string> names = option.all_names();
  std::vector<std::string> gone = names;
  gone.insert(gone.end(), option.excludes.begin(), option.excludes.end());
  const std::string before = option.repeated ? "*" : fmt::format("({})", fmt::join(gone, " "));
  const std::string what = fmt::format("[{}]", quoted(in_short(option.what), "[]:"));
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    const bool may_have_value = option.names.ends_with('}');
    const std::string sign = may_have_value           ? "=-"
                             : option.is_flag()       ? ""
                             : name.starts_with("--") ? "="
                                                      : "+";
    lines.push_back(fmt::format("'{}{}{}{}{}'", before, name, sign, what,
                                may_have_value     ? "::N: "
                                : option.is_flag() ? ""
                                                   : value));
  }
  return fmt::format("{}", fmt::join(lines, " \\\n        "));
}

void add(const Command& command, const std::string& function, bool of_all, std::string& script) {
  std::vector<std::string> lines;
  for (const Option& option : command.options) lines.push_back(argument(option));
  lines.emplace_back("'(- *)'{-h,--help}'[Say the same in short]'");
  if (of_all) lines.emplace_back("'(- *)--version[Say the version]'");
  if (command.commands.empty()) {
    script += fmt::format("{}()\n{{\n    _arguments -s -S \\\n        {}\n}}\n\n", function,
                          fmt::join(lines, " \\\n        "));
    return;
  }
  std::string names, cases;
  for (const Command& of : command.commands) {
    std::string name = function + "_" + of.name;
    std::ranges::replace(name, '-', '_');
    names += fmt::format("        '{}:{}'\n", of.name, quoted(of.what, ":"));
    cases += fmt::format("                {}) {} ;;\n", of.name, name);
  }
  lines.emplace_back("'1: :->command' '*:: :->words'");
  script += fmt::format(
      "{0}()\n{{\n    local curcontext=$curcontext context state state_descr line ret=1\n"
      "    local -A opt_args\n    local -a commands=(\n{1}    )\n    _arguments -C \\\n        {2} && ret=0\n"
      "    case $state in\n        command) _describe -t commands 'command' commands && ret=0 ;;\n"
      "        words)\n            curcontext=${{curcontext%:*:*}}:{3}-$words[1]:\n            case "
      "$words[1] in\n{4}"
      "            esac && ret=0\n            ;;\n    esac\n    return ret\n}}\n\n",
      function, names, fmt::join(lines, " \\\n        "), function.substr(1), cases);
  for (const Command& of : command.commands) {
    std::string name = function + "_" + of.name;
    std::ranges::replace(name, '-', '_');
    add(of, name, false, script);
  }
}

}  // namespace

std::string zsh_completion(const Command& bernal) {
  std::string script = fmt::format(
      "#compdef {0}\n# How zsh completes the words of {0}; made by: {0} completion zsh\n\n", bernal.name);
  add(bernal, "_" + bernal.name, true, script);
  // Loaded as the function itself, or read by a script.
  return script +
         fmt::format(
             "if [[ $funcstack[1] == _{0} ]]; then\n    _{0} \"$@\"\nelse\n    compdef _{0} {0}\nfi\n",
             bernal.name);
}

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "completion.hpp"

namespace {

constexpr const char* beginning = R"(# How bash completes the words of {0}; made by: {0} completion bash

# Files of these endings, in upper or lower case, any without one; and folders, to go on in.
_{0}_files()
{{
    local file ending
    compopt -o filenames 2>/dev/null  # bash quotes what needs it
    while IFS= read -r file; do
        if [[ -d ${{file/#~\//$HOME/}} || $# == 0 ]]; then
            COMPREPLY+=("$file")
            continue
        fi
        for ending in "$@"; do
            [[ ${{file,,}} == *"$ending" ]] && COMPREPLY+=("$file")
        done
    done < <(compgen -f -- "$begun")
}}
_{0}_folders()
{{
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -d -- "$begun")
}}
_{0}_words() {{ mapfile -t COMPREPLY < <(compgen -W "$*" -- "$word"); }}

_{0}()
{{
    local word=${{COMP_WORDS[COMP_CWORD]}} path={0} commands='' options='' values='' option='' given=0 at each
    COMPREPLY=()
    # What stands before the word: the command, how many words told by their place, and an option that wants it.
    # bash takes "--unit=mm" for three words.
    for ((at = 0; at < COMP_CWORD; ++at)); do
        each=${{COMP_WORDS[at]}}
        if ((at == 0)); then
            :
        elif [[ $each == = ]]; then
            ((at > 1)) && [[ ${{COMP_WORDS[at - 1]}} == --* ]] && option=${{COMP_WORDS[at - 1]}}
            continue
        elif [[ -n $option ]]; then
            option=
            continue
        elif [[ $each == -* ]]; then
            [[ " $values " == *" $each "* ]] && option=$each
            continue
        elif [[ " $commands " == *" $each "* ]]; then
            path+=" $each"
            given=0
        else
            given=$((given + 1))
            continue
        fi
        case $path in
)";

constexpr const char* middle = R"(        esac
    done
    if [[ $word == = ]]; then
        option=${{COMP_WORDS[COMP_CWORD - 1]}}
        word=
    fi

    if [[ -z $option && $word == -* ]]; then
        _{0}_words "$options"
        return
    fi
    if [[ -n $commands ]]; then
        _{0}_words "$commands"
        return
    fi
    local begun=${{word//\\/}}  # as the file is called: "a\ part", "'a part"
    begun=${{begun#[\"\']}}
    case $path${{option:+ }}${{option:- $given}} in
)";

constexpr const char* ending = R"(    esac
}}
complete -F _{0} {0}
)";

std::string offer(const std::string& bernal, const Option& option) {
  if (!option.words.empty()) return fmt::format("_{}_words '{}'", bernal, fmt::join(option.words, " "));
  const bool is_file = std::holds_alternative<std::filesystem::path*>(option.to);
  if (!option.files && !is_file) return "";
  const Files files = option.files.value_or(Files{});
  if (files.folders_only) return fmt::format("_{}_folders", bernal);
  return fmt::format("_{}_files{}{}", bernal, files.endings.empty() ? "" : " ",
                     fmt::join(files.endings, " "));
}

/// The tables of the script. Values of a positional option stand under its command and its place among such
/// words; an option that takes several words has that place and all after it.
struct Script {
  std::string bernal;
  std::string known = {};   ///< cases that say what a command has
  std::string values = {};  ///< cases that offer values

  void add(const Command& command, const std::string& path, bool of_all) {
    std::vector<std::string> commands, options, with_value;
    for (const Command& of : command.commands) commands.push_back(of.name);
    int place = 0;
    for (const Option& option : command.options) {
      const std::string offered = offer(bernal, option);
      if (option.is_positional()) {
        const bool several = std::holds_alternative<std::vector<std::string>*>(option.to);
        if (!offered.empty())
          values += fmt::format("        '{} '{}) {} ;;\n", path, several ? "[0-9]*" : std::to_string(place),
                                offered);
        ++place;
        continue;
      }
      std::vector<std::string> patterns;
      for (const std::string& name : option.all_names()) {
        options.push_back(name);
        if (option.is_flag()) continue;
        with_value.push_back(name);
        patterns.push_back(fmt::format("'{} {}'", path, name));
      }
      if (!offered.empty() && !patterns.empty())
        values += fmt::format("        {}) {} ;;\n", fmt::join(patterns, " | "), offered);
    }
    options.insert(options.end(), {"-h", "--help"});
    if (of_all) options.emplace_back("--version");
    known += fmt::format(
        "            '{}')\n                commands='{}'\n                options='{}'\n"
        "                values='{}'\n                ;;\n",
        path, fmt::join(commands, " "), fmt::join(options, " "), fmt::join(with_value, " "));
    for (const Command& of : command.commands) add(of, path + " " + of.name, false);
  }
};

}  // namespace

std::string bash_completion(const Command& bernal) {
  Script script{bernal.name};
  script.add(bernal, bernal.name, true);
  return fmt::format(beginning, bernal.name) + script.known + fmt::format(middle, bernal.name) +
         script.values + fmt::format(ending, bernal.name);
}

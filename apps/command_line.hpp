#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// The files and folders that a shell offers for the value of an option.
struct Files {
  bool folders_only = false;
  std::vector<std::string> endings = {};  ///< {".toml"}, beside folders; none: any file
};

/// An option of a command: with a value, positional, or a flag. `to` is the variable that takes its value,
/// and has to outlive it, or a function that is called with the word.
struct Option {
  /// "--unit", "-o,--output" or, if it is positional, "SCENE". "--list{all}" is a flag with a word: --list
  /// means --list=all.
  std::string names;
  std::variant<bool*, int*, std::int64_t*, double*, std::string*, std::filesystem::path*,
               std::optional<double>*, std::vector<double>*, std::vector<std::string>*,
               std::function<void(const std::string& word)>>
      to;
  std::string what;
  std::string type_name = {};  ///< what stands for its value in the help: "DIR"

  // What the functions below demand of it; for the help, the manual and the completion.
  bool required = false, repeated = false;
  std::vector<std::string> words = {};                 ///< that it takes, or that are offered
  std::optional<Files> files = {};                     ///< that are offered
  std::string range = {};                              ///< "1 to 1024"
  std::vector<std::string> needs = {}, excludes = {};  ///< names of other options
  /// The same for the parser.
  std::vector<std::function<void(CLI::App&, CLI::Option&)>> demands = {};

  bool is_flag() const { return std::holds_alternative<bool*>(to) || names.ends_with('}'); }
  bool is_positional() const { return !names.starts_with('-'); }
  /// {"-o", "--output"}, without what stands in braces; the one name of a positional option.
  std::vector<std::string> all_names() const;
  /// What stands for its value: "DIR"; "" of a flag.
  std::string placeholder() const;
};

// Demands on an option, which the help names.
Option required(Option);
Option within(Option, int least, int most);
Option within(Option, double least, double most);
Option one_of(Option, const std::vector<std::string>& words);
/// `complaint` returns "" for a word that is fine.
Option checked(Option, const std::function<std::string(const std::string& word)>& complaint);
/// Takes `count` values with commas between them.
Option list_of(int count, Option);
/// Takes text that is a number or a number with its unit; refuses those that are not finite or too large.
Option measured(Option);
/// May be given again, one value each time.
Option repeated(Option);
/// Refuses it without the other option, which stands before it in the list.
Option needs(Option, const std::string& other);
Option excludes(Option, const std::string& other);

// What shells offer for its value; other values are accepted, too.
Option offering(Option, const std::vector<std::string>& words);
Option folder(Option);
Option file(Option, const std::vector<std::string>& endings = {});

/// A line of a list: what it is called, and what it is.
struct Entry {
  std::string name, what;
};

/// What the help of a command and its page in the manual say beside the options. Texts are paragraphs with an
/// empty line between two; the output breaks their lines.
struct Explanation {
  struct List {
    std::string title;  ///< "Formats"
    std::string text = {};
    std::vector<Entry> entries = {};
  };
  std::string text = {};
  std::vector<List> lists = {};
  std::vector<Entry> examples = {};    ///< a call and what comes of it
  std::vector<Entry> exit_codes = {};  ///< "0", "done"
};

/// A command of bernal, or a command of such a command.
struct Command {
  std::string name, what;
  std::vector<Option> options;
  Explanation explanation;
  std::function<int()> act;  ///< once all options have their values; returns the exit code of the process
  std::vector<Command> commands = {};  ///< one of them must be called
};

/// Parses the command line and runs what it asks for: --help, --version or a command. Returns the exit code.
/// Throws bernal::Error{bad_argument} with one line if it cannot be parsed, and what the command throws.
int run_command_line(int argc, char** argv, const Command& bernal, const std::string& version);

/// Lists of options, one after the other.
std::vector<Option> joined(std::vector<Option> first, std::vector<Option> then, std::vector<Option> last);

// Options that several commands have.
Option json_option(bool& json);
Option quiet_option(bool& quiet, const std::string& what = "Print nothing but the files and errors");
/// --rods, whose default is the value of `rods`.
Option rods_option(int& rods, int least, int most);
/// --seed, a whole number that a scene can hold.
Option seed_option(const std::string& what, const std::function<void(std::uint64_t)>& take);
/// --threads, 0 for as many as the machine has; `what` does not depend on it, such as "the answer".
Option threads_option(int& threads, const std::string& what);
/// --time, such as "90", "90s", "10m", "2h"; `seconds_of` reads it.
Option time_option(std::string& time, const std::string& what);
/// The seconds of such a time; none unless it is above 0 and at most 30 days.
std::optional<double> seconds_of(std::string_view text);
/// The units of length that a scene may name.
Option with_units(Option);

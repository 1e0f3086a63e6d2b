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

/// A word of the command line with a value, or a flag, whose variable outlives it; a function is told the
/// word.
struct Option {
  /// "--unit", "-o,--output" or, for what is told from where it stands, "SCENE". A flag with a word,
  /// "--list{all}": that in braces, unless --list=TEXT says another.
  std::string names;
  std::variant<bool*, int*, std::int64_t*, double*, std::string*, std::filesystem::path*,
               std::optional<double>*, std::vector<double>*, std::vector<std::string>*,
               std::function<void(const std::string& word)>>
      to;
  std::string what;
  std::string type_name = {};  ///< what stands for its value in the help: "DIR"

  // What is asked of it, as the functions below say it; for the help, the pages and the completion.
  bool required = false, repeated = false;
  std::vector<std::string> words = {};                 ///< that it takes, or that are offered
  std::optional<Files> files = {};                     ///< that are offered
  std::string range = {};                              ///< "1 to 1024"
  std::vector<std::string> needs = {}, excludes = {};  ///< names of other options
  /// The same for the parser.
  std::vector<std::function<void(CLI::App&, CLI::Option&)>> demands = {};

  bool is_flag() const { return std::holds_alternative<bool*>(to) || names.ends_with('}'); }
  bool is_positional() const { return !names.starts_with('-'); }
  /// {"-o", "--output"}, without what stands in braces; the one name of what is told from where it stands.
  std::vector<std::string> all_names() const;
  /// What stands for its value: "DIR"; "" of a flag.
  std::string placeholder() const;
};

// What is asked of an option, and told by the help.
Option required(Option);
Option within(Option, int least, int most);
Option within(Option, double least, double most);
Option one_of(Option, const std::vector<std::string>& words);
/// `complaint` is empty where the word is fine.
Option checked(Option, const std::function<std::string(const std::string& word)>& complaint);
/// So many values, between commas.
Option list_of(int count, Option);
/// May be given again, one value each time.
Option repeated(Option);
/// Another option, which stands before it.
Option needs(Option, const std::string& other);
Option excludes(Option, const std::string& other);

// What shells offer for its value; nothing is refused for that.
Option offering(Option, const std::vector<std::string>& words);
Option folder(Option);
Option file(Option, const std::vector<std::string>& endings = {});

/// A line of a list: what it is called, and what it is.
struct Entry {
  std::string name, what;
};

/// What the help of a command and its page say besides the options. Texts are paragraphs, an empty line
/// between two, whose lines are broken where they are shown.
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

/// One of the commands of bernal, or of those of its commands that have some.
struct Command {
  std::string name, what;
  std::vector<Option> options;
  Explanation explanation;
  std::function<int()> act;  ///< once all options have their values; returns the exit code of the process
  std::vector<Command> commands = {};  ///< one of them must be called
};

/// Reads the words and does what they ask for: --help and --version, or what the command acts. Returns the
/// exit code. Throws bernal::Error{bad_argument} in one line for words that say nothing, and what the command
/// throws.
int run_command_line(int argc, char** argv, const Command& bernal, const std::string& version);

// Options that several commands have.
Option json_option(bool& json);
Option quiet_option(bool& quiet, const std::string& what = "Print nothing but the files and errors");
/// Of which there are `rods` if it is absent.
Option rods_option(int& rods, int least, int most);
/// A whole number that a scene can hold.
Option seed_option(const std::string& what, const std::function<void(std::uint64_t)>& take);
/// With 0 for as many as the machine has; `what` is the same for any number: "the answer".
Option threads_option(int& threads, const std::string& what);
/// "90", "90s", "10m", "2h"; `seconds_of` what it was given.
Option time_option(std::string& time, const std::string& what);
/// None where the text is no such time, above 0 and at most 30 days.
std::optional<double> seconds_of(std::string_view text);
/// The units of length that a scene may name.
Option with_units(Option);

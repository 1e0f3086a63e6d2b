#pragma once
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

/// A word of the command line with a value, or a flag. What is asked of it is said in a chain; `--help` tells
/// it.
class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option required();
  /// What stands for its value in the help: "DIR".
  Option type_name(const std::string& name);
  Option within(int least, int most);
  Option within(double least, double most);
  Option one_of(const std::vector<std::string>& words);
  Option one_of(const std::vector<int>& numbers);
  /// `complaint` is empty where the word is fine.
  Option check(const std::function<std::string(const std::string& word)>& complaint);
  /// So many values, between commas.
  Option list_of(int count);
  /// May be given again, one value each time.
  Option repeated();
  Option needs(Option other);
  Option excludes(Option other);

 private:
  CLI::Option* option_;
};

/// `bernal` itself, or one of its commands. The variables that options write into outlive it.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  Command add_subcommand(const std::string& name, const std::string& what);
  /// One of its subcommands must be called.
  void require_subcommand();
  /// `names` are "--unit", "-o,--output" or, for what is told from where it stands, "SCENE". `T` is int,
  /// double, std::string, a path, an optional or a vector: of those that command_line.cpp lists.
  template <typename T>
  Option add_option(const std::string& names, T& value, const std::string& what);
  /// The word goes to `take`.
  Option add_word(const std::string& names, const std::function<void(const std::string& word)>& take,
                  const std::string& what);
  Option add_flag(const std::string& name, bool& value, const std::string& what);
  /// "--list{all}": the text in braces, unless --list=TEXT says another.
  Option add_flag(const std::string& name, std::string& value, const std::string& what);
  /// The end of its help.
  void footer(const std::string& text);
  /// What it does, once all options have their values.
  void callback(const std::function<void()>& act);

 private:
  CLI::App* app_;
};

/// Reads the words and does what they ask for: --help and --version, or the callback of a command that `add`
/// added. Throws bernal::Error{bad_argument} in one line for words that say nothing, and what the command
/// throws.
void read_command_line(int argc, char** argv, const std::string& description, const std::string& version,
                       const std::function<void(Command bernal)>& add);

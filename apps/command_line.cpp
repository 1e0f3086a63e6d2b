// The only file that sees CLI11, which is seconds of compiling for each that does.
#include "command_line.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"

namespace {

/// The command that was asked for, as far as it is known.
const CLI::App& asked_for(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : asked_for(*commands.front());
}

/// "bernal design target".
std::string whole_name(const CLI::App& app) {
  return app.get_parent() ? whole_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

/// The word after it is no command, if there is one where a command should stand: which is meant?
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const auto after = app.get_parent() ? std::ranges::find(words, app.get_name()) + 1 : words.begin();
  if (names.empty() || after == words.end() || after->starts_with('-')) return "";
  return fmt::format("unknown command \"{}\"{}", *after, bernal::remedy(*after, names));
}

}  // namespace

Option Option::required() {
  option_->required();
  return *this;
}

Option Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

Option Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option Option::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Option Option::one_of(const std::vector<int>& numbers) {
  option_->check(CLI::IsMember(numbers));
  return *this;
}

Option Option::check(const std::function<std::string(const std::string& word)>& complaint) {
  option_->check(complaint);
  return *this;
}

Option Option::list_of(int count) {
  option_->delimiter(',')->expected(count);
  return *this;
}

Option Option::repeated() {
  option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return *this;
}

Option Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}

Command Command::add_subcommand(const std::string& name, const std::string& what) {
  return Command(*app_->add_subcommand(name, what));
}

void Command::require_subcommand() { app_->require_subcommand(1); }

template <typename T>
Option Command::add_option(const std::string& names, T& value, const std::string& what) {
  return Option(*app_->add_option(names, value, what));
}

template Option Command::add_option(const std::string&, int&, const std::string&);
template Option Command::add_option(const std::string&, std::int64_t&, const std::string&);
template Option Command::add_option(const std::string&, double&, const std::string&);
template Option Command::add_option(const std::string&, std::string&, const std::string&);
template Option Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);

Option Command::add_word(const std::string& names, const std::function<void(const std::string& word)>& take,
                         const std::string& what) {
  return Option(*app_->add_option_function<std::string>(names, take, what));
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& what) {
  return Option(*app_->add_flag(name, value, what));
}

Option Command::add_flag(const std::string& name, std::string& value, const std::string& what) {
  return Option(*app_->add_flag(name, value, what));
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::callback(const std::function<void()>& act) { app_->callback(act); }

void read_command_line(int argc, char** argv, const std::string& description, const std::string& version,
                       const std::function<void(Command bernal)>& add) {
  CLI::App app{description, "bernal"};
  app.set_version_flag("--version", version);
  add(Command(app));
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.empty()) throw CLI::CallForHelp();
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
  } catch (const CLI::ParseError& wrong) {
    const CLI::App& command = asked_for(app);
    std::string what = unknown_command(command, words);
    if (what.empty()) what = fmt::format("{}; see {} --help", wrong.what(), whole_name(command));
    throw bernal::Error(bernal::ErrorCode::bad_argument, what);
  }
}

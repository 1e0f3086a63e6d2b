// The only file that sees CLI11, which is seconds of compiling for each that does.
#include "command_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "bernal/core/error.hpp"
#include "bernal/core/text.hpp"
#include "bernal/core/unit.hpp"
#include "explanation_text.hpp"

namespace {

/// The command that was asked for, as far as it is known.
const CLI::App& asked_for(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : asked_for(*commands.front());
}

/// CLI11 keeps what an option excludes in the order of addresses, which differs from run to run.
class InOneOrder : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string text = CLI::Formatter::make_option_opts(option),
                      label = " " + get_label("Excludes") + ":";
    const auto found = text.find(label);  // what follows are names, to the end
    if (found == std::string::npos) return text;
    std::istringstream listed(text.substr(found + label.size()));
    const std::set<std::string> names{std::istream_iterator<std::string>(listed), {}};
    return fmt::format("{}{} {}", text.substr(0, found), label, fmt::join(names, " "));
  }
};

/// "bernal design target".
std::string whole_name(const CLI::App& app) {
  return app.get_parent() ? whole_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

/// What to say of a word that stands where a command should stand and is none: which command is meant.
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  const auto after = app.get_parent() ? std::ranges::find(words, app.get_name()) + 1 : words.begin();
  if (names.empty() || after == words.end() || after->starts_with('-')) return "";
  return fmt::format("unknown command \"{}\"{}", *after, bernal::remedy(*after, names));
}

/// Refuses numbers that are not finite or too large to compute with: for CLI11 "nan" lies in every range.
std::string complaint_of_number(const std::string& word) {
  constexpr double largest = 1e100;
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (*end != '\0' || std::abs(number) <= largest) return "";  // no number: so says CLI11
  return fmt::format("must be a number from {} to {}, not {}", -largest, largest, word);
}

template <class To>
constexpr bool holds_doubles = std::is_same_v<To, double*> || std::is_same_v<To, std::optional<double>*> ||
                               std::is_same_v<To, std::vector<double>*>;

void add_option(CLI::App& app, const Option& option) {
  CLI::Option& added = *std::visit(
      [&]<class To>(const To& to) {
        if constexpr (!std::is_pointer_v<To>) {
          return app.add_option_function<std::string>(option.names, to, option.what);
        } else if constexpr (std::is_same_v<To, bool*>) {
          return app.add_flag(option.names, *to, option.what);
        } else {
          if constexpr (std::is_same_v<To, std::string*>)
            if (option.names.ends_with('}')) return app.add_flag(option.names, *to, option.what);
          CLI::Option* one = app.add_option(option.names, *to, option.what);
          return holds_doubles<To> ? one->check(complaint_of_number) : one;
        }
      },
      option.to);
  if (std::holds_alternative<std::filesystem::path*>(option.to))
    added.check([](const std::string& word) { return word.empty() ? "is the name of no file" : ""; });
  if (!option.type_name.empty()) added.type_name(option.type_name);
  for (const auto& demand : option.demands) demand(app, added);
}

void add(CLI::App& app, const Command& command, int& status) {
  for (const Option& option : command.options) add_option(app, option);
  app.footer(explanation_as_text(command.explanation));
  if (!command.commands.empty()) app.require_subcommand(1);
  for (const Command& of : command.commands) add(*app.add_subcommand(of.name, of.what), of, status);
  if (command.act) app.callback([&act = command.act, &status] { status = act(); });
}

Option demanding(Option option, std::function<void(CLI::App&, CLI::Option&)> demand) {
  option.demands.push_back(std::move(demand));
  return option;
}
Option demanding(Option option, const CLI::Validator& check) {
  return demanding(std::move(option), [check](CLI::App&, CLI::Option& it) { it.check(check); });
}

constexpr std::uint64_t largest_seed = (std::uint64_t{1} << 63) - 1;  ///< that a scene can hold

/// The seed in a text; none if a scene cannot hold it. CLI11 would read a larger number as the largest.
std::optional<std::uint64_t> parse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size() || seed > largest_seed) return {};
  return seed;
}

}  // namespace

int run_command_line(int argc, char** argv, const Command& bernal, const std::string& version) {
  int status = 0;
  CLI::App app{bernal.what, bernal.name};
  app.formatter(std::make_shared<InOneOrder>());
  app.set_version_flag("--version", version);
  add(app, bernal, status);
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
  return status;
}

std::vector<std::string> Option::all_names() const {
  std::vector<std::string> all;
  std::string_view rest = std::string_view(names).substr(0, names.find('{'));
  for (std::size_t comma = 0; comma != std::string_view::npos; rest.remove_prefix(comma + 1)) {
    comma = rest.find(',');
    all.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
  }
  return all;
}

std::string Option::placeholder() const {
  if (is_flag()) return "";
  if (!type_name.empty()) return type_name;
  return is_positional() ? names : "VALUE";
}

Option required(Option option) {
  option.required = true;
  return demanding(std::move(option), [](CLI::App&, CLI::Option& it) { it.required(); });
}
Option within(Option option, int least, int most) {
  option.range = fmt::format("{} to {}", least, most);
  return demanding(std::move(option), CLI::Range(least, most));
}
Option within(Option option, double least, double most) {
  option.range = fmt::format("{} to {}", least, most);
  const auto complaint = [](const std::string& word) {  // which no comparison finds
    double value = 0;
    return !CLI::detail::lexical_cast(word, value) || std::isnan(value) ? word + " is not a number"
                                                                        : std::string();
  };
  return demanding(checked(std::move(option), complaint), CLI::Range(least, most));
}
Option one_of(Option option, const std::vector<std::string>& words) {
  return demanding(offering(std::move(option), words), CLI::IsMember(words));
}
Option checked(Option option, const std::function<std::string(const std::string& word)>& complaint) {
  return demanding(std::move(option), [=](CLI::App&, CLI::Option& it) { it.check(complaint); });
}
Option list_of(int count, Option option) {
  return demanding(std::move(option),
                   [=](CLI::App&, CLI::Option& it) { it.delimiter(',')->expected(count); });
}
Option measured(Option option) { return checked(std::move(option), complaint_of_number); }
Option repeated(Option option) {
  option.repeated = true;
  return demanding(std::move(option), [](CLI::App&, CLI::Option& it) {
    it.expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  });
}
Option needs(Option option, const std::string& other) {
  option.needs.push_back(other);
  return demanding(std::move(option),
                   [=](CLI::App& app, CLI::Option& it) { it.needs(app.get_option(other)); });
}
Option excludes(Option option, const std::string& other) {
  option.excludes.push_back(other);
  return demanding(std::move(option),
                   [=](CLI::App& app, CLI::Option& it) { it.excludes(app.get_option(other)); });
}

Option offering(Option option, const std::vector<std::string>& words) {
  option.words = words;
  return option;
}
Option folder(Option option) {
  option.files = Files{.folders_only = true};
  return option;
}
Option file(Option option, const std::vector<std::string>& endings) {
  option.files = Files{.endings = endings};
  return option;
}
Option with_units(Option option) {
  const auto names = bernal::unit_names();
  return offering(std::move(option), {names.begin(), names.end()});
}

std::vector<Option> joined(std::vector<Option> first, std::vector<Option> then, std::vector<Option> last) {
  for (std::vector<Option>* more : {&then, &last})
    for (Option& option : *more) first.push_back(std::move(option));
  return first;
}

Option json_option(bool& json) { return {"--json", &json, "One JSON object on standard output"}; }

Option quiet_option(bool& quiet, const std::string& what) { return {"--quiet", &quiet, what}; }

Option rods_option(int& rods, int least, int most) {
  const std::string otherwise = bernal::grouped(static_cast<std::uint64_t>(rods));
  return within({"--rods", &rods, "Rods that stand for the sizes; " + otherwise + " if absent", "N"}, least,
                most);
}

Option seed_option(const std::string& what, const std::function<void(std::uint64_t)>& take) {
  const auto complaint = [](const std::string& text) {
    if (parse_seed(text)) return std::string();
    return fmt::format("must be a whole number from 0 to {}, not {}", largest_seed, text);
  };
  return checked({"--seed", [=](const std::string& text) { take(*parse_seed(text)); }, what, "N"}, complaint);
}

Option threads_option(int& threads, const std::string& what) {
  return within(
      {"--threads", &threads, "As many as the machine has if absent; " + what + " is the same", "N"}, 1,
      1024);
}

std::optional<double> seconds_of(std::string_view text) {
  constexpr double longest = 30 * 86400.0;
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  const double seconds = factor * number;
  if (error != std::errc{} || !(seconds > 0) || seconds > longest) return {};
  return seconds;
}

Option time_option(std::string& time, const std::string& what) {
  const auto complaint = [](const std::string& text) {
    return seconds_of(text)
               ? std::string()
               : fmt::format("must be a time above 0 and up to 30 days, such as 90s, 10m or 2h, not {}",
                             text);
  };
  return checked({"--time", &time, what, "TIME"}, complaint);
}

// The command: one subcommand a file; this one only turns what they throw into a line and an exit code.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "bernal/core/text.hpp"
#include "bernal/version.hpp"
#include "commands.hpp"

namespace {

constexpr const char* description =
    "bernal packs spheres into real shapes and proves that nothing overlaps.\n"
    "A scene, a short TOML file, says which container, which sizes and how many.";

constexpr const char* examples = R"(Examples:
  bernal pack data/scenes/cylinder_han.toml -o out   fill a cylinder; results in out/
  bernal pack bracket.stl --unit mm --diameter 2     fill a CAD part, without a scene; results in bracket/
  bernal verify out                                  certify what stands in the files, from scratch
  bernal measure out                                 contacts, rattlers, g(r), sizes against those asked for
  bernal inspect part.stl --unit mm                  can this CAD file be a container?
  bernal explain data/scenes/hopper.toml             what would run, and what it would cost
  bernal keys relax                                  what a scene may say of a stage
  bernal predict --lognormal 0.5                     how densely spheres of these sizes pack
  bernal design maximise --diameters 1,3,9           how much of each size packs densest
  bernal map 0.3 0.6 -o out                          how densely all their mixtures do
  bernal reproduce fig6 -o out                       a figure of the paper behind that

Exit codes: 0 done; 1 not certified, or not usable; 2 bad input; 3 ended without reaching what the scene asks.
Messages go to standard error, results to files or standard output.)";

/// In one line, whatever the input had in it: control characters would also move a terminal's cursor.
int complain(std::string what) {
  std::ranges::replace_if(
      what, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  fmt::print(stderr, "bernal: {}\n", what);
  return exit_code::bad_input;
}

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

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is an error to report, not a reason to die
  CLI::App app{description, "bernal"};
  app.footer(examples);
  app.set_version_flag("--version", "bernal " + std::string(bernal::version()));
  app.require_subcommand(1);
  const std::vector<std::string> words(argv + 1, argv + argc);
  int status = exit_code::done;
  add_pack(app, status);
  add_verify(app, status);
  add_inspect(app, status);
  add_explain(app, status);
  add_keys(app, status);
  add_measure(app, status);
  add_predict(app, status);
  add_design(app, status);
  add_map(app, status);
  add_reproduce(app, status);
  try {
    if (words.empty()) throw CLI::CallForHelp();
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
  } catch (const CLI::ParseError& wrong) {
    const CLI::App& command = asked_for(app);
    const std::string unknown = unknown_command(command, words);
    if (!unknown.empty()) return complain(unknown);
    return complain(fmt::format("{}; see {} --help", wrong.what(), whole_name(command)));
  } catch (const std::bad_alloc&) {
    return complain("out of memory");
  } catch (const std::exception& error) {
    return complain(error.what());
  }
  if (std::fflush(stdout) != 0) return complain("standard output cannot be written");
  return status;
}

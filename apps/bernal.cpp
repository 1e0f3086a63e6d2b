// The command: one subcommand a file; this one only turns what they throw into a line and an exit code.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include <fmt/format.h>

#include "bernal/version.hpp"
#include "commands.hpp"

namespace {

constexpr const char* description =
    "bernal packs spheres into real shapes and proves that nothing overlaps.\n"
    "A scene, a short TOML file, says which container, which sizes and how many.";

constexpr const char* examples = R"(Examples:
  bernal pack data/scenes/cylinder_han.toml -o out   fill a cylinder; results in out/
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

/// "bernal design target": the command that was asked for, as far as it is known.
std::string asked_for(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app.get_name() : app.get_name() + " " + asked_for(*commands.front());
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file over the size limit is an error to report, not a reason to die
  CLI::App app{description, "bernal"};
  app.footer(examples);
  app.set_version_flag("--version", "bernal " + std::string(bernal::version()));
  app.require_subcommand(1);
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
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
  } catch (const CLI::ParseError& wrong) {
    return complain(fmt::format("{}; see {} --help", wrong.what(), asked_for(app)));
  } catch (const std::bad_alloc&) {
    return complain("out of memory");
  } catch (const std::exception& error) {
    return complain(error.what());
  }
  if (std::fflush(stdout) != 0) return complain("standard output cannot be written");
  return status;
}

#include <memory>
#include <string>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"

void add_keys(Command app, int& status) {
  auto name = std::make_shared<std::string>();
  Command command = app.add_subcommand("keys", "Say what a scene may hold: every key with its default");
  command.add_option("NAME", *name, "A container, a distribution of sizes or a stage; all of them if absent");
  command.footer(
      "Examples:\n"
      "  bernal keys              all containers, distributions and stages, a line each\n"
      "  bernal keys relax        the keys of a stage, their defaults and ranges\n"
      "Exit codes: 0 done; 2 bad input.");
  command.callback([name, &status] {
    fmt::print("{}", bernal::reference(*name));
    status = exit_code::done;
  });
}

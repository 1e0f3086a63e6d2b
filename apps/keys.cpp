#include <memory>
#include <string>

#include <fmt/format.h>

#include "bernal/scene/read_scene.hpp"
#include "commands.hpp"

Command keys_command() {
  const auto name = std::make_shared<std::string>();
  return {"keys",
          "Say what a scene may hold: every key with its default",
          {{"NAME", name.get(),
            "A container, a distribution of sizes, a stage or a format of [[output]]; a line each of all if "
            "absent"}},
          "Examples:\n"
          "  bernal keys              all containers, distributions and stages, a line each\n"
          "  bernal keys relax        the keys of a stage, their defaults and ranges\n"
          "  bernal keys output       the formats of [[output]]; likewise stage, container, diameter\n"
          "Exit codes: 0 done; 2 bad input.",
          [name] {
            fmt::print("{}", bernal::reference(*name));
            return exit_code::done;
          }};
}

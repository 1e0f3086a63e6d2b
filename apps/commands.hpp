#pragma once
#include "command_line.hpp"

/// Each of these adds one subcommand. When the user calls it, it runs while the command line is parsed and
/// leaves the exit code of the process in `status`; bad input throws bernal::Error.
void add_pack(Command app, int& status);
void add_verify(Command app, int& status);
void add_inspect(Command app, int& status);
void add_explain(Command app, int& status);
void add_keys(Command app, int& status);
void add_measure(Command app, int& status);
void add_predict(Command app, int& status);
void add_design(Command app, int& status);
void add_map(Command app, int& status);
void add_reproduce(Command app, int& status);

/// Exit codes, the same for every subcommand.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int no = 1;           ///< not certified, not usable
inline constexpr int bad_input = 2;    ///< of a file, of the command line, of the file system
inline constexpr int not_reached = 3;  ///< the run ended without what the scene asks; its files are valid
}  // namespace exit_code

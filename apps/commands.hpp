#pragma once
#include <CLI/CLI.hpp>

/// Each of these adds one subcommand. When the user calls it, it runs while the command line is parsed and
/// leaves the exit code of the process in `status`; bad input throws bernal::Error.
void add_pack(CLI::App& app, int& status);
void add_verify(CLI::App& app, int& status);
void add_inspect(CLI::App& app, int& status);
void add_explain(CLI::App& app, int& status);
void add_keys(CLI::App& app, int& status);
void add_measure(CLI::App& app, int& status);
void add_predict(CLI::App& app, int& status);
void add_design(CLI::App& app, int& status);
void add_map(CLI::App& app, int& status);
void add_reproduce(CLI::App& app, int& status);

/// Exit codes, the same for every subcommand.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int no = 1;           ///< not certified, not usable
inline constexpr int bad_input = 2;    ///< of a file, of the command line, of the file system
inline constexpr int not_reached = 3;  ///< the run ended without what the scene asks; its files are valid
}  // namespace exit_code

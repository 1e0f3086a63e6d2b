#pragma once
#include "command_line.hpp"

// One subcommand each; bad input throws bernal::Error.
Command pack_command();
Command verify_command();
Command inspect_command();
Command explain_command();
Command cost_command();
Command sweep_command();
Command measure_command();
Command cells_command();
Command mesh_command();
Command predict_command();
Command design_command();
Command map_command();
Command export_command();
Command import_command();
// These describe all commands; `bernal` has to outlive them.
Command help_command(const Command& bernal);
Command keys_command(const Command& bernal);
Command completion_command(const Command& bernal);
Command manual_command(const Command& bernal);

/// Exit codes, the same for every subcommand.
namespace exit_code {
inline constexpr int done = 0;
inline constexpr int no = 1;           ///< not certified, not usable
inline constexpr int bad_input = 2;    ///< of a file, of the command line, of the file system
inline constexpr int not_reached = 3;  ///< the run ended without what the scene asks; its files are valid
}  // namespace exit_code

#pragma once
#include <string>

#include "command_line.hpp"

// Scripts that complete the command line in a shell: commands, options, files of the right kind, and words of
// options that take words. They hold all of this and run no program when a key is pressed.

/// For bash 4 and later, with or without the package bash-completion.
std::string bash_completion(const Command& bernal);
/// For zsh, as a file _bernal in a folder of its fpath.
std::string zsh_completion(const Command& bernal);

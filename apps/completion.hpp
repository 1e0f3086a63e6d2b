#pragma once
#include <string>

#include "command_line.hpp"

// Scripts that tell a shell how the words of bernal go on: commands, options, files of the kind that is asked
// for, and the words of those values that have some. They ask nobody when a key is pressed: all that they
// know stands in them.

/// For bash 4 and later, with or without the package bash-completion.
std::string bash_completion(const Command& bernal);
/// For zsh, as a file _bernal in a folder of its fpath.
std::string zsh_completion(const Command& bernal);

#pragma once
#include <string>

#include "command_line.hpp"

/// Adds --threads, with 0 for as many as the machine has; `what` is the same for any number: "the answer".
void add_threads(Command command, int& threads, const std::string& what);

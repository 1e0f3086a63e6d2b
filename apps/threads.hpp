#pragma once
#include <string>

#include <CLI/CLI.hpp>

/// Adds --threads, with 0 for as many as the machine has; `what` is the same for any number: "the answer".
void add_threads(CLI::App& command, int& threads, const std::string& what);

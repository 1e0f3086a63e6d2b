#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include <CLI/CLI.hpp>

/// Adds --seed, a whole number that a scene can hold; what it is goes to `take`.
CLI::Option* add_seed(CLI::App& command, const std::string& help, std::function<void(std::uint64_t)> take);

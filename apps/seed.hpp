#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "command_line.hpp"

/// Adds --seed, a whole number that a scene can hold; what it is goes to `take`.
Option add_seed(Command command, const std::string& help, std::function<void(std::uint64_t)> take);

#pragma once
#include <string>
#include <string_view>

#include "bernal/scene/scene.hpp"

namespace bernal {

/// A TOML basic string, quotes included; always one line.
std::string toml_string(std::string_view text);

/// A value as TOML; doubles are the shortest text that reads back to the same bits.
std::string toml_text(const Value&);

}  // namespace bernal

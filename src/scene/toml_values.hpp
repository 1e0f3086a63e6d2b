#pragma once
#include <optional>
#include <string>

#include <toml++/toml.h>

#include "scene/entry.hpp"

namespace bernal {

/// What the user wrote, short enough for an error of one line.
std::string written(const toml::node&);

/// The node as a value, whole numbers as doubles if that is asked for; nothing for tables and dates.
std::optional<schema::Value> value_in(const toml::node&, bool as_double);

}  // namespace bernal

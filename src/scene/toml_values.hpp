#pragma once
#include <optional>
#include <string>

#include <toml++/toml.h>

#include "scene/entry.hpp"

namespace bernal {

/// What the user wrote, short enough for an error of one line.
std::string written(const toml::node&);

/// The node as the kind of value that a key of this type has; nothing if it is of another kind.
std::optional<schema::Value> value_in(const toml::node&, schema::Type);

}  // namespace bernal

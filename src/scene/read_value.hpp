#pragma once
#include <optional>
#include <string>

#include <toml++/toml.h>

#include "scene/entry.hpp"

namespace bernal {

// Nodes of a scene's TOML as values. Whether a key accepts them, `schema::accepts` says.

/// What the user wrote, short enough for an error of one line.
std::string written(const toml::node& node);

/// The node as a value, a number as a double if that is asked for, else 1e6 is a whole one too; nothing for
/// tables and dates.
std::optional<schema::Value> value_in(const toml::node& node, bool as_double);

/// The node as closed lines of points [x, y], or as one such line; nothing for anything else.
std::optional<schema::Value> lines_in(const toml::node& node, bool one);

/// The node as names, whole numbers among them; nothing for anything else.
std::optional<schema::Value> names_in(const toml::node& node);

}  // namespace bernal

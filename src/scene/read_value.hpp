#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include <toml++/toml.h>

#include "scene/entry.hpp"

namespace bernal {

// Nodes of a scene's TOML as values. Whether a key accepts them, `schema::accepts` says.

/// What the user wrote, short enough for an error of one line.
std::string written(const toml::node& node);

/// What numbers of a scene are numbers of, and the scene's unit of length: those that stand in text, with
/// their unit, become numbers in it, see `number_with_unit`. What cannot become one throws
/// Error{bad_argument} with the complaint alone.
struct Measured {
  Quantity quantity = Quantity::none;
  Unit unit = Unit::m;
};

/// The node as a value, a number as a double if that is asked for, else 1e6 is a whole one too; nothing for
/// tables and dates. Text that is none of `words` is a number with its unit where one is measured.
std::optional<schema::Value> value_in(const toml::node& node, bool as_double, const Measured& measured = {},
                                      const std::vector<std::string_view>& words = {});

/// The node as closed lines of points [x, y], or as one such line; nothing for anything else.
std::optional<schema::Value> lines_in(const toml::node& node, bool one, const Measured& measured);

/// The place of the first element of an array that is not an array of two; nothing where all are, or for
/// anything else.
std::optional<std::size_t> first_that_is_no_point(const toml::node& node);

/// The node as names, whole numbers among them; nothing for anything else. What is measured stands behind a
/// sign in a name, and is left without its unit: "z < 5 mm" becomes "z < 5".
std::optional<schema::Value> names_in(const toml::node& node, const Measured& measured = {});

}  // namespace bernal

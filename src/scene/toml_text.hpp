#pragma once
#include <string>
#include <string_view>

#include "scene/entry.hpp"

namespace bernal {

/// A TOML basic string, quotes included; always one line.
std::string toml_string(std::string_view text);

/// A value as TOML; doubles are the shortest text that reads back to the same bits, distributions inline
/// tables.
std::string toml_text(const schema::Value&);

/// `key = value` for every key that has one, in the order of the entry, but for those that act elsewhere.
std::vector<std::string> assignments(const schema::Entry&, const void* options, bool in_bed = true);

}  // namespace bernal
